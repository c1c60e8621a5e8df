"""A result as files for other programs, a .blend with everything in it and a BVH, of a scene of its own."""

from pathlib import Path

import bpy
import numpy as np
from bpy.types import Scene

from ...core.arrays import Array
from ...core.take.motion import Motion
from ...core.take.take import Take
from .actions import curve_digest
from .armature import build_armature
from .blend_files import own_scene, write_blend
from .body_mesh import build_body_mesh
from .export_formats import write_bvh
from .fcurves import write_motion
from .footage_to_scene import show_footage


def write_scene(take: Take, motion: Motion, blend_path: Path, bvh_path: Path | None = None) -> str:
    """Write a motion as a .blend and, if asked for, as a BVH; returns the SHA-256 of the Action's curves.

    The .blend holds the actor's armature with the motion as its Action, a skin in the markers' colors, and
    the camera with the clip behind it; the clip's path is relative where the drives allow. An error may leave
    half a file: the caller passes a staging folder and moves the files when both are complete.
    """
    with own_scene(f"{take.name} Motion") as scene:
        frames = show_take(scene, take, motion)
        armature_object = build_armature(scene, take.body, "Actor")
        write_motion(armature_object, motion, frames=frames)
        build_body_mesh(armature_object, take.body, take.markers)
        scene.frame_set(scene.frame_start)
        write_blend(blend_path, {scene}, path_remap="RELATIVE_ALL", fake_user=False)
        if bvh_path is not None:
            write_bvh(armature_object, bvh_path)
        return curve_digest(armature_object)


def show_take(scene: Scene, take: Take, motion: Motion) -> Array:
    """Put footage and camera into a scene, with rate, range and look; the motion's scene frames (F,)."""
    _, frames = show_footage(scene, take.camera, take.clip, motion.fps, motion.frame_start, motion.time_s)
    scene.frame_end = max(scene.frame_end, int(np.floor(frames[-1])))
    set_look(scene)
    return frames


def set_look(scene: Scene) -> None:
    """Workbench in material colors, which every Blender has, and light for the other engines."""
    scene.render.engine = "BLENDER_WORKBENCH"
    scene.display.shading.color_type = "MATERIAL"
    # It shows colors as they are given, so that markers look as in the footage; the default, AgX, does not.
    scene.view_settings.view_transform = "Standard"
    scene.world = bpy.data.worlds.new("Soft Light")
    scene.world.color = (0.8, 0.8, 0.8)
