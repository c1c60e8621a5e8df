"""Finish the reconstructed motion of an Action: feet planted, keys reduced."""

from collections.abc import Sequence
from dataclasses import dataclass

import bpy
import numpy as np

from ...core.arrays import Array
from ...core.body.human import HUMAN
from ...core.body.kinematics import Body
from ...core.body.posture import Posture
from ...core.finish.contacts import Contact
from ...core.finish.hermite import Spline
from ...core.finish.key_reduction import reduce_keys
from ...core.finish.natural_extremities import natural_extremities
from ...core.finish.planted_feet import PlantedFeet, plant_feet, point_tolerances
from ...core.finish.rig import Rig, RigPose
from ...core.progress import Job, Progress, within
from .actor_lengths import read_body
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
from .rig import read_rig

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
