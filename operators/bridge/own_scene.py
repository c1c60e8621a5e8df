"""A scene for the time being: what the running Blender has open is not touched."""

from collections.abc import Iterator
from contextlib import contextmanager

import bpy


@contextmanager
def own_scene(name: str) -> Iterator[bpy.types.Scene]:
    """A scene for the time being; it and everything made or loaded meanwhile is removed again."""
    before = {block.as_pointer() for block in bpy.data.user_map()}
    scene = bpy.data.scenes.new(name)
    try:
        yield scene
    finally:
        bpy.data.scenes.remove(scene)
        made = [block for block in bpy.data.user_map() if block.as_pointer() not in before]
        bpy.data.batch_remove(made)


@contextmanager
def showing_scene(scene: bpy.types.Scene) -> Iterator[None]:
    """Let a scene be the one that operators work in; then the one before is again."""
    window = bpy.context.window
    if window is None:  # a Blender without any window: operators find the scene in the context alone
        with bpy.context.temp_override(scene=scene, view_layer=scene.view_layers[0]):
            yield
        return
    before = window.scene
    window.scene = scene
    try:
        yield
    finally:
        window.scene = before
