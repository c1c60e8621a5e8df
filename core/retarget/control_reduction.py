"""Few keys on a character's controls, FK and IK together, within a tolerance of the character itself."""

from collections.abc import Sequence

import numpy as np

from ..arrays import Array
from ..finish.hermite import Spline
from ..finish.key_reduction import reduce_keys
from ..progress import Part, scaled
from .control_channels import ControlChannels, control_channels
from .control_motion import ChannelValues, ControlMotion, KeyedControl, channel_values, keyed_controls
from .control_plan import ControlKind
from .control_rig import control_rig, rig_bone_channels
from .control_spaces import NOTHING
from .control_stages import FollowingControls, control_stages
from .held_points import HeldPoint, PointKind
from .point_tolerances import SWITCH_M, ToleranceRules, pole_tolerance_m, reach_tolerance_m

BODY_SHARE = 0.75
"""Share of the work that the body's controls are."""
NO_FRAMES = np.zeros(0, dtype=np.intp)


def reduce_controls(
    motion: ControlMotion, times: Array, rules: ToleranceRules, of: ChannelValues
) -> Part[tuple[KeyedControl, ...]]:
    """Find few keys for every control.

    Args:
        motion: The controls' motion.
        times: (F,) rising scene frames, at least two.
        rules: How far points may stray.
        of: Values of rotation channels.

    Yields:
        The fraction done.

    Returns:
        What is keyed on each control.
    """
    body, following = control_stages(motion.controls)
    shown: dict[int, ControlChannels] = {}
    splines: dict[int, Spline] = {}
    channels = dict(enumerate(motion.channels))
    if body:
        part = _reduce_body(motion, times, rules, of, body)
        splines, shown = yield from scaled(part, 0.0, BODY_SHARE if following else 1.0)
    for number, group in enumerate(following):
        first = BODY_SHARE + (1.0 - BODY_SHARE) * number / len(following)
        last = BODY_SHARE + (1.0 - BODY_SHARE) * (number + 1) / len(following)
        part = _reduce_following(motion, times, rules, of, group, shown)
        more, keyed = yield from scaled(part, first, last)
        splines |= more
        channels |= keyed
    every = range(len(motion.controls))
    return keyed_controls(motion.controls, [channels[i] for i in every], [splines[i] for i in every])


def _reduce_body(
    motion: ControlMotion, times: Array, rules: ToleranceRules, of: ChannelValues, body: Sequence[int]
) -> Part[tuple[dict[int, Spline], dict[int, ControlChannels]]]:
    """Keys of the controls of body and limbs in FK, and what they show."""
    held = {index: motion.points_of(index) for index in body}
    roots: dict[int, list[str]] = {index: [] for index in body}
    for name, limb in motion.limbs.items():
        if not limb.in_fk and limb.root_control in roots:
            roots[limb.root_control].append(name)
    places = {
        index: np.array(
            [place for _, place in held[index]]
            + [motion.scale * motion.limbs[name].root_place for name in roots[index]]
        ).reshape(-1, 3)
        for index in body
    }
    rig = control_rig(motion.controls, motion.channels, body, places, motion.scale)
    values = [channel_values(motion.controls[i], motion.channels[i], of) for i in body]
    target = rig.pose(values).points
    allowed = np.full(target.shape[:2], rules.general_m)
    for number, index in enumerate(body):
        columns = iter(range(rig.point_slices[number].start + 1, rig.point_slices[number].stop))
        for point, _ in held[index]:
            column = next(columns)
            hidden = point.limb in motion.limbs
            allowed[:, column] = rules.of(point, target[:, column], not hidden, rules.general_m)
        for name in roots[index]:
            allowed[:, next(columns)] = reach_tolerance_m(_meters(motion, name), rules.general_m)
    reduced = yield from reduce_keys(rig, times, values, allowed, NO_FRAMES)
    pose = rig.pose([spline.evaluate(times, 0, len(times) - 1) for spline in reduced.splines])
    shown = {
        index: rig_bone_channels(rig, pose, number, motion.channels[index], motion.scale)
        for number, index in enumerate(body)
    }
    return dict(zip(body, reduced.splines, strict=True)), shown


def _reduce_following(
    motion: ControlMotion,
    times: Array,
    rules: ToleranceRules,
    of: ChannelValues,
    group: FollowingControls,
    shown: dict[int, ControlChannels],
) -> Part[tuple[dict[int, Spline], dict[int, ControlChannels]]]:
    """Keys of controls of inverse kinematics, and their channels on what the body's keys show."""
    wanted = dict(motion.wanted) | {
        motion.controls[index].name: _followed(motion, rules, index, shown) for index in group.controls
    }
    known = {i: shown.get(i, motion.channels[i]) for i in range(len(motion.controls))}
    known = {index: channels for index, channels in known.items() if index not in group.controls}
    keyed = control_channels(motion.controls, wanted, motion.size, known)
    held = {index: motion.points_of(index) for index in group.controls}
    places = {index: np.array([place for _, place in held[index]]).reshape(-1, 3) for index in held}
    rig = control_rig(motion.controls, keyed, group.controls, places, motion.scale)
    values = [channel_values(motion.controls[i], keyed[i], of) for i in group.controls]
    target = rig.pose(values).points
    allowed = np.full(target.shape[:2], rules.general_m)
    for number, index in enumerate(group.controls):
        start = rig.point_slices[number].start
        plan = motion.controls[index].plan
        if plan.kind is ControlKind.POLE:
            distance_m = motion.scale * motion.limbs[str(plan.limb)].pole_distance
            joints = _meters(motion, str(plan.limb))
            allowed[:, start] = pole_tolerance_m(joints, distance_m, rules.general_m)
        for column, (point, _) in enumerate(held[index], start + 1):
            path = _in_armature(motion, group, shown, target[:, column])
            allowed[:, column] = _followed_tolerance(motion, rules, point, path)
    reduced = yield from reduce_keys(rig, times, values, allowed, NO_FRAMES)
    splines = dict(zip(group.controls, reduced.splines, strict=True))
    return splines, {index: keyed[index] for index in group.controls}


def _followed(
    motion: ControlMotion, rules: ToleranceRules, index: int, shown: dict[int, ControlChannels]
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


def _followed_tolerance(motion: ControlMotion, rules: ToleranceRules, point: HeldPoint, path: Array) -> Array:
    """(F,) tolerance of a point that follows by inverse kinematics [m]."""
    limb = motion.limbs.get(str(point.limb))
    ends_m = SWITCH_M if limb is not None and limb.in_fk else rules.general_m
    allowed = rules.of(point, path, True, ends_m)
    if limb is not None and point.kind is PointKind.END:
        allowed = np.minimum(allowed, reach_tolerance_m(_meters(motion, str(point.limb)), rules.general_m))
    return allowed


def _in_armature(
    motion: ControlMotion, group: FollowingControls, shown: dict[int, ControlChannels], path: Array
) -> Array:
    """(F, 3) places in the armature's axes [m] of a path in those of what carries a group."""
    if group.carrier == NOTHING:
        return path
    carrier = shown.get(group.carrier, motion.channels[group.carrier])
    return np.asarray(motion.scale * carrier.place + (carrier.turn @ path[..., None])[..., 0])


def _meters(motion: ControlMotion, limb: str) -> tuple[Array, Array, Array]:
    root, middle, end = (motion.scale * path for path in motion.limbs[limb].joints)
    return root, middle, end
