"""Feet that lie flat while they rest, roll over heel and toes, and never pass the ground.

The skeleton's feet are rigid with the shins. Here each is turned about its ankle: it follows the shin as far
as the ground and the ankle's range let it, so that it comes down on its heel, lies flat, rolls over its tip
as the heel rises, and hangs once it is high. Its heading is the shin's, but that a resting foot stays.
"""

from collections.abc import Sequence
from types import MappingProxyType

import numpy as np

from ..arrays import Array
from ..body.fingers import SURE, Hands
from ..body.kinematics import Body, Extremities, Pose
from ..body.posture import Posture
from ..body.rotations import exponential, hinge, logarithm
from ..body.skeleton import SIDES
from ..numerics.vectors import gaussian, usual_step
from .contacts import Contact, find_contacts, speeds
from .fading import ease
from .ground import Ground
from .soles import Shins, Soles, ground_of

HANGING_RAD = np.radians(20.0)  # plantarflexion of a foot that hangs free, well above the ground
HANGING_M = (0.15, 0.5)  # heights of the sole between which a foot begins to hang
SOLE_OUT_RAD, SOLE_IN_RAD = np.radians(20.0), np.radians(35.0)  # eversion, inversion (AAOS 1965)
LEANING_RAD = np.radians([35.0, 60.0])
FREE_HEADING_RAD = np.radians(25.0)  # a resting foot keeps its heading up to this turn of the shin


def foot_turns(shins: Shins, soles: Soles, ground: Ground, time_s: Array) -> dict[str, Array]:
    """(F, 3, 3) turn of each foot in its shin's frame, by name of segment."""
    # Leans between which the ground lets go of feet whose shins lie on their sides.
    upright = 1.0 - ease(np.abs(shins.roll), *LEANING_RAD)
    # How far each foot rests flat, and how far on its toes, 0 to 1.
    flat, on_toes = np.zeros_like(ground.height_m), np.zeros_like(ground.height_m)
    for rest, tiptoe in zip(ground.rests, ground.on_toes, strict=True):
        since = np.minimum(time_s - time_s[rest.first], time_s[rest.last] - time_s)[rest.frames]
        # Time from the beginning of a rest until the foot lies, and from when it begins to roll off.
        (on_toes if tiptoe else flat)[rest.frames, rest.point] = ease(since, 0.0, 0.1)
    beneath = shins.ankle[..., 2] - soles.clearance_m(shins)
    # A rest's own height is that of its ankle in every frame: what the ankle errs by, the ground has.
    under = np.minimum((1.0 - flat) * ground.height_m + flat * beneath, beneath)
    height = shins.ankle[..., 2] - under
    above = height - soles.flat_m
    speed = speeds(shins.ankle, time_s)
    # Height above a flat foot's at which its sole is no longer held level across.
    near = np.maximum(flat, 1.0 - ease(above, 0.0, 0.1))
    # A positive roll lowers the left foot's outer edge; countering it turns the sole outward.
    out = np.array([1.0, -1.0])
    leveling = -upright * near * out * np.clip(out * shins.roll, -SOLE_IN_RAD, SOLE_OUT_RAD)
    # Least clearance of the toes in the swing of a step (Winter 1992, *Physical Therapy* 72), at ankle speeds
    # that need none of it and all of it.
    lifted = np.maximum(height - 0.013 * ease(speed, 1.0, 2.5), 0.0)
    free = shins.pitch + HANGING_RAD * ease(height - soles.flat_m, *HANGING_M)
    free += on_toes * np.maximum(soles.on_toes(height) - free, 0.0)
    free = np.clip(free, shins.lowest_pitch, shins.highest_pitch)
    pitch = soles.above_ground(free, lifted, np.cos(shins.roll + leveling), shins)
    # A foot that sways or slides is held flat by half at this speed, or at this height.
    still = 1.0 / (1.0 + (speed / 0.2) ** 4) / (1.0 + (above / 0.04) ** 4)
    standing = np.maximum(flat, (1.0 - on_toes) * still)
    pitch += standing * upright * (np.clip(0.0, shins.lowest_pitch, shins.highest_pitch) - pitch)
    turned = upright * _held_heading(shins, ground.rests, time_s)
    steady = _steadied(np.stack([pitch - shins.pitch, leveling, turned], axis=1), time_s)
    flexion, leveling, turned = np.moveaxis(steady, 1, 0)
    level = np.cos(shins.roll + leveling)
    return _by_side(shins, soles.above_ground(shins.pitch + flexion, height, level, shins), leveling, turned)


