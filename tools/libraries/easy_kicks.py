"""Kicks of people who do no martial arts: from standing with low arms, and of a ball after a few steps."""

from collections.abc import Sequence

from .balance import balanced
from .composing import Composer
from .kicker import HANGING, on_right
from .moment import Foot, Leg, Moment, Turn, moment, swung_arm

STAND = Foot(-0.09, 0.0, -8.0)
"""The right foot; in the library's "standing" the left one is beside it."""
RUN_UP_S = 0.94
"""Time from standing until the last stride before the ball."""


def front(made: Composer) -> None:
    """A front kick to the height of the hips, not much faster than a step."""
    arms = {"left_arm": swung_arm(-16.0, 18.0, elbow=28.0), "right_arm": swung_arm(18.0, 22.0, elbow=34.0)}
    up = on_right(
        Leg(64.0, 4.0, 4.0, 88.0, 15.0), Turn(-4.0, -3.0), Turn(6.0, 3.0), stand=STAND, bend=14.0, **arms
    )
    out = on_right(
        Leg(72.0, 6.0, 4.0, 16.0, 15.0),
        Turn(-12.0, -4.0, -8.0),
        Turn(4.0, 3.0, 6.0),
        Turn(6.0),
        stand=STAND,
        bend=13.0,
        left_arm=swung_arm(-26.0, 22.0, elbow=26.0),
        right_arm=swung_arm(26.0, 26.0, elbow=38.0),
    )
    down = on_right(
        Leg(28.0, 4.0, 4.0, 44.0, 10.0), Turn(0.0, -3.0), Turn(4.0, 3.0), stand=STAND, bend=14.0, **arms
    )
    steps = [
        ("standing", 0.0),
        (made.pose("easy front: knee comes up", up), 0.36),
        (made.pose("easy front: leg stretched", out), 0.56),
        (made.pose("easy front: leg goes down", down), 0.84),
        ("standing", 1.15),
    ]
    made.motion("easy front kick", steps)


def side(made: Composer) -> None:
    """A side kick to the height of the thigh, the trunk leaning away and the arms a little out."""
    arms = {"left_arm": swung_arm(4.0, 22.0, elbow=30.0), "right_arm": swung_arm(6.0, 30.0, elbow=34.0)}
    up = on_right(
        Leg(46.0, 16.0, 4.0, 78.0, 5.0), Turn(0.0, -6.0), Turn(4.0, 5.0), stand=STAND, bend=14.0, **arms
    )
    out = on_right(
        Leg(16.0, 46.0, 0.0, 12.0, 0.0),
        Turn(2.0, -22.0, -6.0),
        Turn(2.0, 4.0, 4.0),
        Turn(0.0, 10.0, 10.0),
        stand=STAND,
        bend=13.0,
        left_arm=swung_arm(2.0, 34.0, elbow=26.0),
        right_arm=swung_arm(10.0, 36.0, elbow=42.0),
    )
    steps = [
        ("standing", 0.0),
        (made.pose("easy side: knee comes up", up), 0.36),
        (made.pose("easy side: leg stretched", out), 0.60),
        ("easy side: knee comes up", 0.86),
        ("standing", 1.22),
    ]
    made.motion("easy side kick", steps)


def run_up(made: Composer, name: str, kick: Sequence[tuple[str, float]]) -> None:
    """From standing a short left step, then the stride and the kick of a ball, which begins at its time 0."""
    right, before = Foot(-0.10, 1.62, -5.0), 1.66
    stands = balanced(moment(left_leg=Foot(0.09, before, 6.0), right_leg=right, arms=HANGING, bend=7.0))
    strides: Moment = balanced(
        moment(
            left_leg=Leg(26.0, 2.0, 4.0, 36.0, 0.0),
            right_leg=Foot(right.x, right.y, right.turn, 14.0),
            left_arm=swung_arm(-14.0, 14.0, elbow=24.0),
            right_arm=swung_arm(14.0, 14.0, elbow=30.0),
            bend=14.0,
            pelvis=Turn(5.0, -2.0),
            waist=Turn(3.0),
        ),
        ahead_m=0.14,
    )
    lands = balanced(
        moment(
            left_leg=Foot(0.10, 0.86, 8.0, -10.0),
            right_leg=Foot(right.x, right.y, right.turn, 38.0),
            left_arm=swung_arm(-24.0, 18.0, elbow=26.0),
            right_arm=swung_arm(22.0, 18.0, elbow=38.0),
            bend=12.0,
            pelvis=Turn(6.0, 0.0, -5.0),
            waist=Turn(3.0, 0.0, 9.0),
        ),
        left=0.42,
    )
    steps = [
        (made.pose("run-up: standing", stands), 0.0),
        (made.pose("run-up: left leg strides", strides), 0.42),
        (made.pose("run-up: left foot lands", lands), 0.62),
    ]
    made.motion(name, [*steps, *((posture, time_s + RUN_UP_S) for posture, time_s in kick)])
