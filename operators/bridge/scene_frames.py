"""Going through a scene's frames and coming back, with everything as it was."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from math import floor

import bpy


@contextmanager
def at_scene_frame(scene: bpy.types.Scene) -> Iterator[Callable[[float], None]]:
    """Yield a function that evaluates the scene at a frame, fractional ones too; then go back."""
    before = scene.frame_current, scene.frame_subframe

    def go_to(frame: float) -> None:
        whole = floor(frame)
        scene.frame_set(whole, subframe=frame - whole)

    try:
        yield go_to
    finally:
        scene.frame_set(before[0], subframe=before[1])
