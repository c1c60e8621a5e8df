"""Bouncing on both feet, hopping on one, and a leap from one foot to the other after a run-up."""

from dataclasses import replace

import numpy as np

from .balance import balanced, flight, mass_of, thrown
from .composing import Composer
from .moment import Arm, Foot, Leg, Moment, Turn, moment, swung_arm

HOP_S, SMALL_S, LEAP_S = 0.22, 0.20, 0.40
"""Times of flight."""
LEAP_M = 1.55
"""Flight distance of the mass."""


def bounce(made: Composer) -> None:
    """Small jumps on the balls of both feet, as over a rope."""
    arms = Arm(elevation=26.0, plane=30.0, rotation=14.0, elbow=58.0)

    def down(bend: float, pitch: float) -> Moment:
        legs = Foot(0.07, 0.0, 8.0, pitch)
        return balanced(
            moment(legs=legs, arms=arms, bend=bend, pelvis=Turn(5.0), waist=Turn(3.0)), ahead_m=0.04
        )

    low, off = down(34.0, 14.0), down(9.0, 44.0)
    mass = mass_of(off)
    air = moment(arms=replace(arms, elevation=31.0), legs=Leg(6.0, 0.0, 5.0, 12.0, 48.0), waist=Turn(3.0))
    made.pose("bounce: lowest", low)
    made.pose("bounce: toes leave the floor", off)
    made.pose("bounce: highest", thrown(air, flight(mass, mass, SMALL_S, 0.5)))
    made.motion(
        "bounce on the spot",
        [
            ("bounce: lowest", 0.0),
            ("bounce: toes leave the floor", 0.13),
            ("bounce: highest", 0.13 + 0.5 * SMALL_S),
            ("bounce: toes leave the floor", 0.13 + SMALL_S),
        ],
        0.26 + SMALL_S,
        cyclic=True,
    )


def hop(made: Composer) -> None:
    """Hops on the left leg, a little forward each time."""
    ahead_m = 0.42

    def down(bend: float, pitch: float, ahead: float, free: Leg, swing: float) -> Moment:
        return balanced(
            moment(
                left_leg=Foot(0.0, 0.0, 6.0, pitch),
                right_leg=free,
                left_arm=swung_arm(swing, 30.0, elbow=52.0),
                right_arm=swung_arm(0.6 * swing, 34.0, elbow=48.0),
                bend=bend,
                pelvis=Turn(9.0, -3.0),
                waist=Turn(5.0, 4.0),
                neck=Turn(-8.0),
            ),
            ahead_m=ahead,
        )

    low = down(44.0, 6.0, 0.02, Leg(22.0, 4.0, 0.0, 82.0, 20.0), -16.0)
    off = down(12.0, 52.0, 0.15, Leg(44.0, 4.0, 0.0, 84.0, 20.0), 24.0)
    on = down(24.0, 12.0, -0.10, Leg(24.0, 4.0, 0.0, 70.0, 20.0), 10.0)
    start = mass_of(off)
    end = mass_of(on) - np.array([0.0, ahead_m, 0.0])
    air = moment(
        left_leg=Leg(16.0, 0.0, 6.0, 34.0, 30.0),
        right_leg=Leg(40.0, 4.0, 0.0, 82.0, 20.0),
        arms=swung_arm(26.0, 36.0, elbow=50.0),
        pelvis=Turn(6.0),
        waist=Turn(4.0),
    )
    made.pose("hop: lowest", low)
    made.pose("hop: toes leave the floor", off)
    made.pose("hop: highest", thrown(air, flight(start, end, HOP_S, 0.5)))
    landed = replace(on, y=on.y - ahead_m, legs={**on.legs, "L": Foot(0.0, -ahead_m, 6.0, 12.0)})
    made.pose("hop: foot lands", landed)
    made.motion(
        "hop on the left leg",
        [
            ("hop: lowest", 0.0),
            ("hop: toes leave the floor", 0.18),
            ("hop: highest", 0.18 + 0.5 * HOP_S),
            ("hop: foot lands", 0.18 + HOP_S),
        ],
        0.30 + HOP_S,
        cyclic=True,
        travel=(0.0, -ahead_m, 0.0),
    )


def leap(made: Composer) -> None:
    """A leap off the left foot onto the right one, from a run-up."""
    plant = balanced(
        moment(
            left_leg=Foot(0.02, 0.0, 5.0, -10.0),
            right_leg=Leg(-12.0, 0.0, 0.0, 62.0, 30.0),
            left_arm=swung_arm(-34.0, 16.0, elbow=52.0),
            right_arm=swung_arm(20.0, 16.0, elbow=70.0),
            bend=24.0,
            pelvis=Turn(2.0, 0.0, -6.0),
            waist=Turn(2.0, 0.0, 12.0),
        ),
        ahead_m=-0.34,
    )
    off = balanced(
        moment(
            left_leg=Foot(0.02, 0.0, 5.0, 62.0),
            right_leg=Leg(78.0, 0.0, 0.0, 92.0, 10.0),
            left_arm=swung_arm(62.0, 20.0, elbow=62.0),
            right_arm=swung_arm(-30.0, 24.0, elbow=50.0),
            bend=12.0,
            pelvis=Turn(6.0, 0.0, 6.0),
            waist=Turn(2.0, 0.0, -12.0),
        ),
        ahead_m=0.44,
    )
    land_y = float(mass_of(off)[1]) - LEAP_M - 0.28
    on = balanced(
        moment(
            left_leg=Leg(-6.0, 0.0, 0.0, 60.0, 30.0),
            right_leg=Foot(-0.03, land_y, -5.0, -8.0),
            left_arm=swung_arm(40.0, 30.0, elbow=50.0),
            right_arm=swung_arm(-22.0, 32.0, elbow=44.0),
            bend=26.0,
            pelvis=Turn(10.0, 0.0, 4.0),
            waist=Turn(6.0, 0.0, -8.0),
        ),
        ahead_m=-0.26,
    )
    start, end = mass_of(off), mass_of(on)
    high = moment(
        left_leg=Leg(-26.0, 0.0, 0.0, 42.0, 40.0),
        right_leg=Leg(72.0, 0.0, 0.0, 58.0, 10.0),
        left_arm=swung_arm(66.0, 34.0, elbow=44.0),
        right_arm=swung_arm(-30.0, 48.0, elbow=36.0),
        pelvis=Turn(8.0, 0.0, 6.0),
        waist=Turn(4.0, 0.0, -10.0),
    )
    names = ("left foot plants", "toes leave the floor", "highest", "right foot lands")
    moments = (plant, off, thrown(high, flight(start, end, LEAP_S, 0.5)), on)
    times = (0.0, 0.22, 0.22 + 0.5 * LEAP_S, 0.22 + LEAP_S)
    steps = []
    for name, at, time_s in zip(names, moments, times, strict=True):
        steps.append((made.pose(f"leap: {name}", at), time_s))
    made.motion("leap", steps)
