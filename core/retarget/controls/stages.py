"""In which order the keys of controls are found: the body, then its legs in FK, then what follows in IK.

Legs are fitted to the body that its few keys show, so that a resting foot rests however smooth the hips have
become. Goals of limbs that have both are fitted to the very places that the FK keys lead to, so that
switching between them moves nothing.
"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ...arrays import Array
from ...finish.key_reduction import reduce_keys
from ...progress import Part, scaled
from ..character import LIMBS
from .control_channels import Control, ControlChannels, control_channels
from .control_motion import ChannelValues, ControlMotion, KeyedControl
from .control_plan import ControlKind
from .control_rig import control_rig
from .control_spaces import NOTHING
from .control_targets import leg_on_body
from .point_tolerances import (
    CARRIED_SHARE,
    SWITCH_M,
    HeldPoint,
    PointKind,
    ToleranceRules,
    pole_tolerance_m,
    reach_tolerance_m,
)

IN_IK = (ControlKind.GOAL, ControlKind.TOE, ControlKind.POLE)


@dataclass(frozen=True)
class FollowingControls:
    """Controls that hang together and are fitted after what carries them."""

    controls: tuple[int, ...]  # indices among all controls, rising
    carrier: int  # index of the control that carries and turns them; NOTHING for none
    leg: str | None = None  # the leg that they are in FK


@dataclass(frozen=True)
class ControlStages:
    """The controls in the order of their fitting."""

    body: tuple[int, ...]  # indices of the controls that are fitted first, rising
    following: tuple[FollowingControls, ...]  # the others


def control_stages(
    controls: Sequence[Control], legs: Mapping[str, tuple[int, Collection[int]]]
) -> ControlStages:
    """The controls in the order of their fitting."""
    later = [False] * len(controls)
    for index, control in enumerate(controls):
        above = _above(control)
        later[index] = control.plan.kind in IN_IK or any(other != NOTHING and later[other] for other in above)
    chains = []
    for leg, (carrier, members) in legs.items():
        others = [index for index in range(len(controls)) if index not in members and not later[index]]
        carries = any(_above(controls[index]) & set(members) for index in others)
        if _outside(controls, members) == {carrier} and not carries:
            chains.append(FollowingControls(tuple(sorted(members)), carrier, leg))
    apart = {index for chain in chains for index in chain.controls}
    body = {index for index in range(len(controls)) if not later[index]} - apart
    group = _groups(controls, [late and index not in apart for index, late in enumerate(later)])
    for name in sorted(set(group.values())):
        members = tuple(index for index in group if group[index] == name)
        outside = _outside(controls, members)
        if len(outside) == 1:
            chains.append(FollowingControls(members, outside.pop()))
        else:  # turned by one and carried by another: only the whole rig shows where they are
            body |= set(members)
    return ControlStages(tuple(sorted(body)), tuple(chains))


def _above(control: Control) -> set[int]:
    return {control.space.turner, control.space.carrier}


def _outside(controls: Sequence[Control], members: Collection[int]) -> set[int]:
    """What turns and carries some controls and is none of them."""
    return {other for index in members for other in _above(controls[index]) if other not in members}


def _groups(controls: Sequence[Control], later: Sequence[bool]) -> dict[int, int]:
    """For each control that follows the first of those that it hangs together with."""
    group: dict[int, int] = {}
    for index, control in enumerate(controls):
        if not later[index]:
            continue
        near = {group[other] for other in _above(control) if other in group}
        group[index] = min(near, default=index)
        for other, name in group.items():
            if name in near:
                group[other] = group[index]
    return dict(sorted(group.items()))


# --- Keys of a character's trunk and of the limbs that hang on it in FK


NO_FRAMES = np.zeros(0, dtype=np.intp)


def reduce_body(
    motion: ControlMotion, times: Array, rules: ToleranceRules, of: ChannelValues, stages: ControlStages
) -> Part[tuple[dict[int, KeyedControl], dict[int, ControlChannels]]]:
    """Find the keys of the body's controls, by index, and the channels with the poses that they show."""
    body = stages.body
    held = {index: motion.points_of(index) for index in body}
    roots = _limb_roots(motion, stages)
    places = {
        index: np.array(
            [place for _, place in held[index]]
            + [motion.scale * motion.limbs[name].root_place for name in roots[index]]
        ).reshape(-1, 3)
        for index in body
    }
    made = control_rig(motion.controls, motion.channels, body, places, motion.scale)
    values = made.values(motion.controls, motion.channels, of)
    target = made.rig.pose(values).points
    allowed = np.full(target.shape[:2], rules.general_m)
    for index in body:
        where = made.rig.point_slices[made.turned[index]]
        columns = iter(range(where.start + 1, where.stop))
        for point, _ in held[index]:
            column = next(columns)
            shown = not motion.shows_ik(point.limb)
            allowed[:, column] = rules.of(point, target[:, column], shown, rules.general_m)
        for name in roots[index]:
            tolerance_m = CARRIED_SHARE * rules.general_m
            allowed[:, next(columns)] = reach_tolerance_m(motion.joints_m(name), tolerance_m)
    reduced = yield from reduce_keys(made.rig, times, values, allowed, NO_FRAMES)
    pose = made.rig.pose([spline.evaluate(times, 0, len(times) - 1) for spline in reduced.splines])
    channels = {index: made.shown(pose, index, motion.channels[index], motion.scale) for index in body}
    return made.keyed(motion.controls, reduced.splines), channels


