"""Feet that lie flat while they rest, roll over heel and toes, and never pass the ground.

The skeleton's feet are rigid with the shins. Here each is turned about its ankle: it follows the shin as far
as the ground and the ankle's range let it, so that it comes down on its heel, lies flat, rolls over its tip
as the heel rises, and hangs once it is high. Its heading is the shin's, but that a resting foot stays.
"""

from collections.abc import Sequence

import numpy as np

from ..arrays import Array
from ..body.rotations import hinge
from ..body.skeleton import SIDES
from .contacts import Contact
from .foot_ground import FootGround, smooth_step
from .foot_pitch import Shins, Soles
from .joint_speed import steadied

HANGING_RAD = np.radians(20.0)
"""Plantarflexion of a foot that hangs free, well above the ground; near it the toes are kept up."""
HANGING_FROM_M, HANGING_AT_M = 0.15, 0.5
"""Heights of the sole above the ground between which a foot begins to hang."""
SWING_CLEARANCE_M = 0.013
"""Least clearance of the toes in the swing of a step (Winter 1992, *Physical Therapy* 72)."""
STANDS_M_S, SWINGS_M_S = 1.0, 2.5
"""Speeds of the ankle below which no clearance is kept, and above which all of it."""
STILL_M_S, LOW_M = 0.2, 0.04
"""Speed, and height above a flat foot's, at which a foot that does not rest, because it sways or slides, is
held flat by half."""
SOLE_OUT_RAD, SOLE_IN_RAD = np.radians(20.0), np.radians(35.0)
"""Eversion and inversion (AAOS 1965, *Joint Motion*)."""
LEVEL_WITHIN_M = 0.1
"""Height above a flat foot's at which its sole is no longer held level across."""
LEANING_RAD, LYING_RAD = np.radians(35.0), np.radians(60.0)
"""Leans of a shin to its side from which on, and at which, the ground no longer turns its foot."""
FREE_HEADING_RAD = np.radians(25.0)
"""A resting foot keeps its heading while the shin above it turns by no more than this."""
FADE_S = 0.2
"""Time in which a resting foot's heading comes and goes."""


def foot_turns(
    shins: Shins, soles: Soles, ground: FootGround, time_s: Array, contacts: Sequence[Contact]
) -> dict[str, Array]:
    """(F, 3, 3) turn of each foot in its shin's frame, by name of segment.

    Args:
        shins: The shins in F frames.
        soles: The soles under them.
        ground: The ground under them.
        time_s: (F,) time of each frame [s].
        contacts: Rests of the ankles, 0 the left and 1 the right.
    """
    upright = _upright(shins)
    height = shins.ankle[..., 2] - ground.height_m
    above = height - soles.flat_m
    speed = _speed(shins.ankle, time_s)
    near = np.maximum(ground.resting, 1.0 - smooth_step(above / LEVEL_WITHIN_M))
    leveling = -upright * near * _within_range(shins.roll)
    swing = smooth_step((speed - STANDS_M_S) / (SWINGS_M_S - STANDS_M_S))
    lifted = np.maximum(height - SWING_CLEARANCE_M * swing, 0.0)
    pitch = soles.above_ground(
        _free_pitch(shins, soles, ground, height), lifted, np.cos(shins.roll + leveling), shins
    )
    standing = np.maximum(ground.resting, (1.0 - ground.on_toes) * _still(speed, above))
    pitch += standing * upright * (np.clip(0.0, shins.lowest_pitch, shins.highest_pitch) - pitch)
    turned = upright * _held_heading(shins, contacts, time_s)
    steady = steadied(np.stack([pitch - shins.pitch, leveling, turned], axis=1), time_s)
    flexion, leveling, turned = np.moveaxis(steady, 1, 0)
    level = np.cos(shins.roll + leveling)
    return _by_side(shins, soles.above_ground(shins.pitch + flexion, height, level, shins), leveling, turned)


