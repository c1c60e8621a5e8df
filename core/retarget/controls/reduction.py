"""Few keys on a character's controls, FK and IK together, within a tolerance of the character itself.

The body's keys are found first, then those of its legs in FK, then of what follows in IK. Legs are fitted to
the body that its few keys show, so that a resting foot rests however smooth the hips have become. Goals of
limbs that have both are fitted to the very places that the FK keys lead to, so that switching between them
moves nothing.
"""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from ...arrays import Array
from ...keys.key_reduction import reduce_keys
from ...keys.rig import NO_TURN, Rig, RigBone
from ...progress import Part, scaled
from .control_channels import Control, ControlChannels, control_channels
from .control_motion import ChannelValues, ControlMotion, KeyedControl
from .control_plan import ControlKind
from .control_spaces import NOTHING
from .control_targets import leg_on_body
from .point_tolerances import CARRIED_SHARE, SWITCH_M, HeldPoint, PointKind, ToleranceRules

AFTER_BODY = (ControlKind.GOAL, ControlKind.TOE, ControlKind.POLE, ControlKind.FINGER)
Toleranced = tuple[Array, Array | Callable[[Array], Array]]
"""A point (3,) in its control's axes [m], and its tolerance (F,), or that from its path (F, 3) in the
armature's."""
Keyed = tuple[dict[int, KeyedControl], dict[int, ControlChannels]]
"""By index what is keyed on each control, and its channels with the poses that the keys show."""


@dataclass(frozen=True)
class FollowingControls:
    """Controls that hang together and are fitted after what carries them."""

    controls: tuple[int, ...]  # indices among all controls, rising
    carrier: int  # index of the control that carries and turns them; NOTHING for none
    leg: str | None = None  # the leg that they are in FK


def reduce_controls(
    motion: ControlMotion, times: Array, rules: ToleranceRules, of: ChannelValues
) -> Part[tuple[KeyedControl, ...]]:
    """Find few keys for every control of a motion at rising scene frames (F,), at least two."""
    legs: dict[str, tuple[int, list[int]]] = {}
    for leg, limb in motion.limbs.items():
        if leg.startswith("leg") and limb.in_fk and limb.root_control != NOTHING:
            bones = {point.bone for point in motion.points if point.limb == leg}
            members = [index for bone in bones if (index := motion.fk_control(bone)) is not None]
            legs[leg] = (limb.root_control, members)
    body, following = control_stages(motion.controls, legs)
    keyed: dict[int, KeyedControl] = {}
    shown: dict[int, ControlChannels] = {}
    done = 0.0
    if body:
        # Share of the work that the body's controls are, where others follow.
        done = 0.5 if following else 1.0
        points: dict[int, list[Toleranced]] = {
            index: [
                (place, partial(_tolerance, motion, rules, None, point))
                for point, place in motion.points_of(index)
            ]
            for index in body
        }
        for name, limb in motion.limbs.items():  # the roots of the limbs that are fitted after it
            follows = not limb.in_fk or name in {group.leg for group in following}
            if limb.root_control in points and follows:
                root_m = rules.reach_m(motion.joints_m(name), CARRIED_SHARE)
                points[limb.root_control].append((motion.scale * limb.root_place, root_m))
        part = _reduced(motion, motion.channels, times, rules.body_m, of, points)
        keyed, shown = yield from scaled(part, 0.0, done)
    share = (1.0 - done) / max(len(following), 1)
    for group in following:
        part = _reduce_following(motion, times, rules, of, group, shown)
        more, now = yield from scaled(part, done, done + share)
        keyed |= more
        shown |= now
        done += share
    return tuple(keyed[index] for index in range(len(motion.controls)))


# --- In which order the keys are found


