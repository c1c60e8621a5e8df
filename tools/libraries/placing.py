"""Where a moment stands: with its centre of mass over the feet that carry it, or somewhere else on the floor."""

from dataclasses import replace

import numpy as np

from .inspection import centre_of_mass
from .moment import AnyArm, AnyLeg, Arm, Foot, Leg, Moment
from .solving import BALL, BODY, posture_of

AT_EASE_M = -0.045
"""How far before their ankles people's centre of mass is who stand at ease: Winter (2009)."""
ROUNDS = 8
CLOSE_ENOUGH_M = 1e-4


def balanced(moment: Moment, x: float | None = 0.0, y: float | None = AT_EASE_M) -> Moment:
    """The moment with its hips where they bring the centre of mass over a place on the floor.

    Args:
        moment: Hands and feet with a place keep it.
        x: The place to the left [m]; where None, the hips stay as they are in this direction.
        y: The place to the back [m], likewise.
    """
    for _ in range(ROUNDS):
        centre = centre_of_mass(BODY, BODY.pose(posture_of(moment)))
        off_x = 0.0 if x is None else x - float(centre[0])
        off_y = 0.0 if y is None else y - float(centre[1])
        moment = replace(moment, x=moment.x + off_x, y=moment.y + off_y)
        if np.hypot(off_x, off_y) < CLOSE_ENOUGH_M:
            break
    return moment


def moved(moment: Moment, x: float = 0.0, y: float = 0.0) -> Moment:
    """The moment elsewhere on the floor, with its hands and feet."""

    def along(limb: AnyArm | AnyLeg) -> AnyArm | AnyLeg:
        return limb if isinstance(limb, Arm | Leg) else replace(limb, x=limb.x + x, y=limb.y + y)

    return replace(
        moment,
        x=moment.x + x,
        y=moment.y + y,
        arms={side: along(arm) for side, arm in moment.arms.items()},
        legs={side: along(leg) for side, leg in moment.legs.items()},
    )


def pivoted(foot: Foot, turn: float, pitch: float) -> Foot:
    """The foot turned on its ball, which stays where it is [degrees]."""
    ahead = BODY.actor.segments_m["foot.L"] * -BALL[1]
    before, after = np.radians(foot.turn), np.radians(turn)
    return replace(
        foot,
        x=foot.x + ahead * float(np.sin(before) - np.sin(after)),
        y=foot.y - ahead * float(np.cos(before) - np.cos(after)),
        turn=turn,
        pitch=pitch,
    )
