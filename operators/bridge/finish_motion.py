"""Finish the reconstructed motion of an Action: feet planted, keys reduced."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import bpy

from ...core.arrays import Array
from ...core.body.human import HUMAN
from ...core.body.kinematics import Body
from ...core.finish.contacts import Contact
from ...core.finish.hermite import Spline
from ...core.finish.key_reduction import reduce_keys
from ...core.finish.planted_feet import plant_feet, point_tolerances
from ...core.finish.rig import Rig
from ...core.progress import Job, Progress, within
from .actor_lengths import read_body
from .final_motion import (
    largest_leg_distance_m,
    motion_frames,
    posed_indices,
    read_values,
    shown_postures,
    with_planted_legs,
    write_final,
)
from .rig import read_rig

Note = tuple[str, dict[str, Any]]
"""A sentence's template, and what fills its braces."""

READ, SEEN, PLANTED = 0.1, 0.3, 0.4
"""Shares of the job at which the motion is read, its postures are known, and the feet are planted."""
NOTICEABLE_M = 0.005
"""Distance between a pose and its nearest posture above which a note is made [m]."""
BEYOND = (
    "The motion goes up to {distance:.0f} mm beyond what the skeleton's legs can do; planting the feet uses "
    "the nearest posture"
)
NO_REST = "No foot rests long enough to be planted; raise Foot Stray to hold feet that sway"


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
    notes: tuple[Note, ...]

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
    rig = read_rig(armature_object, body)
    frames = motion_frames(armature_object, action, body)
    exact = posed_indices(armature_object, keyframe_action, body.skeleton, frames)
    reading = read_values(armature_object, action, rig, frames)
    values = yield from within("Reading the motion", reading, 0.0, READ)
    contacts: tuple[Contact, ...] = ()
    notes: tuple[Note, ...] = ()
    if options.stray_m is not None:
        time_s = (frames - frames[0]) * frame_s
        planting = _plant(armature_object, body, rig, values, time_s, options.stray_m)
        values, contacts, notes = yield from planting
    if options.tolerance_m is None:
        return Finished(body, rig, frames, values, 0.0, contacts, notes)
    allowed = point_tolerances(rig, len(frames), options.tolerance_m, contacts)
    reducing = reduce_keys(rig, frames, values, allowed, exact, options.whole_pose)
    reduced = yield from within("Finding the keys", reducing, PLANTED, 1.0)
    return Finished(body, rig, frames, reduced.splines, reduced.furthest_m, contacts, notes)


def _plant(
    armature_object: bpy.types.Object,
    body: Body,
    rig: Rig,
    values: list[Array],
    time_s: Array,
    stray_m: float,
) -> Job[tuple[list[Array], tuple[Contact, ...], tuple[Note, ...]]]:
    stage = "Planting the feet"
    yield Progress(stage, READ)
    shown = rig.pose(values)
    posture = shown_postures(armature_object, rig, shown, body)
    yield Progress(stage, SEEN)
    planted = yield from within(stage, plant_feet(body, posture, time_s, stray_m), SEEN, PLANTED)
    if not planted.contacts:
        return values, (), ((NO_REST, {}),)
    notes: tuple[Note, ...] = ()
    beyond_m = largest_leg_distance_m(rig, shown, body, posture)
    if beyond_m > NOTICEABLE_M:
        notes = ((BEYOND, {"distance": 1000.0 * beyond_m}),)
    return with_planted_legs(armature_object, rig, values, planted.posture), planted.contacts, notes