def feet_on_floor(shins: Shins, soles: Soles) -> dict[str, Array]:
    """Turns as of `foot_turns`, of postures without time: rigid but where a sole would dip below z = 0."""
    height = np.maximum(shins.ankle[..., 2], soles.flat_m)
    nothing = np.zeros_like(height)
    pitch = soles.ahead(shins.pitch, height, np.cos(shins.roll))
    return _by_side(shins, pitch, nothing, nothing)


def _held_heading(shins: Shins, contacts: Sequence[Contact], time_s: Array) -> Array:
    """(F, 2) turns about the vertical that keep resting feet's headings."""
    turned, weight = np.zeros_like(shins.heading), np.zeros_like(shins.heading)
    for contact in contacts:
        foot, heading = contact.point, np.unwrap(shins.heading[:, contact.point])
        middle = 0.5 * (heading[contact.frames].min() + heading[contact.frames].max())
        apart = np.maximum(time_s[contact.first] - time_s, time_s - time_s[contact.last])
        near = 1.0 - ease(apart, 0.0, 0.2)  # time in which a resting foot's heading comes and goes
        turned[:, foot] += near * np.clip(middle - heading, -FREE_HEADING_RAD, FREE_HEADING_RAD)
        weight[:, foot] += near
    # Two rests that follow closely share the time between them.
    return np.asarray(turned / np.maximum(weight, 1.0))


def _by_side(shins: Shins, pitch: Array, leveling: Array, turned: Array) -> dict[str, Array]:
    """(F, 3, 3) turn of each foot in its shin's frame, by pitch and by what roll and heading differ."""
    x, y, z = np.eye(3)
    # The shin's own pitch and roll are undone before the foot's are done: where the shin lies on its side and
    # its pitch means nothing, only the difference counts.
    undone = hinge(x, -shins.pitch) @ hinge(y, -shins.roll) @ hinge(z, turned)
    turns = undone @ hinge(y, shins.roll + leveling) @ hinge(x, pitch)
    return {f"foot.{side}": turns[:, number] for number, side in enumerate(SIDES)}


def _steadied(angles: Array, time_s: Array) -> Array:
    """Angles (F, ...) [rad] no faster than a joint, smoothed a little.

    They are the mean of the lowest such curve above them and the highest below.
    """
    if len(time_s) < 2:
        return angles
    # Angular speed of an ankle in a sprinter's push-off.
    steps = np.radians(700.0) * np.diff(time_s)
    above, below = angles.copy(), angles.copy()
    for frame, step in enumerate(steps):
        above[frame + 1] = np.maximum(above[frame + 1], above[frame] - step)
        below[frame + 1] = np.minimum(below[frame + 1], below[frame] + step)
    for frame in range(len(steps) - 1, -1, -1):
        above[frame] = np.maximum(above[frame], above[frame + 1] - steps[frame])
        below[frame] = np.minimum(below[frame], below[frame + 1] + steps[frame])
    return gaussian(0.5 * (above + below), 0.03 / usual_step(time_s), truncate=3.0)


# --- Hands that hang relaxed


CURL_RAD = np.radians(10.0)  # a relaxed hand's, half-closed fingers included, which one bone stands for
DROOP_RAD = np.radians(8.0)  # what its weight bends a hand by when the forearm is level
BACK_RAD, TO_PALM_RAD = np.radians(70.0), np.radians(80.0)  # of a wrist (AAOS 1965, *Joint Motion*)
THICKNESS_M = 0.012  # height of the fingers' middle above the ground that they lie on
DOWN = np.array([0.0, 0.0, -1.0])


