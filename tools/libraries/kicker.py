"""Stance of a kick with the left leg, balanced on the right one."""

from .balance import balanced
from .moment import Arm, Foot, Leg, Moment, Turn, moment, swung_arm

GUARD = Arm(elevation=34.0, plane=58.0, rotation=26.0, elbow=120.0, pronation=30.0, girdle=3.0)
LOW_GUARD = Arm(elevation=26.0, plane=40.0, rotation=20.0, elbow=84.0, pronation=20.0)
HANGING = swung_arm(2.0, 9.0, rotation=10.0, elbow=16.0)
LEVEL = Turn()
STAND = Foot(-0.10, -0.08, -18.0)
"""The right foot, which bears; the left one starts behind it."""
BEHIND = Foot(0.12, 0.24, 28.0)


def on_right(
    leg: Leg,
    pelvis: Turn,
    waist: Turn = LEVEL,
    neck: Turn = LEVEL,
    stand: Foot = STAND,
    bend: float = 21.0,
    left_arm: Arm = GUARD,
    right_arm: Arm = GUARD,
    ahead_m: float = 0.0,
) -> Moment:
    """A moment in balance on the right foot."""
    return balanced(
        moment(
            left_leg=leg,
            right_leg=stand,
            left_arm=left_arm,
            right_arm=right_arm,
            bend=bend,
            pelvis=pelvis,
            waist=waist,
            neck=neck,
        ),
        ahead_m=ahead_m,
    )
