"""The final motion: planted feet and few keys, made of a reconstructed motion with the animator's changes."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from bpy.types import Action, Object

from ...core.arrays import Array, BoolArray, IndexArray
from ...core.body.fingers import FINGER_BONES
from ...core.body.kinematics import RIGID, Body, Extremities
from ...core.body.posture import Posture
from ...core.body.skeleton import SIDES
from ...core.feet.contacts import Contact
from ...core.feet.ground import floor_notes
from ...core.feet.natural_extremities import natural_extremities
from ...core.feet.planted_feet import PlantedFeet, plant_feet
from ...core.feet.soles import ground_of
from ...core.keys.hermite import Spline, values_of
from ...core.keys.key_reduction import reduce_keys
from ...core.keys.rig import Rig
from ...core.keys.tolerances import NEAR_FLOOR_M, foot_rows, point_tolerances
from ...core.progress import Job, Progress, within
from . import rig as rigs
from .actions import channelbag_for, curves_of
from .armature import read_body, read_bones
from .fcurves import moved_paths, posture_columns, turned_extremities
from .keyframes import keyed_frames, unchanged_keyframes
from .keys import FOUND, copy_keys, ensure_fcurve, write_column
from .rig import read_rig, read_values, rig_channels, shown_postures
from .rotation_modes import ALL_PATHS, bone_path

PLANTING = "Planting the feet"
REVIEW = " (Keymark)"  # end of the names of properties in which 0.1.0 told how good a motion is
READ, SEEN, PLANTED, BODY_KEYED = 0.1, 0.3, 0.4, 0.8
"""Shares of the job at which the motion is read, its postures are known, the feet are planted, and the keys
of the body are found where fingers have some."""
MOVED_BY_FEET = ("pelvis", "thigh", "shin")  # segments that planting feet moves
NOTICEABLE_M = 0.005  # distance between a pose and its nearest posture above which a note is made [m]


@dataclass(frozen=True)
class FinishOptions:
    """Options of the final motion."""

    tolerance_m: float | None  # largest distance of the body from the motion; None for a key on every frame
    whole_pose: bool  # whether all bones are keyed on the same frames
    stray_m: float | None  # how far a resting foot may stray and still be held; None to leave feet alone


@dataclass(frozen=True, eq=False)
class Finished:
    """A finished motion, not yet written."""

    body: Body
    rig: Rig
    frames: Array  # (F,) scene frames
    motion: Sequence[Array] | Sequence[Spline]  # by bone of the rig, values on every frame or few keys
    furthest_m: float  # the largest distance from the motion that reducing the keys makes [m]
    contacts: tuple[Contact, ...]  # the planted feet
    notes: tuple[str, ...]

    @property
    def keys_before(self) -> int:
        """Number of keys before the reduction."""
        return sum(values_of(held).shape[1] for held in self.motion) * len(self.frames)

    def write(self, armature_object: Object, source: Action, action: Action) -> int:
        """Write the motion as ordinary keys, replacing all that the Action held for the actor.

        Other curves of `source`, from which the motion was read (posed hands and feet, properties), are
        copied, but for what 0.1.0 told of a motion there. Returns the number of keys on the bones' curves.
        """
        channelbag = channelbag_for(action, armature_object)
        for fcurve in list(channelbag.fcurves):
            channelbag.fcurves.remove(fcurve)
        count = 0
        for bone, column, path, index in rig_channels(self.rig):
            fcurve = ensure_fcurve(channelbag, path, index, self.rig.bones[bone].name)
            write_column(fcurve, self.frames, self.motion[bone], column)
            count += len(fcurve.keyframe_points)
        written = set(moved_paths(armature_object))
        written |= {bone_path(bone.name, channel) for bone in self.rig.bones for channel in ALL_PATHS}
        for (path, index), fcurve in curves_of(source, armature_object).items():
            if path not in written and REVIEW not in path:
                group = fcurve.group.name if fcurve.group is not None else armature_object.name
                copy_keys(fcurve, ensure_fcurve(channelbag, path, index, group))
        action.use_frame_range = True
        action.frame_start, action.frame_end = float(self.frames[0]), float(self.frames[-1])
        return count


def finish_motion(
    armature_object: Object,
    action: Action,
    keyframe_action: Action | None,
    options: FinishOptions,
    frame_s: float,
) -> Job[Finished]:
    """Finish the motion in an Action; keyframes stay keys. `frame_s` is the time of a scene frame [s]."""
    body = read_body(armature_object)
    turned = turned_extremities(armature_object, action, keyframe_action)
    rig = read_rig(armature_object, body, turned)
    frames = rigs.motion_frames(armature_object, action)
    exact = np.zeros(0, dtype=np.intp)  # indices of the frames that the animator posed
    if keyframe_action is not None:
        found = unchanged_keyframes(armature_object, keyframe_action, FOUND)
        posed = np.setdiff1d(keyed_frames(armature_object, keyframe_action), found)
        exact = np.flatnonzero(np.isin(frames, np.round(posed)))
    reading = read_values(armature_object, action, rig, frames)
    values = yield from within("Reading the motion", reading, 0.0, READ)
    yield Progress(PLANTING, READ)
    time_s = (frames - frames[0]) * frame_s
    shown = rig.pose(values)
    planted = PlantedFeet(shown_postures(rig, shown, body), ())
    away = rigs.absence_note(armature_object, action, 1.0 / frame_s)
    notes: tuple[str, ...] = (away,) if away else ()
    yield Progress(PLANTING, SEEN)
    if options.stray_m is not None:
        before = planted.posture
        planting = plant_feet(body, before, time_s, options.stray_m)
        planted = yield from within(PLANTING, planting, SEEN, PLANTED)
        moved = [row for row, bone in enumerate(rig.bones) if bone.name.partition(".")[0] in MOVED_BY_FEET]
        if planted.contacts:
            pose, slices = body.pose(before), rig.point_slices
            ends = [shown.points[:, slices[row].start + 1] for row in moved]
            off_m = max(
                np.linalg.norm(end - body.segment_ends(pose, rig.bones[row].name)[1], axis=-1).max()
                for row, end in zip(moved, ends, strict=True)
            )
            if off_m > NOTICEABLE_M:
                far = f"The motion goes up to {1000.0 * off_m:.0f} mm beyond what the skeleton's legs can do"
                notes += (f"{far}; planting the feet uses the nearest posture",)
            every = {rig.bones[row].name: np.ones(len(frames), dtype=bool) for row in moved}
            values = _replaced(armature_object, rig, values, planted.posture, every)
        else:
            notes += ("No foot rests long enough to be planted; raise Feet May Sway to hold feet that sway",)
    if turned:
        contacts = planted.contacts or None
        natural = natural_extremities(body, planted.posture, time_s, contacts)
        # Planting moves legs and feet: hands and fingers stay as they were turned.
        where = {
            name: np.isin(frames, np.round(own, 3)) for name, own in turned.items() if name.startswith("foot")
        }
        values = _replaced(armature_object, rig, values, planted.posture, where, natural)
        for held, bone in zip(values, rig.bones, strict=True):
            if bone.name in where and bone.mode == "QUATERNION":
                held[:, :4] = rigs.unit_quaternions(held[:, :4])
    floor_m = None
    if planted.contacts:
        floor_m = ground_of(body, body.pose(planted.posture), time_s, planted.contacts).height_m

    furthest_m = 0.0
    motion: Sequence[Array] | Sequence[Spline] = values
    if options.tolerance_m is not None:
        near = None if floor_m is None else _soles_m(rig, values) - floor_m < NEAR_FLOOR_M
        allowed = point_tolerances(rig, len(frames), options.tolerance_m, planted.contacts, near)
        splines, furthest_m = yield from _few_keys(rig, frames, values, allowed, exact, options)
        values = [spline.evaluate(frames, 0, len(frames) - 1) for spline in splines]
        motion = splines
    if floor_m is not None:
        depths = (floor_m - _soles_m(rig, values)).T
        notes += floor_notes(dict(zip(SIDES, depths, strict=True)), frames)
    return Finished(body, rig, frames, motion, furthest_m, planted.contacts, notes)


def _few_keys(
    rig: Rig, frames: Array, values: list[Array], allowed: Array, exact: IndexArray, options: FinishOptions
) -> Job[tuple[tuple[Spline, ...], float]]:
    """Few keys for each bone of a rig within distances that are allowed (F, points), and the farthest [m]."""
    # Fingers come last and move nothing else: apart from the body they take a fraction of the time.
    fingers = 0 if options.whole_pose else sum(bone.name in FINGER_BONES for bone in rig.bones)
    count = len(rig.bones) - fingers
    points = allowed[:, : rig.point_slices[count - 1].stop]
    reducing = reduce_keys(Rig(rig.bones[:count]), frames, values[:count], points, exact, options.whole_pose)
    reduced = yield from within("Finding the keys", reducing, PLANTED, BODY_KEYED if fingers else 1.0)
    if not fingers or options.tolerance_m is None:
        return reduced.splines, reduced.furthest_m
    apart = Rig(tuple(replace(bone, parent=max(bone.parent - count, -1)) for bone in rig.bones[count:]))
    reducing = reduce_keys(apart, frames, values[count:], options.tolerance_m, exact)
    bent = yield from within("Finding the keys", reducing, BODY_KEYED, 1.0)
    return reduced.splines + bent.splines, reduced.furthest_m


def _soles_m(rig: Rig, values: list[Array]) -> Array:
    """(F, 2) height of the lower of heel and tip of each foot [m]; infinite without bones of their own."""
    shown = rig.pose(values)
    heights = [shown.points[:, foot_rows(rig, side)[1:], 2] for side in SIDES]
    return np.stack([own.min(axis=1, initial=np.inf) for own in heights], axis=1)


def _replaced(
    armature_object: Object,
    rig: Rig,
    values: Sequence[Array],
    posture: Posture,
    where: Mapping[str, BoolArray],
    extremities: Extremities = RIGID,
) -> list[Array]:
    """Values with those of postures in the frames `where` (F,) says of each bone; the rest stays."""
    columns = posture_columns(read_bones(armature_object), posture, extremities)
    stored = {(path, index): column for path, index, _, column in columns}
    changed = [column.copy() for column in values]
    for bone, column, path, index in rig_channels(rig):
        rows = where.get(rig.bones[bone].name)
        if rows is not None:
            changed[bone][rows, column] = stored[path, index][rows]
    return changed