def hand_turns(body: Body, pose: Pose, ground_m: Array, time_s: Array) -> dict[str, Array]:
    """(F, 3, 3) turn of each hand in its forearm's frame over ground at heights (F,), by name of segment."""
    turns = {}
    for side in SIDES:
        name = f"hand.{side}"
        hand = next(segment for segment in body.skeleton.segments if segment.name == name)
        along = body.local(hand.end) - body.local(hand.start)
        length = float(np.linalg.norm(along))
        to_palm, aside = np.cross(along / length, DOWN), DOWN
        frame = pose.rotation[:, hand.joint]
        down = np.swapaxes(frame, -1, -2) @ DOWN
        droop = DROOP_RAD * np.cross(along / length, down)
        bend = CURL_RAD + droop @ to_palm
        wrist = pose.place(hand.joint, body.local(hand.start))[:, 2]
        over = (wrist - ground_m - THICKNESS_M) / length
        ahead, palm = -down @ (along / length), -down @ DOWN
        bend = _steadied(_above_ground(bend, over, ahead, palm), time_s)
        bend = _above_ground(bend, over, ahead, palm)
        turns[name] = exponential(bend[:, None] * to_palm) @ exponential((droop @ aside)[:, None] * aside)
    return turns


def _above_ground(bend: Array, over: Array, ahead: Array, palm: Array) -> Array:
    """The bends (F,) [rad] that keep fingertips above the ground, as far as the wrists let them.

    Of F frames: `bend` are the relaxed ones, `over` is the wrist's height above the ground in lengths of the
    hand, `ahead` and `palm` are the upward components of the forearm's direction and of the palm's.
    """
    # A tip rises by ahead cos(bend) + palm sin(bend), least where the hand is as steep as its hinge lets it.
    steepness = np.hypot(ahead, palm)
    steepest = np.arctan2(-palm, -ahead)
    closeness = np.clip(over / np.maximum(steepness, 1e-6), -1.0, 1.0)
    apart = np.arccos(closeness)
    back = np.minimum(bend, steepest - apart)
    forth = np.maximum(bend, steepest + apart)
    passing = np.abs(np.remainder(bend - steepest + np.pi, 2.0 * np.pi) - np.pi) < apart
    # The hand bends back where what is straight down lies beyond this bend, or else toward the palm.
    kept = np.where(steepest > np.radians(-15.0), back, forth)
    return np.clip(np.where(passing, kept, bend), -BACK_RAD, TO_PALM_RAD)


# --- Natural hands and feet for a motion, whose postures leave them rigid with forearms and shins


def natural_extremities(
    body: Body,
    posture: Posture,
    time_s: Array,
    contacts: Sequence[Contact] | None = None,
    hands: Hands | None = None,
) -> Extremities:
    """Hands that are seen or hang relaxed, feet that lie flat, roll and never pass the ground, in F postures.

    `contacts` are rests of the ankles, 0 the left and 1 the right; they are found where not given.
    """
    pose = body.pose(posture)
    shins = Shins.of(body, pose)
    rests = find_contacts(shins.ankle, time_s) if contacts is None else contacts
    ground = ground_of(body, pose, time_s, rests)
    feet = foot_turns(shins, Soles.of(body), ground, time_s)
    turns = hand_turns(body, pose, ground.lowest_m, time_s)
    if hands is not None:
        for row, (name, hanging) in enumerate(turns.items()):
            apart = logarithm(np.swapaxes(hanging, -1, -2) @ exponential(hands.bend[:, row]))
            share = np.minimum(hands.sure[:, row, None] / SURE, 1.0)
            turns[name] = hanging @ exponential(share * apart)
    return Extremities(MappingProxyType({**feet, **turns}))
