"""Turning to the left: on the spot, about, along a bend, about while walking, and around on one foot."""

from dataclasses import replace

import numpy as np
from keymark.core.body.rotations import hinge
from keymark.core.prior.library import Library

from ..balance import balanced
from ..composing import Composer
from ..gait import LEADS, STANCE, Footfall, Style, Walk
from ..moment import Arm, Foot, Leg, Moment, Turn, moment
from ..placing import pivoted

SOURCES = (
    "Hase, K. & Stein, R. B. (1999). Turning strategies during human walking. Journal of Neurophysiology 81.",
    "Hollands, M. A., Ziavra, N. V. & Bronstein, A. M. (2004). A new paradigm to investigate the roles of"
    " head and eye movements in the coordination of whole-body movements. Experimental Brain Research 154.",
    "Patla, A. E., Adkin, A. & Ballard, T. (1999). Online steering: coordination and control of body"
    " center of mass, head and body reorientation. Experimental Brain Research 129, 629-634.",
    "Laws, K. (2002). Physics and the Art of Dance.",
    "Perry, J. & Burnfield, J. M. (2010). Gait Analysis: Normal and Pathological Function, 2nd ed.",
)
PHASES = (
    ("left foot lands", 0.0),
    ("right foot lifts", 0.12),
    ("right foot passes", 0.27),
    ("right foot reaches", 0.40),
    ("right foot lands", 0.5),
    ("left foot lifts", 0.62),
    ("left foot passes", 0.77),
    ("left foot reaches", 0.90),
)
SMALL_STEPS = (
    ("left foot lands", 0.0),
    ("right foot lifts", 0.13),
    ("right foot passes", 0.30),
    ("right foot lands", 0.5),
    ("left foot lifts", 0.63),
    ("left foot passes", 0.80),
)
ON_THE_SPOT = Style(arms=0.5, elbow=18.0, bow=3.0, toes_out=6.0, apart_m=0.085)
SPOT_S, SPOT_DEG = 1.16, 90.0
"""Duration and turn of a cycle of two steps on the spot."""
BEND = Style(lean=2.5)
BEND_S, BEND_M, BEND_DEG = 1.10, 1.20, 50.0


def library() -> Library:
    """Compose the library."""
    made = Composer(
        "turning",
        "Turning",
        "Turning to the left: on the spot, about, along a bend, about while walking, and on one foot.",
        SOURCES,
        ("turning",),
    )
    _on_the_spot(made)
    _about(made)
    _along_a_bend(made)
    _about_while_walking(made)
    _on_one_foot(made)
    return made.library()


def leading(moment: Moment, chest: float, head: float) -> Moment:
    """Chest and head turned ahead of the hips [degrees]: people look where they turn to."""
    return replace(
        moment,
        waist=replace(moment.waist, turn=moment.waist.turn + chest),
        neck=replace(moment.neck, turn=moment.neck.turn + head),
    )


def planted(
    side: str,
    strike_s: float,
    lift_s: float,
    heading: float,
    style: Style,
    place: tuple[float, float] = (0.0, 0.0),
    heel: float = 0.1,
    push: float = 0.45,
) -> Footfall:
    """A foot beside the hips' position, for a body that faces `heading` there [degrees]."""
    sign = 1.0 if side == "L" else -1.0
    facing, aside = np.radians(heading), sign * style.apart_m
    return Footfall(
        side,
        strike_s,
        lift_s,
        place[0] + aside * float(np.cos(facing)),
        place[1] + aside * float(np.sin(facing)),
        heading + sign * style.toes_out,
        heel,
        push,
    )


def _on_the_spot(made: Composer) -> None:
    falls = []
    for step in range(-4, 5):
        strike = 0.5 * step * SPOT_S
        heading = (0.5 * step + LEADS) * SPOT_DEG
        side = "L" if step % 2 == 0 else "R"
        falls.append(planted(side, strike, strike + STANCE * SPOT_S, heading, ON_THE_SPOT))
    walk = Walk(falls, 0.5 * SPOT_S, ON_THE_SPOT)
    made.cycle(
        "turn on the spot",
        lambda phase: leading(walk.at(phase * SPOT_S), 9.0, 16.0),
        SMALL_STEPS,
        SPOT_S,
        (0.0, 0.0, float(np.radians(SPOT_DEG))),
    )


def _about(made: Composer) -> None:
    """Half a turn from standing to standing, in four steps."""
    style = ON_THE_SPOT
    falls = [
        planted("L", -3.0, 0.22, 0.0, style),
        planted("R", -3.0, 0.68, 0.0, style),
        planted("L", 0.54, 1.16, 62.0, style),
        planted("R", 1.00, 1.62, 118.0, style),
        planted("L", 1.46, 5.0, 180.0, style, push=0.0),
        planted("R", 1.90, 5.0, 180.0, style, push=0.0),
    ]
    walk = Walk(falls, 0.46, style)
    ahead = {
        "standing": (-0.3, 0.0),
        "left foot turns out": (0.40, 1.0),
        "left foot lands": (0.58, 1.0),
        "turned by half": (1.06, 0.9),
        "left foot turns on": (1.30, 0.8),
        "right foot closes": (1.70, 0.2),
        "standing again": (1.94, 0.0),
    }
    steps = [
        (made.pose(f"about: {name}", leading(walk.at(time_s), 10.0 * much, 26.0 * much)), time_s + 0.3)
        for name, (time_s, much) in ahead.items()
    ]
    first, last = steps[0][0], steps[-1][0]
    made.motion("turn about", [steps[0], (first, 0.46), *steps[1:], (last, 2.6)])


