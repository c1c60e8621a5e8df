"""The places of a person's joints over a scene's frames, of any armature, for files of points."""

import bpy
import numpy as np

from ....core.arrays import Array
from ....core.progress import run
from ....core.retarget.mended_armature import ArmaturePoints
from ....core.retarget.solve.rest_body import RestBody
from ..actor_bones import is_actor
from ..character.read_character import read_character
from ..object_space import joint_places
from ..scene_frames import at_scene_frame
from .read_poses import animated_action, motion_map, read_poses


def joint_paths(armature_object: bpy.types.Object) -> tuple[Array, float]:
    """(F, 13, 3) the principal points over the frames of an armature's scene [m], and their rate.

    Raises:
        InputError: It has no Action, or is no person's.
    """
    scene = next(iter(armature_object.users_scene), bpy.context.scene)
    frames = np.arange(scene.frame_start, scene.frame_end + 1, dtype=np.float64)
    rate = scene.render.fps / scene.render.fps_base
    if is_actor(armature_object):
        places = []
        with at_scene_frame(scene) as go_to:
            for frame in frames:
                go_to(frame)
                places.append(joint_places(armature_object))
        return np.array(places), rate
    character_map = motion_map(armature_object, ()).character_map
    points = ArmaturePoints.of(RestBody.of(read_character(armature_object), character_map))
    bones = tuple(dict.fromkeys(points.bones))
    poses, _ = run(read_poses(armature_object, animated_action(armature_object), frames, bones))
    return points.of_poses(poses), rate
