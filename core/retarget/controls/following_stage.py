"""Keys of what follows the body that its own few keys show: legs in FK, controls of inverse kinematics."""

from collections.abc import Mapping

import numpy as np

from ...arrays import Array
from ...finish.key_reduction import reduce_keys
from ...progress import Part
from .body_stage import NO_FRAMES, shown_path
from .control_channels import ControlChannels, control_channels
from .control_motion import ChannelValues, ControlMotion, KeyedControl
from .control_plan import ControlKind
from .control_rig import control_rig
from .control_stages import FollowingControls
from .held_points import HeldPoint, PointKind
from .leg_on_body import leg_on_body
from .point_tolerances import CARRIED_SHARE, SWITCH_M, ToleranceRules, pole_tolerance_m, reach_tolerance_m


def reduce_following(
    motion: ControlMotion,
    times: Array,
    rules: ToleranceRules,
    of: ChannelValues,
    group: FollowingControls,
    shown: Mapping[int, ControlChannels],
) -> Part[tuple[dict[int, KeyedControl], dict[int, ControlChannels]]]:
    """Find the keys of controls that hang together.

    Args:
        motion: The controls' motion.
        times: (F,) rising scene frames.
        rules: How far points may stray.
        of: Values of rotation channels.
        group: The controls.
        shown: Channels of the controls fitted before, with the poses that their keys show.

    Returns:
        By index what is keyed on each control, and its channels with the poses that the keys show.
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
