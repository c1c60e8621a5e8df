"""Moments moved over the floor, and feet that pivot."""

from dataclasses import replace

import numpy as np

from .moment import AnyArm, AnyLeg, Arm, Foot, Leg, Moment
from .solving import BALL, BODY


def moved(moment: Moment, x: float = 0.0, y: float = 0.0) -> Moment:
    """The moment moved over the floor, with its hands and feet."""

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
    """The foot turned on its ball, which stays in place [degrees]."""
    ahead = BODY.actor.segments_m["foot.L"] * -BALL[1]
    before, after = np.radians(foot.turn), np.radians(turn)
    return replace(
        foot,
        x=foot.x + ahead * float(np.sin(before) - np.sin(after)),
        y=foot.y - ahead * float(np.cos(before) - np.cos(after)),
        turn=turn,
        pitch=pitch,
    )
