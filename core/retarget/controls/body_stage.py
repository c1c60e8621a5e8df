"""Keys of a character's trunk and of the limbs that hang on it in FK."""

import numpy as np

from ...arrays import Array
from ...finish.key_reduction import reduce_keys
from ...progress import Part
from .control_channels import ControlChannels
from .control_motion import ChannelValues, ControlMotion, KeyedControl
from .control_rig import control_rig
from .control_stages import ControlStages
from .point_tolerances import CARRIED_SHARE, ToleranceRules, reach_tolerance_m

NO_FRAMES = np.zeros(0, dtype=np.intp)


def reduce_body(
    motion: ControlMotion, times: Array, rules: ToleranceRules, of: ChannelValues, stages: ControlStages
) -> Part[tuple[dict[int, KeyedControl], dict[int, ControlChannels]]]:
    """Find the keys of the body's controls.

    Args:
        motion: The controls' motion.
        times: (F,) rising scene frames.
        rules: How far points may stray.
        of: Values of rotation channels.
        stages: The controls in the order of their fitting.

    Returns:
        By index what is keyed on each control, and its channels with the poses that the keys show.
    """
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