def _limb_roots(motion: ControlMotion, stages: ControlStages) -> dict[int, list[str]]:
    """By control of the body the limbs that it carries and that are fitted after it."""
    after = {group.leg for group in stages.following}
    roots: dict[int, list[str]] = {index: [] for index in stages.body}
    for name, limb in motion.limbs.items():
        if limb.root_control in roots and (name in after or not limb.in_fk):
            roots[limb.root_control].append(name)
    return roots


def shown_path(path: Array, turn: Array, place: Array) -> Array:
    """(F, 3) a path in the axes of a control, from its head, as it is in the armature's space."""
    return np.asarray(place + (turn @ path[..., None])[..., 0])


# --- Keys of what follows the body that its own few keys show


def reduce_following(
    motion: ControlMotion,
    times: Array,
    rules: ToleranceRules,
    of: ChannelValues,
    group: FollowingControls,
    shown: Mapping[int, ControlChannels],
) -> Part[tuple[dict[int, KeyedControl], dict[int, ControlChannels]]]:
    """Find the keys of controls that hang together, and the channels with the poses that these keys show.

    `shown` has those of the controls fitted before.
    """
    known = {index: shown.get(index, channels) for index, channels in enumerate(motion.channels)}
    carrier = known.get(group.carrier)
    known = {index: channels for index, channels in known.items() if index not in group.controls}
    wanted = dict(motion.wanted) | _wanted(motion, rules, group, shown)
    channels = control_channels(motion.controls, wanted, motion.size, known)
    held = {index: motion.points_of(index) for index in group.controls}
    places = {index: np.array([place for _, place in held[index]]).reshape(-1, 3) for index in held}
    made = control_rig(motion.controls, channels, group.controls, places, motion.scale)
    values = made.values(motion.controls, channels, of)
    target = made.rig.pose(values).points
    allowed = np.full(target.shape[:2], rules.general_m)
    for index in group.controls:
        start = made.rig.point_slices[made.turned[index]].start
        plan = motion.controls[index].plan
        if plan.kind is ControlKind.POLE:
            limb = str(plan.limb)
            distance_m = motion.scale * motion.limbs[limb].pole_distance
            for row in {made.turned[index], made.moved.get(index, made.turned[index])}:
                tolerance = pole_tolerance_m(motion.joints_m(limb), distance_m, rules.general_m)
                allowed[:, made.rig.point_slices[row].start] = tolerance
        for column, (point, _) in enumerate(held[index], start + 1):
            path = target[:, column]
            if carrier is not None:
                path = shown_path(path, carrier.turn, motion.scale * carrier.place)
            allowed[:, column] = _tolerance(motion, rules, group, point, path)
    reduced = yield from reduce_keys(made.rig, times, values, allowed, NO_FRAMES)
    pose = made.rig.pose([spline.evaluate(times, 0, len(times) - 1) for spline in reduced.splines])
    now = {}
    for index in group.controls:
        local = made.shown(pose, index, channels[index], motion.scale)
        now[index] = local if carrier is None else local.on(carrier)
    return made.keyed(motion.controls, reduced.splines), now


