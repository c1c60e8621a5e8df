"""A motion as a BVH of Keymark's own armature."""

from pathlib import Path

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