def control_stages(
    controls: Sequence[Control], legs: Mapping[str, tuple[int, Collection[int]]]
) -> tuple[tuple[int, ...], tuple[FollowingControls, ...]]:
    """Indices of the controls that are fitted first, rising, and the others in the order of their fitting.

    `legs` are those in FK: the control that carries each, and the indices of its own.
    """
    above = [{control.space.turner, control.space.carrier} for control in controls]
    later: list[bool] = []
    for control, over in zip(controls, above, strict=True):
        later.append(
            control.plan.kind in AFTER_BODY or any(later[other] for other in over if other != NOTHING)
        )
    chains = []
    for leg, (carrier, members) in legs.items():
        others = [index for index in range(len(controls)) if index not in members and not later[index]]
        carries = any(above[index] & set(members) for index in others)
        if set().union(*(above[index] for index in members)) - set(members) == {carrier} and not carries:
            chains.append(FollowingControls(tuple(sorted(members)), carrier, leg))
    apart = {index for chain in chains for index in chain.controls}
    body = {index for index, late in enumerate(later) if not late} - apart
    # For each control that follows the first of those that it hangs together with.
    group: dict[int, int] = {}
    for index in sorted(set(range(len(controls))) - apart - body):
        near = {group[other] for other in above[index] if other in group}
        group[index] = min(near, default=index)
        group |= {other: group[index] for other, name in group.items() if name in near}
    for name in sorted(set(group.values())):
        members = tuple(index for index in sorted(group) if group[index] == name)
        outside = set().union(*(above[index] for index in members)) - set(members)
        if len(outside) == 1:
            chains.append(FollowingControls(members, outside.pop()))
        else:  # turned by one and carried by another: only the whole rig shows where they are
            body |= set(members)
    return tuple(sorted(body)), tuple(chains)


# --- Some of the controls as a rig, in meters, in the axes of the armature or of what carries them


def control_rig(
    controls: Sequence[Control],
    channels: Sequence[ControlChannels],
    points: Mapping[int, Array],
    scale: float,
) -> tuple[Rig, dict[int, int], dict[int, int]]:
    """The rig of the controls at rising indices, with points (N, 3) fixed to each, from its head [m].

    What turns or carries one of them and is not among them is taken as still: the rig's axes are its axes.
    A control that is moved has a bone for its location, so that it has keys of its own, and another one on it
    that turns and carries: the rows of both are returned by index.
    """
    bones: list[RigBone] = []
    moved: dict[int, int] = {}
    turned: dict[int, int] = {}
    still = np.eye(3)
    for index, own in points.items():
        name, space = controls[index].name, controls[index].space
        parent, turner = (turned.get(other, NOTHING) for other in (space.carrier, space.turner))
        origin = scale * space.origin
        if channels[index].location is not None:
            moved[index] = len(bones)
            none = np.zeros((0, 3))
            bones.append(RigBone(name, parent, NO_TURN, still, still, origin, none, scale * space.axes))
            parent, origin = moved[index], np.zeros(3)
        turned[index] = len(bones)
        mode = NO_TURN if channels[index].rotation is None else controls[index].mode
        turned_by = None if turner == parent else turner
        bones.append(RigBone(name, parent, mode, space.turn, still, origin, own, None, turned_by))
    return Rig(tuple(bones)), moved, turned


def _reduced(
    motion: ControlMotion,
    channels: Sequence[ControlChannels],
    times: Array,
    general_m: float,
    of: ChannelValues,
    points: Mapping[int, Sequence[Toleranced]],
    heads: Mapping[int, Array] | None = None,
) -> Part[Keyed]:
    """Find the keys of controls by index that hold their points, and their heads within (F,) [m]."""
    places = {
        index: np.array([place for place, _ in points[index]]).reshape(-1, 3) for index in sorted(points)
    }
    rig, moved, turned = control_rig(motion.controls, channels, places, motion.scale)
    values = [np.zeros((len(times), 0))] * len(rig.bones)
    for index, row in turned.items():
        rotation, location = channels[index].rotation, channels[index].location
        if rotation is not None:
            values[row] = of(rotation, motion.controls[index].mode)
        if location is not None:
            values[moved[index]] = location
    target = rig.pose(values).points
    allowed = np.full(target.shape[:2], general_m)
    for index, row in turned.items():
        start = rig.point_slices[row].start
        for column, (_, tolerance) in enumerate(points[index], start + 1):
            allowed[:, column] = tolerance(target[:, column]) if callable(tolerance) else tolerance
        if heads is not None and index in heads:
            allowed[:, start] = heads[index]
            allowed[:, rig.point_slices[moved.get(index, row)].start] = heads[index]
    reduced = yield from reduce_keys(rig, times, values, allowed, np.zeros(0, dtype=np.intp))
    pose = rig.pose([spline.evaluate(times, 0, len(times) - 1) for spline in reduced.splines])
    keyed, shown = {}, {}
    for index, row in turned.items():
        keyed[index] = KeyedControl(
            motion.controls[index],
            None if rig.bones[row].mode == NO_TURN else reduced.splines[row],
            reduced.splines[moved[index]] if index in moved else None,
        )
        place = pose.points[:, rig.point_slices[row].start] / motion.scale
        shown[index] = replace(channels[index], turn=pose.rotation[row], place=place)
    return keyed, shown


