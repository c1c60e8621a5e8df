"""Read the actor's armature as core's `Rig`: from channels to the world."""

from collections.abc import Collection, Mapping

import bpy
import numpy as np

from ...core.body.kinematics import Body
from ...core.body.skeleton import SIDES
from ...core.body.soles import sole_offsets
from ...core.finish.rig import Rig, RigBone
from .actor_lengths import skeleton_bones
from .bones import BoneModel, bone_models
from .object_space import ObjectSpace, object_space


def read_rig(armature_object: bpy.types.Object, body: Body, extremities: Collection[str] = ()) -> Rig:
    """Read the bones with degrees of freedom, in their rotation modes, with the ends of hands and feet.

    `bone_channels` run backwards: a bone's posed axes are its rest axes turned by its channels.

    Args:
        armature_object: An armature with the skeleton's bones, with any location, even scale and rest pose.
        body: The skeleton, with the sizes that `read_body` finds in the armature.
        extremities: Names of hands and feet that turn; the others are rigid with their limbs.

    Raises:
        InputError: A bone is missing, or the object is scaled unevenly.
    """
    axes = {model.name: model.axes for model in skeleton_bones(armature_object, body.skeleton)}
    names = list(axes)
    bones = armature_object.data.bones
    rest = {name: np.array(bones[name].matrix_local, dtype=np.float64) for name in names}
    modes = {name: armature_object.pose.bones[name].rotation_mode for name in names}
    return rig_at_rest(body, axes, rest, modes, object_space(armature_object), extremities)


def rig_at_rest(
    body: Body,
    axes: Mapping[str, np.ndarray],
    rest: Mapping[str, np.ndarray],
    modes: Mapping[str, str],
    space: ObjectSpace,
    extremities: Collection[str] = (),
) -> Rig:
    """A rig as `read_rig` gives it, of bones that need not be in an armature.

    Args:
        body: Skeleton and sizes.
        axes: (3, 3) each bone's axes in its joint's frame.
        rest: (4, 4) rest matrix of each bone, in the object's space.
        modes: Rotation mode of each bone.
        space: From the object's space to the world.
        extremities: Names of hands and feet that turn.
    """
    models = bone_models(body)
    turning = [model for model in models if model.chain or model.name in extremities]
    names = [model.name for model in turning]
    bones = []
    for model in turning:
        own = rest[model.name][:3, :3]
        origin, location_axes = _joint_place(model, body), None
        if model.parent is None:
            left = space.rotation @ own
            origin, location_axes = (
                space.to_world(rest[model.name][:3, 3]),
                space.scale * space.rotation @ own,
            )
        else:
            left = axes[model.parent] @ rest[model.parent][:3, :3].T @ own
        bones.append(
            RigBone(
                name=model.name,
                parent=-1 if model.parent is None else names.index(model.parent),
                mode=modes[model.name],
                left=left,
                right=axes[model.name].T,
                origin=origin,
                points=_fixed_points(model, body, models, names),
                location_axes=location_axes,
            )
        )
    return Rig(tuple(bones))


def _joint_place(model: BoneModel, body: Body) -> np.ndarray:
    """(3,) the bone's joint in its parent's joint's frame; a hand's is the wrist, a foot's the ankle [m]."""
    return body.offsets[model.chain[0]] if model.chain else model.start


def _fixed_points(
    model: BoneModel, body: Body, models: tuple[BoneModel, ...], turning: Collection[str]
) -> np.ndarray:
    """(N, 3) the bone's own end, a foot's heel, and the ends of rigid hands and feet, in its frame [m]."""
    if not model.chain:
        kind, _, side = model.name.partition(".")
        heel = [sole_offsets(body)[SIDES.index(side), 0]] if kind == "foot" else []
        return np.stack([model.end - model.start, *heel])
    leaves = [m.end for m in models if m.parent == model.name and not m.chain and m.name not in turning]
    return np.stack([model.end, *leaves])