def _wanted(
    motion: ControlMotion,
    rules: ToleranceRules,
    group: FollowingControls,
    shown: Mapping[int, ControlChannels],
) -> dict[str, Array]:
    """(F, 4, 4) by control the poses of a group, given what the keys found so far show."""
    if group.leg is not None and group.carrier in shown:
        bones = leg_on_body(motion, group.leg, shown[group.carrier])
        found = {}
        for index in group.controls:
            control = motion.controls[index]
            offset = np.linalg.inv(motion.offsets[control.name])
            found[control.name] = bones.get(control.plan.bone, motion.bones[control.plan.bone]) @ offset
        return found
    return {motion.controls[index].name: _followed(motion, rules, index, shown) for index in group.controls}


def _followed(
    motion: ControlMotion, rules: ToleranceRules, index: int, shown: Mapping[int, ControlChannels]
) -> Array:
    """(F, 4, 4) the pose of a control that brings hand or foot to where the FK keys have it.

    A resting foot is where it rests: the FK keys are a hair off.
    """
    control = motion.controls[index]
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
    motion: ControlMotion, rules: ToleranceRules, group: FollowingControls, point: HeldPoint, path: Array
) -> Array:
    """(F,) tolerance of a point that follows [m]."""
    shows_ik, limb = motion.shows_ik(point.limb), motion.limbs.get(str(point.limb))
    if group.leg is not None:
        allowed = rules.of(point, path, not shows_ik, rules.general_m)
        share = CARRIED_SHARE if point.kind is PointKind.BODY else 1.0
        return np.minimum(allowed, share * rules.general_m)
    ends_m = SWITCH_M if limb is not None and limb.in_fk else rules.general_m
    allowed = rules.of(point, path, True, ends_m)
    if point.limb is not None and shows_ik and point.kind is PointKind.END:
        allowed = np.minimum(allowed, reach_tolerance_m(motion.joints_m(point.limb), rules.general_m))
    return allowed


# --- Few keys on a character's controls, FK and IK together, within a tolerance of the character itself


BODY_SHARE = 0.5  # share of the work that the body's controls are, where others follow


def reduce_controls(
    motion: ControlMotion, times: Array, rules: ToleranceRules, of: ChannelValues
) -> Part[tuple[KeyedControl, ...]]:
    """Find few keys for every control of a motion at rising scene frames (F,), at least two."""
    stages = control_stages(motion.controls, _legs(motion))
    shown: dict[int, ControlChannels] = {}
    keyed: dict[int, KeyedControl] = {}
    done = 0.0
    if stages.body:
        done = BODY_SHARE if stages.following else 1.0
        part = reduce_body(motion, times, rules, of, stages)
        keyed, shown = yield from scaled(part, 0.0, done)
    share = (1.0 - done) / max(len(stages.following), 1)
    for group in stages.following:
        following = reduce_following(motion, times, rules, of, group, shown)
        more, now = yield from scaled(following, done, done + share)
        keyed |= more
        shown |= now
        done += share
    return tuple(keyed[index] for index in range(len(motion.controls)))


def _legs(motion: ControlMotion) -> dict[str, tuple[int, list[int]]]:
    """By leg in FK the control that carries it, and the indices of its own."""
    found = {}
    for leg, limb in motion.limbs.items():
        if not leg.startswith("leg") or not limb.in_fk or limb.root_control == NOTHING:
            continue
        roles = {point.bone for point in motion.points if point.limb == leg}
        members = [index for bone in roles if (index := motion.fk_control(bone)) is not None]
        found[leg] = (limb.root_control, members)
    assert set(found) <= set(LIMBS)
    return found