def feet_on_floor(shins: Shins, soles: Soles, floor_m: float) -> dict[str, Array]:
    """Turns as of `foot_turns`, of postures without time: rigid but where a sole would dip into the floor."""
    height = np.maximum(shins.ankle[..., 2] - floor_m, soles.flat_m)
    nothing = np.zeros_like(height)
    pitch = soles.ahead(shins.pitch, height, np.cos(shins.roll))
    return _by_side(shins, pitch, nothing, nothing)


def _upright(shins: Shins) -> Array:
    """(F, 2) 1 for shins that stand, 0 for those that lie on their sides."""
    return 1.0 - smooth_step((np.abs(shins.roll) - LEANING_RAD) / (LYING_RAD - LEANING_RAD))


def _free_pitch(shins: Shins, soles: Soles, ground: FootGround, height: Array) -> Array:
    """(F, 2) pitch of feet that no ground is in the way of, within the ankle's range."""
    above = (height - soles.flat_m - HANGING_FROM_M) / (HANGING_AT_M - HANGING_FROM_M)
    pitch = shins.pitch + HANGING_RAD * smooth_step(above)
    pitch += ground.on_toes * np.maximum(soles.on_toes(height) - pitch, 0.0)
    return np.clip(pitch, shins.lowest_pitch, shins.highest_pitch)


def _speed(places: Array, time_s: Array) -> Array:
    """(F, 2) speed of both ankles [m/s]."""
    if len(time_s) < 2:
        return np.zeros(places.shape[:2])
    return np.asarray(np.linalg.norm(np.gradient(places, time_s, axis=0), axis=-1))


def _still(speed: Array, above: Array) -> Array:
    """(F, 2) how far feet stand by their speed and their height above flat feet's, 0 to 1."""
    return np.asarray(1.0 / (1.0 + (speed / STILL_M_S) ** 4) / (1.0 + (above / LOW_M) ** 4))


def _within_range(roll: Array) -> Array:
    """(F, 2) the rolls of shins as far as the ankles can counter them."""
    # A positive roll lowers the left foot's outer edge; countering it turns the sole outward.
    out = np.array([1.0, -1.0])
    return np.asarray(out * np.clip(out * roll, -SOLE_IN_RAD, SOLE_OUT_RAD))


def _held_heading(shins: Shins, contacts: Sequence[Contact], time_s: Array) -> Array:
    """(F, 2) turns about the vertical that keep resting feet's headings."""
    turned, weight = np.zeros_like(shins.heading), np.zeros_like(shins.heading)
    for contact in contacts:
        foot, rows = contact.point, slice(contact.first, contact.last + 1)
        heading = np.unwrap(shins.heading[:, foot])
        middle = 0.5 * (heading[rows].min() + heading[rows].max())
        apart = np.maximum(time_s[contact.first] - time_s, time_s - time_s[contact.last])
        near = 1.0 - smooth_step(apart / FADE_S)
        turned[:, foot] += near * np.clip(middle - heading, -FREE_HEADING_RAD, FREE_HEADING_RAD)
        weight[:, foot] += near
    # Two rests that follow closely share the time between them.
    return np.asarray(turned / np.maximum(weight, 1.0))


def _by_side(shins: Shins, pitch: Array, leveling: Array, turned: Array) -> dict[str, Array]:
    """(F, 3, 3) turn of each foot in its shin's frame.

    Args:
        shins: The shins.
        pitch: (F, 2) the feet's pitches.
        leveling: (F, 2) by how much their rolls differ from the shins'.
        turned: (F, 2) by how much their headings do.
    """
    x, y, z = np.eye(3)
    # The shin's own pitch and roll are undone before the foot's are done: where the shin lies on its side and
    # its pitch means nothing, only the difference counts.
    undone = hinge(x, -shins.pitch) @ hinge(y, -shins.roll) @ hinge(z, turned)
    turns = undone @ hinge(y, shins.roll + leveling) @ hinge(x, pitch)
    return {f"foot.{side}": turns[:, number] for number, side in enumerate(SIDES)}
