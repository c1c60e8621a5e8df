"""The colour of the footage under a pixel, as an eyedropper on the file itself gives it."""

from dataclasses import replace

import bpy
import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...core.errors import InputError
from ...core.footage.clip import Clip
from .scene_camera import read_camera
from .scene_footage import clip_rate
from .scene_take import clip_path

REACH_PX = 2
"""Pixels around the one that is picked: the median of 5 x 5 is free of noise and chroma subsampling."""
EARLY = 1e-4
"""Rounding of times [frames]."""


def footage_color(scene: bpy.types.Scene, pixel: ArrayLike) -> tuple[int, int, int]:
    """The colour at a pixel of the frame that the scene shows now.

    Args:
        scene: Its active clip is the footage.
        pixel: (2,) x to the right, y down, in pixels of the footage.

    Returns:
        Red, green, blue in 0 to 255.

    Raises:
        InputError: There is no footage, no frame of it at the current frame, or the pixel lies outside.
    """
    clip = scene.active_clip
    if clip is None:
        raise InputError(f"scene '{scene.name}' has no footage; load a clip first")
    width, height = clip.size
    x, y = np.floor(np.asarray(pixel, dtype=np.float64)).astype(int)
    if not (0 <= x < width and 0 <= y < height):
        raise InputError(f"pixel ({x}, {y}) lies outside the footage, which is {width} x {height} pixels")
    source = Clip.open(clip_path(clip), fps=clip_rate(clip, scene.render.fps / scene.render.fps_base))
    index = _shown_index(scene, clip, source)
    image = next((image for _, image in source.source.at([index])), None) if index >= 0 else None
    if image is None:
        raise InputError(f"the footage has no frame at scene frame {scene.frame_current}; go to one it has")
    around = image[max(0, y - REACH_PX) : y + REACH_PX + 1, max(0, x - REACH_PX) : x + REACH_PX + 1]
    blue, green, red = (round(float(value)) for value in np.median(around.reshape(-1, 3), axis=0))
    return red, green, blue


def footage_pixel(scene: bpy.types.Scene, pixel: ArrayLike) -> NDArray[np.float64]:
    """The pixel of the clip's file, (2,), that the camera's background shows at `pixel` (2,).

    They differ where the clip has lens distortion: the background is straightened, the file is not.

    Raises:
        InputError: The scene's camera or clip cannot be used.
    """
    camera = replace(read_camera(scene, np.array([scene.frame_current_final])), matrix_world=np.eye(4))
    straight = replace(camera, distortion=(0.0, 0.0, 0.0))
    _, direction = straight.rays(pixel)
    return camera.project(direction)[0]


def _shown_index(scene: bpy.types.Scene, clip: bpy.types.MovieClip, source: Clip) -> int:
    """Index of the last frame that begins no later than the scene's current time; -1 outside the clip."""
    elapsed = scene.frame_current - (clip.frame_start - clip.frame_offset)
    shown = -1
    for index, time_s in enumerate(source.source.time_stamps()):
        if time_s * clip_rate(clip, source.fps) > elapsed + EARLY:
            return shown
        shown = index
    # Past the last frame nothing is shown, the last frame itself lasts one scene frame.
    return shown if elapsed < shown + 1 or shown < 0 else -1
