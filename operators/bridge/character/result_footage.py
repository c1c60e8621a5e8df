"""Camera and clip of a result, copied out of its motion.blend into another scene."""

from pathlib import Path

import bpy
import numpy as np

from ....core.arrays import Array
from ....core.errors import InputError
from ....core.files.paths import real_path
from ....core.take.motion import Motion
from ..blend_reader import check_blend
from ..blend_writer import one_line
from ..footage import set_scene_range
from ..result_files import set_look
from ..scene_frames import scene_frames

RENDER = ("resolution_x", "resolution_y", "resolution_percentage", "fps", "fps_base")
USUAL_SIZE = (1920, 1080)


def show_result(scene: bpy.types.Scene, blend: Path | None, motion: Motion) -> Array:
    """Show a result's footage behind its camera, with rate, range and look.

    Args:
        scene: The scene to change.
        blend: The result's motion.blend; None where there is none, and the scene gets rate and range alone.
        motion: Its motion, F frames.

    Returns:
        (F,) scene frames of the motion.

    Raises:
        InputError: Blender cannot read the .blend.
    """
    set_scene_range(scene, USUAL_SIZE, motion.fps, motion.frame_start, len(motion.time_s))
    set_look(scene)
    if blend is not None:
        _copy_footage(scene, blend)
    rate = scene.render.fps / scene.render.fps_base
    frames = scene_frames(motion.time_s, motion.frame_start, rate)
    scene.frame_start = motion.frame_start
    scene.frame_end = max(scene.frame_start + len(frames) - 1, int(np.floor(frames[-1])))
    return frames


def _copy_footage(scene: bpy.types.Scene, blend: Path) -> None:
    """Take camera, clip, size and rate from the first scene of a .blend that shows a clip."""
    check_blend(blend, "a result")
    try:
        with bpy.data.libraries.load(str(real_path(blend)), link=False) as (inside, wanted):
            wanted.scenes = list(inside.scenes)
    except (OSError, RuntimeError, UnicodeDecodeError) as error:
        raise InputError(
            f"{blend}: Blender cannot read it ({one_line(error)}); convert the take again, or name its "
            "motion.json instead"
        ) from error
    shown = next((one for one in wanted.scenes if one is not None and one.camera and one.active_clip), None)
    if shown is None:
        return
    for name in RENDER:
        setattr(scene.render, name, getattr(shown.render, name))
    scene.collection.objects.link(shown.camera)
    scene.camera, scene.active_clip = shown.camera, shown.active_clip