# --- What follows the body that its own few keys show


def _reduce_following(
    motion: ControlMotion,
    times: Array,
    rules: ToleranceRules,
    of: ChannelValues,
    group: FollowingControls,
    shown: Mapping[int, ControlChannels],
) -> Part[Keyed]:
    """Find the keys of controls that hang together; `shown` has the controls fitted before."""
    known = {index: shown.get(index, channels) for index, channels in enumerate(motion.channels)}
    carrier = known.get(group.carrier)
    known = {index: channels for index, channels in known.items() if index not in group.controls}
    controls = [motion.controls[index] for index in group.controls]
    if group.leg is None or group.carrier not in shown:
        own = {control.name: _followed(motion, rules, control, shown) for control in controls}
    else:
        bones = {**motion.bones, **leg_on_body(motion, group.leg, shown[group.carrier])}
        own = {
            control.name: bones[control.plan.bone] @ np.linalg.inv(motion.offsets[control.name])
            for control in controls
        }
    channels = motion.channels
    if any(control.plan.kind is not ControlKind.FINGER for control in controls):
        channels = control_channels(motion.controls, {**motion.wanted, **own}, motion.size, known)

    def held(point: HeldPoint, path: Array) -> Array:
        if carrier is not None:
            path = motion.scale * carrier.place + (carrier.turn @ path[..., None])[..., 0]
        return _tolerance(motion, rules, group, point, path)

    points = {
        index: [(place, partial(held, point)) for point, place in motion.points_of(index)]
        for index in group.controls
    }
    heads = {}
    for index, plan in zip(group.controls, (control.plan for control in controls), strict=True):
        if plan.kind is ControlKind.POLE:
            limb = str(plan.limb)
            distance_m = motion.scale * motion.limbs[limb].pole_distance
            heads[index] = rules.pole_m(motion.joints_m(limb), distance_m)
    keyed, local = yield from _reduced(motion, channels, times, rules.body_m, of, points, heads)
    if carrier is None:
        return keyed, local
    for index, one in local.items():
        place = carrier.place + (carrier.turn @ one.place[..., None])[..., 0]
        local[index] = replace(one, turn=carrier.turn @ one.turn, place=place)
    return keyed, local


def _followed(
    motion: ControlMotion, rules: ToleranceRules, control: Control, shown: Mapping[int, ControlChannels]
) -> Array:
    """(F, 4, 4) the pose of a control that brings hand or foot to where the FK keys have it.

    A resting foot is where it rests: the FK keys are a hair off.
    """
    wanted, fk = motion.wanted[control.name], motion.fk_control(control.plan.bone)
    limb = motion.limbs.get(str(control.plan.limb))
    if control.plan.kind is ControlKind.POLE or limb is None or not limb.in_fk or fk not in shown:
        return wanted
    assert fk is not None
    poses = np.tile(np.eye(4), (len(wanted), 1, 1))
    poses[:, :3, :3], poses[:, :3, 3] = shown[fk].turn, shown[fk].place
    offset = motion.offsets[motion.controls[fk].name] @ np.linalg.inv(motion.offsets[control.name])
    rests = rules.resting(control.plan.limb)[:, None, None]
    return np.where(rests, wanted, poses @ offset)


def _tolerance(
    motion: ControlMotion,
    rules: ToleranceRules,
    group: FollowingControls | None,
    point: HeldPoint,
    path: Array,
) -> Array:
    """(F,) tolerance of a point on its path (F, 3), of the body's controls or of some that follow them."""
    shows_ik, limb = motion.shows_ik(point.limb), motion.limbs.get(str(point.limb))
    if group is None:
        return rules.of(point, path, not shows_ik, rules.general_m)
    if group.leg is not None:
        allowed = rules.of(point, path, not shows_ik, rules.general_m)
        share = CARRIED_SHARE if point.kind is PointKind.BODY else 1.0
        return np.minimum(allowed, share * rules.body_m)
    ends_m = SWITCH_M if limb is not None and limb.in_fk else rules.general_m
    allowed = rules.of(point, path, True, ends_m)
    if point.limb is not None and shows_ik and point.kind is PointKind.END:
        allowed = np.minimum(allowed, rules.reach_m(motion.joints_m(point.limb)))
    return allowed