def _along_a_bend(made: Composer) -> None:
    """Walking around a point on the left."""
    radius = BEND_M / np.radians(BEND_DEG)
    falls = []
    for step in range(-4, 5):
        strike = 0.5 * step * BEND_S
        heading = (0.5 * step + LEADS) * BEND_DEG
        angle = np.radians(heading)
        place = (float(radius * (1.0 - np.cos(angle))), float(-radius * np.sin(angle)))
        side = "L" if step % 2 == 0 else "R"
        falls.append(planted(side, strike, strike + STANCE * BEND_S, heading, BEND, place, 0.9, 0.9))
    walk = Walk(falls, 0.5 * BEND_S, BEND)

    turn = hinge(np.array([0.0, 0.0, 1.0]), np.asarray(np.radians(BEND_DEG)))
    pivot = np.array([radius, 0.0, 0.0])
    way = pivot - turn @ pivot
    made.cycle(
        "walk along a bend",
        lambda phase: leading(walk.at(phase * BEND_S), 5.0, 12.0),
        PHASES,
        BEND_S,
        (float(way[0]), float(way[1]), float(np.radians(BEND_DEG))),
    )


def _about_while_walking(made: Composer) -> None:
    """Two steps forward, about to the left over both feet, and back."""
    style = Style(arms=0.8)
    falls = [
        planted("R", -0.54, 0.12, 0.0, style, (0.0, 0.35), 1.0, 0.9),
        planted("L", 0.0, 0.74, 0.0, style, (0.0, -0.30), 0.9, 0.6),
        planted("R", 0.54, 1.24, 58.0, style, (-0.02, -0.72), 0.5, 0.6),
        planted("L", 1.00, 1.72, 135.0, style, (0.06, -0.60), 0.2, 0.7),
        planted("R", 1.48, 2.22, 178.0, style, (0.03, -0.14), 0.7, 0.9),
        planted("L", 2.02, 2.70, 180.0, style, (0.02, 0.55), 1.0, 0.9),
    ]
    walk = Walk(falls, 0.52, style)
    ahead = {
        "right foot lifts": (0.10, 0.0),
        "right leg swings": (0.25, 0.2),
        "right leg passes": (0.40, 0.5),
        "right foot lands": (0.55, 0.8),
        "weight on the right": (0.70, 1.0),
        "left foot turns out": (0.86, 1.0),
        "left foot lands": (1.02, 1.0),
        "weight on the left": (1.18, 0.9),
        "right foot comes": (1.33, 0.7),
        "right foot leads back": (1.50, 0.3),
        "left foot lifts": (1.68, 0.1),
        "left leg passes": (1.86, 0.0),
        "walks back": (2.04, 0.0),
    }
    steps = [
        (made.pose(f"walk about: {name}", leading(walk.at(time_s), 12.0 * much, 28.0 * much)), time_s - 0.10)
        for name, (time_s, much) in ahead.items()
    ]
    made.motion("turn about while walking", steps)


def _on_one_foot(made: Composer) -> None:
    """Once around on the ball of the left foot, arms thrown open and drawn in, from standing as above."""
    stand = Foot(ON_THE_SPOT.apart_m, 0.0, ON_THE_SPOT.toes_out)
    other = replace(stand, x=-stand.x, turn=-stand.turn)
    wound = Arm(elevation=62.0, plane=96.0, rotation=50.0, elbow=64.0, girdle=4.0)
    wide = Arm(elevation=76.0, plane=12.0, rotation=10.0, elbow=22.0, girdle=6.0)
    close = Arm(elevation=54.0, plane=64.0, rotation=52.0, elbow=100.0, pronation=40.0, girdle=4.0)

    def on_left(heading: float, free: Leg, arms: Arm, head: float, pitch: float = 22.0) -> Moment:
        return balanced(
            moment(
                left_leg=pivoted(stand, heading + stand.turn, pitch),
                right_leg=free,
                arms=arms,
                bend=12.0,
                pelvis=Turn(2.0, 0.0, heading),
                neck=Turn(0.0, 0.0, head),
            )
        )

    drawn = Leg(40.0, 16.0, 22.0, 84.0, 20.0)
    wind = balanced(
        moment(
            left_leg=stand,
            right_leg=pivoted(other, -20.0, 20.0),
            left_arm=wide,
            right_arm=wound,
            bend=34.0,
            pelvis=Turn(6.0, 0.0, -18.0),
            waist=Turn(4.0, 0.0, -24.0),
            neck=Turn(0.0, 0.0, 36.0),
        ),
        left=0.6,
    )
    end = balanced(
        moment(
            left_leg=pivoted(stand, 360.0 + stand.turn, 0.0),
            right_leg=replace(other, turn=360.0 + other.turn),
            arms=wide,
            bend=28.0,
            pelvis=Turn(5.0, 0.0, 362.0),
            waist=Turn(4.0, 0.0, -6.0),
        )
    )
    moments = {
        "wound up": (wind, 0.50),
        "pushed off": (on_left(40.0, Leg(26.0, 30.0, 16.0, 52.0, 20.0), wide, 36.0, 14.0), 0.78),
        "a third around": (on_left(125.0, drawn, close, -20.0), 1.00),
        "two thirds around": (on_left(235.0, drawn, close, 46.0), 1.22),
        "opening": (on_left(320.0, Leg(30.0, 24.0, 18.0, 62.0, 20.0), wide, 26.0, 16.0), 1.43),
        "caught": (end, 1.72),
    }
    steps = [(made.pose(f"around: {name}", at), time_s) for name, (at, time_s) in moments.items()]
    made.motion("around on one foot", [("about: standing", 0.0), *steps, ("about: standing", 2.3)])
