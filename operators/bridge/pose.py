"""Read a posture from an armature's evaluated pose, and pose an armature."""

from dataclasses import dataclass

import numpy as np
from bpy.types import Object

from ...core.arrays import Array
from ...core.body.kinematics import Body
from ...core.body.posture import Posture
from .actor_lengths import read_bones, skeleton_bones
from .fcurves import posture_columns
from .object_space import evaluated, object_space
from .rotation_modes import posture_from_frames


@dataclass(frozen=True, eq=False)
class PoseReading:
    """An armature's pose as the nearest posture, and distances of the principal points between both [m]."""

    posture: Posture
    mean_m: float
    furthest_m: float  # rounding only, where the pose keeps to the skeleton


def read_posture(armature_object: Object, body: Body) -> PoseReading:
    """The posture nearest to what an armature of that body shows now, parents and constraints included."""
    models = skeleton_bones(armature_object)
    space = object_space(armature_object)
    pose_bones = evaluated(armature_object).pose.bones
    frames: dict[str, Array] = {}
    heads: dict[str, Array] = {}
    for model in models:
        matrix = np.array(pose_bones[model.name].matrix, dtype=np.float64)
        turn = matrix[:3, :3] / np.linalg.norm(matrix[:3, :3], axis=0)
        frames[model.name] = space.rotation @ turn @ model.axes.T
        heads[model.name] = space.to_world(matrix[:3, 3])
    hips = heads[models[0].name] - frames[models[0].name] @ models[0].start  # parents are first
    posture = posture_from_frames(models, frames, hips)
    shown = np.empty((len(body.skeleton.points), 3))
    bone_of_joint = {joint: model for model in reversed(models) for joint in (model.joint, *model.chain)}
    for row, (point, local) in enumerate(zip(body.skeleton.points, body.point_places, strict=True)):
        model = bone_of_joint[point.joint]
        start = body.local(body.skeleton.segment(model.name).start)
        shown[row] = heads[model.name] + frames[model.name] @ (local - start)
    distance_m = np.linalg.norm(body.points(body.pose(posture)) - shown, axis=-1)
    return PoseReading(posture, float(distance_m.mean()), float(distance_m.max()))


def write_posture(armature_object: Object, posture: Posture) -> None:
    """Show a posture, in each bone's own rotation mode, hands and feet as they are; nothing is keyed."""
    bones = read_bones(armature_object)
    for model in bones.models:
        if model.chain:
            pose_bone = armature_object.pose.bones[model.name]
            pose_bone.location, pose_bone.scale = (0.0, 0.0, 0.0), (1.0, 1.0, 1.0)
    for path, index, _, column in posture_columns(bones, Posture.stack([posture])):
        armature_object.path_resolve(path)[index] = column[0]
    evaluated(armature_object)
