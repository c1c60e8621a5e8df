"""Read the actor's armature as core's `Rig`: from channels to the world."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

import bpy
import numpy as np

from ...core.arrays import Array
from ...core.body.body_volume import sole_offsets
from ...core.body.human import HUMAN
from ...core.body.kinematics import Body
from ...core.body.posture import Posture
from ...core.body.skeleton import SIDES
from ...core.finish.hermite import Spline
from ...core.finish.key_reduction import reduce_keys
from ...core.finish.natural_extremities import natural_extremities
from ...core.finish.planted_feet import Contact, PlantedFeet, plant_feet, point_tolerances
from ...core.finish.rig import Rig, RigBone, RigPose
from ...core.progress import Job, Progress, within
from .actor_lengths import read_body, skeleton_bones
from .armature import BoneModel, bone_models
from .extremity_curves import turned_extremities
from .final_motion import (
    largest_leg_distance_m,
    motion_frames,
    posed_indices,
    read_values,
    shown_postures,
    with_planted_legs,
    with_turned_extremities,
    write_final,
)
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


# --- Finish the reconstructed motion of an Action


PLANTING = "Planting the feet"
READ, SEEN, PLANTED = 0.1, 0.3, 0.4
"""Shares of the job at which the motion is read, its postures are known, and the feet are planted."""
NOTICEABLE_M = 0.005
"""Distance between a pose and its nearest posture above which a note is made [m]."""


@dataclass(frozen=True)
class FinishOptions:
    """Options of the final motion."""

    tolerance_m: float | None
    """Largest distance of the body from the motion [m]; None for a key on every frame."""
    whole_pose: bool
    """Whether all bones are keyed on the same frames."""
    stray_m: float | None
    """Distance that a resting foot may stray and still be held [m]; None to leave feet alone."""


@dataclass(frozen=True, eq=False)
class Finished:
    """A finished motion, not yet written."""

    body: Body
    rig: Rig
    frames: Array
    """(F,) scene frames."""
    motion: Sequence[Array] | Sequence[Spline]
    """For each bone of the rig its values on every frame, or few keys."""
    furthest_m: float
    """The largest distance from the motion that reducing the keys makes [m]."""
    contacts: tuple[Contact, ...]
    """The planted feet."""
    notes: tuple[str, ...]

    @property
    def keys_before(self) -> int:
        """Number of keys before the reduction."""
        channels = sum((held.values if isinstance(held, Spline) else held).shape[1] for held in self.motion)
        return int(channels * len(self.frames))

    def write(
        self, armature_object: bpy.types.Object, motion_action: bpy.types.Action, action: bpy.types.Action
    ) -> int:
        """Write the motion into an Action; returns how many keys it has now.

        Args:
            armature_object: The actor.
            motion_action: The reconstructed motion.
            action: The final Action.
        """
        return write_final(
            armature_object, motion_action, action, self.body, self.rig, self.frames, self.motion
        )


def finish_motion(
    armature_object: bpy.types.Object,
    action: bpy.types.Action,
    keyframe_action: bpy.types.Action | None,
    options: FinishOptions,
    frame_s: float,
) -> Job[Finished]:
    """Finish the motion that an Action holds, with the animator's changes.

    Args:
        armature_object: The actor.
        action: The motion.
        keyframe_action: The animator's keyframes; their frames stay keys.
        options: Tolerance, keys and feet.
        frame_s: Time from one scene frame to the next [s].

    Yields:
        Progress; nothing in Blender is changed.

    Raises:
        InputError: The Action has no motion of the actor, or the armature is not an actor's.
    """
    body = read_body(armature_object, HUMAN)
    turned = turned_extremities(armature_object, body.skeleton, action, keyframe_action)
    rig = read_rig(armature_object, body, turned)
    frames = motion_frames(armature_object, action, body)
    exact = posed_indices(armature_object, keyframe_action, body.skeleton, frames)
    reading = read_values(armature_object, action, rig, frames)
    values = yield from within("Reading the motion", reading, 0.0, READ)
    yield Progress(PLANTING, READ)
    time_s = (frames - frames[0]) * frame_s
    shown = rig.pose(values)
    planted = PlantedFeet(shown_postures(armature_object, rig, shown, body), ())
    notes: tuple[str, ...] = ()
    yield Progress(PLANTING, SEEN)
    if options.stray_m is not None:
        before = planted.posture
        planting = plant_feet(body, before, time_s, options.stray_m)
        planted = yield from within(PLANTING, planting, SEEN, PLANTED)
        notes = _planting_notes(rig, shown, body, before, planted)
        if planted.contacts:
            values = with_planted_legs(armature_object, rig, values, planted.posture)
    if turned:
        contacts = planted.contacts or None
        natural = natural_extremities(body, planted.posture, time_s, contacts)
        where = {name: np.isin(frames, np.round(own, 3)) for name, own in turned.items()}
        values = with_turned_extremities(armature_object, rig, values, planted.posture, natural, where)
    if options.tolerance_m is None:
        return Finished(body, rig, frames, values, 0.0, planted.contacts, notes)
    allowed = point_tolerances(rig, len(frames), options.tolerance_m, planted.contacts)
    reducing = reduce_keys(rig, frames, values, allowed, exact, options.whole_pose)
    reduced = yield from within("Finding the keys", reducing, PLANTED, 1.0)
    return Finished(body, rig, frames, reduced.splines, reduced.furthest_m, planted.contacts, notes)


def _planting_notes(
    rig: Rig, shown: RigPose, body: Body, before: Posture, planted: PlantedFeet
) -> tuple[str, ...]:
    if not planted.contacts:
        return ("No foot rests long enough to be planted; raise Foot Stray to hold feet that sway",)
    beyond_m = largest_leg_distance_m(rig, shown, body, before)
    if beyond_m <= NOTICEABLE_M:
        return ()
    return (
        (
            f"The motion goes up to {1000.0 * beyond_m:.0f} mm beyond what the skeleton's legs can do; "
            "planting the feet uses the nearest posture"
        ),
    )
