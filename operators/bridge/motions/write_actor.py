"""A motion on Keymark's own armature: in a scene, and as a BVH."""

from pathlib import Path

import bpy
import numpy as np

from ....core.take.motion import Motion
from ..armature import build_armature
from ..blend_files import own_scene
from ..character.source import show_result
from ..export_formats import write_bvh
from ..fcurves import write_motion


def write_actor_bvh(motion: Motion, path: Path) -> None:
    """Write a motion as a BVH, from a scene of its own.

    Raises:
        ConversionError: Blender's exporter failed.
    """
    with own_scene("Mended Motion") as scene:
        frames = show_result(scene, None, motion)
        actor = build_armature(scene, motion.body, "Actor")
        write_motion(actor, motion, frames=np.asarray(frames))
        write_bvh(actor, path)


def add_actor(
    scene: bpy.types.Scene, motion: Motion, name: str, first: int | None = None
) -> bpy.types.Object:
    """Add an actor with a motion to a scene, which keeps its rate; it begins at `first` or its own frame."""
    actor = build_armature(scene, motion.body, name)
    rate = scene.render.fps / scene.render.fps_base
    frames = (motion.frame_start if first is None else first) + motion.time_s * rate
    write_motion(actor, motion, frames=np.asarray(frames)).name = f"{name} Motion"
    return actor
