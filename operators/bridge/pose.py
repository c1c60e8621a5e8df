"""Read a posture from an armature's evaluated pose, and pose an armature."""

from dataclasses import dataclass

import bpy
import numpy as np

from ...core.arrays import Array
from ...core.body.kinematics import Body
from ...core.body.posture import Posture
from .actor_lengths import read_bones, skeleton_bones
from .fcurves import posture_columns
from .object_space import evaluated, object_space
from .rotation_modes import posture_from_frames


@dataclass(frozen=True, eq=False)
class PoseReading:
    """An armature's pose as a posture, and the distance between both."""

    posture: Posture  # the nearest posture the skeleton can take
    distance_m: Array  # (13,) distance of each principal point between the pose and the posture [m]

    @property
    def furthest_m(self) -> float:
        """The largest of the distances [m]: rounding only, where the pose keeps to the skeleton."""
        return float(self.distance_m.max())


def read_posture(armature_object: bpy.types.Object, body: Body) -> PoseReading:
    """The posture an armature shows now, constraints and parents included; `body` as `read_body` finds it.

    Exact where the pose keeps to the skeleton's freedoms; otherwise the nearest posture, and the distance
    says by how much the armature went beyond them.
    """
    models = skeleton_bones(armature_object, body.skeleton)
    space = object_space(armature_object)
    pose_bones = evaluated(armature_object).pose.bones
    frames: dict[str, Array] = {}
    heads: dict[str, Array] = {}
    for model in models:
        matrix = np.array(pose_bones[model.name].matrix, dtype=np.float64)
        turn = matrix[:3, :3] / np.linalg.norm(matrix[:3, :3], axis=0)
        frames[model.name] = space.rotation @ turn @ model.axes.T
        heads[model.name] = space.to_world(matrix[:3, 3])
    root = next(model for model in models if model.is_root)
    hips = heads[root.name] - frames[root.name] @ root.start
    posture = posture_from_frames(body.skeleton, models, frames, hips)
    shown = np.empty((len(body.skeleton.points), 3))
    bone_of_joint = {joint: model for model in reversed(models) for joint in (model.joint, *model.chain)}
    for row, (point, local) in enumerate(zip(body.skeleton.points, body.point_places, strict=True)):
        model = bone_of_joint[point.joint]
        start = body.local(body.skeleton.segment(model.name).start)
        shown[row] = heads[model.name] + frames[model.name] @ (local - start)
    reached = body.points(body.pose(posture))
    return PoseReading(posture, np.linalg.norm(reached - shown, axis=-1))


def write_posture(armature_object: bpy.types.Object, posture: Posture) -> None:
    """Show a single posture, in each bone's own rotation mode; nothing is keyed.

    Bones without degrees of freedom (hands, feet) keep what they have.
    """
    bones = read_bones(armature_object, posture.skeleton)
    for model in bones.models:
        if model.chain:
            pose_bone = armature_object.pose.bones[model.name]
            pose_bone.location, pose_bone.scale = (0.0, 0.0, 0.0), (1.0, 1.0, 1.0)
    for path, index, _, column in posture_columns(bones, Posture.stack([posture])):
        armature_object.path_resolve(path)[index] = column[0]
    evaluated(armature_object)
