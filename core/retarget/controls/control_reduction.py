"""Few keys on a character's controls, FK and IK together, within a tolerance of the character itself."""

from ...arrays import Array
from ...progress import Part, scaled
from ..roles import LIMBS
from .body_stage import reduce_body
from .control_channels import ControlChannels
from .control_motion import ChannelValues, ControlMotion, KeyedControl
from .control_spaces import NOTHING
from .control_stages import control_stages
from .following_stage import reduce_following
from .point_tolerances import ToleranceRules

BODY_SHARE = 0.5
"""Share of the work that the body's controls are, where others follow."""


def reduce_controls(
    motion: ControlMotion, times: Array, rules: ToleranceRules, of: ChannelValues
) -> Part[tuple[KeyedControl, ...]]:
    """Find few keys for every control.

    Args:
        motion: The controls' motion.
        times: (F,) rising scene frames, at least two.
        rules: How far points may stray.
        of: Values of rotation channels.

    Returns:
        What is keyed on each control.
    """
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
