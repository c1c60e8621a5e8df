"""Jumps: straight up, far, ahead, astride, small ones on both feet and on one, and a leap from a run-up."""

from dataclasses import replace

from keymark.core.prior.library import Library

from .. import hops
from ..balance import balanced, flight, mass_of, thrown
from ..composing import Composer
from ..moment import Arm, Foot, Leg, Moment, Turn, moment, swung_arm

SOURCES = (
    "Bobbert, M. F. & van Ingen Schenau, G. J. (1988). Coordination in vertical jumping. Journal of"
    " Biomechanics 21.",
    "Lees, A., Vanrenterghem, J. & De Clercq, D. (2004). Understanding how an arm swing enhances"
    " performance in the vertical jump. Journal of Biomechanics 37.",
    "Wakai, M. & Linthorne, N. P. (2005). Optimum take-off angle in the standing long jump. Human"
    " Movement Science 24, 81-96.",
    "Hay, J. G. (1993). The Biomechanics of Sports Techniques, 4th ed.",
    "Winter, D. A. (2009). Biomechanics and Motor Control of Human Movement, 4th ed.",
)
APART_M = 0.11
"""Half the distance between the feet before a jump."""
HIGH_S, FAR_S, ASTRIDE_S, SMALL_S, FORWARD_S = 0.50, 0.46, 0.48, 0.30, 0.38
"""Times of flight: half a second is a jump of 31 cm."""
FAR_M, AHEAD_M = 1.25, 0.55
"""Flight distance of the mass in the long jump and in a casual one."""

HANGING = swung_arm(2.0, 9.0, rotation=10.0, elbow=15.0)
BACK = swung_arm(-48.0, 12.0, rotation=0.0, elbow=14.0)
FORWARD = swung_arm(84.0, 14.0, rotation=14.0, elbow=30.0, girdle=6.0)
UP = Arm(elevation=158.0, plane=72.0, rotation=22.0, elbow=16.0, girdle=22.0)
OPEN = Arm(elevation=78.0, plane=48.0, rotation=20.0, elbow=32.0, girdle=8.0)


def library() -> Library:
    """Compose the library."""
    made = Composer(
        "jumping",
        "Jumping",
        "Jumps up, tucked, astride and far, with swinging arms; a small jump and one forward with little"
        " swing; bouncing on the spot, hopping, a leap.",
        SOURCES,
        ("jumping",),
    )
    _up(made)
    _tuck(made)
    _far(made)
    _small(made)
    _forward(made)
    _astride(made)
    hops.bounce(made)
    hops.hop(made)
    hops.leap(made)
    return made.library()


def feet(pitch: float = 0.0, y: float = 0.0) -> Foot:
    """Both feet side by side, as the left one's place."""
    return Foot(APART_M, y, 8.0, pitch)


def crouched(
    bend: float, pelvis: float, waist: float, arms: Arm, pitch: float = 0.0, y: float = 0.0
) -> Moment:
    """A crouch on both feet; angles of bending forward [degrees]."""
    return balanced(
        moment(
            legs=feet(pitch, y),
            arms=arms,
            bend=bend,
            pelvis=Turn(pelvis),
            waist=Turn(waist),
            neck=Turn(-0.45 * (pelvis + waist)),
        ),
        ahead_m=0.03 if bend > 30.0 else 0.0,
    )


def on_toes(arms: Arm, y: float = 0.0, **others: float) -> Moment:
    """The last moment on the floor: all but stretched, on the balls of the feet."""
    lean = others.get("lean_m", 0.05)
    return balanced(
        moment(
            legs=feet(56.0, y), arms=arms, bend=12.0, pelvis=Turn(others.get("bow", 4.0)), waist=Turn(2.0)
        ),
        ahead_m=lean + 0.05,
    )


def leaving_upward() -> Moment:
    """The last moment on the floor of a jump straight up."""
    return on_toes(replace(UP, elevation=136.0, girdle=16.0))


def landing() -> Moment:
    """The first moment on the floor again."""
    return crouched(28.0, 12.0, 10.0, OPEN, pitch=32.0)


def _up(made: Composer) -> None:
    off, on = leaving_upward(), landing()
    start, end = mass_of(off), mass_of(on)
    top = moment(
        arms=replace(UP, elevation=146.0),
        legs=Leg(8.0, 5.0, 4.0, 18.0, 45.0),
        waist=Turn(2.0),
        neck=Turn(-4.0),
    )
    made.pose("standing", balanced(moment(legs=feet(), arms=HANGING, bend=7.0)))
    made.pose("sinking", crouched(52.0, 22.0, 12.0, swung_arm(-30.0, 12.0, rotation=0.0, elbow=14.0)))
    made.pose("crouched, arms back", crouched(98.0, 42.0, 16.0, BACK))
    made.pose("pushing off, arms pass", crouched(82.0, 34.0, 14.0, swung_arm(24.0, 12.0, elbow=26.0)))
    made.pose("stretching, arms forward", crouched(44.0, 14.0, 8.0, FORWARD, pitch=12.0))
    made.pose("toes leave the floor", off)
    made.pose("highest, arms up", thrown(top, flight(start, end, HIGH_S, 0.5)))
    made.pose("toes touch the floor", on)
    made.pose("caught, knees deep", crouched(78.0, 32.0, 18.0, swung_arm(30.0, 26.0, elbow=42.0)))
    made.pose("straightening", crouched(36.0, 12.0, 8.0, swung_arm(12.0, 16.0, elbow=24.0)))
    off_s = 1.02
    on_s = off_s + HIGH_S
    made.motion(
        "jump up",
        [
            ("standing", 0.0),
            ("sinking", 0.36),
            ("crouched, arms back", 0.66),
            ("pushing off, arms pass", 0.81),
            ("stretching, arms forward", 0.93),
            ("toes leave the floor", off_s),
            ("highest, arms up", off_s + 0.5 * HIGH_S),
            ("toes touch the floor", on_s),
            ("caught, knees deep", on_s + 0.20),
            ("straightening", on_s + 0.55),
            ("standing", on_s + 0.95),
        ],
    )


def _tuck(made: Composer) -> None:
    """Knees to the chest, with the jump up's beginning and end."""
    tucked = moment(
        arms=swung_arm(58.0, 26.0, rotation=30.0, elbow=62.0),
        legs=Leg(104.0, 8.0, 4.0, 112.0, 15.0),
        pelvis=Turn(6.0),
        waist=Turn(24.0),
        neck=Turn(-10.0),
    )
    start, end = mass_of(leaving_upward()), mass_of(landing())
    made.pose("tuck: knees high", thrown(tucked, flight(start, end, HIGH_S, 0.5)))
    off_s = 1.02
    made.motion(
        "tuck jump",
        [
            ("standing", 0.0),
            ("sinking", 0.36),
            ("crouched, arms back", 0.66),
            ("pushing off, arms pass", 0.81),
            ("stretching, arms forward", 0.93),
            ("toes leave the floor", off_s),
            ("tuck: knees high", off_s + 0.5 * HIGH_S),
            ("toes touch the floor", off_s + HIGH_S),
            ("caught, knees deep", off_s + HIGH_S + 0.20),
            ("straightening", off_s + HIGH_S + 0.55),
            ("standing", off_s + HIGH_S + 0.95),
        ],
    )


def _far(made: Composer) -> None:
    """A standing long jump; it begins with the jump up's standing and crouching."""
    pushing = balanced(
        moment(
            legs=feet(28.0), arms=FORWARD, bend=52.0, pelvis=Turn(30.0), waist=Turn(8.0), neck=Turn(-22.0)
        ),
        ahead_m=0.24,
    )
    off = balanced(
        moment(
            legs=feet(60.0),
            arms=replace(UP, elevation=138.0),
            bend=14.0,
            pelvis=Turn(22.0),
            waist=Turn(2.0),
            neck=Turn(-12.0),
        ),
        ahead_m=0.50,
    )
    land_y = -FAR_M - 0.50 - 0.28
    on = balanced(
        moment(
            legs=feet(-14.0, land_y),
            arms=swung_arm(58.0, 14.0, elbow=20.0),
            bend=62.0,
            pelvis=Turn(22.0),
            waist=Turn(26.0),
            neck=Turn(-20.0),
        ),
        ahead_m=-0.30,
    )
    start, end = mass_of(off), mass_of(on)
    hang = moment(
        arms=replace(UP, elevation=128.0),
        legs=Leg(18.0, 5.0, 4.0, 62.0, 30.0),
        pelvis=Turn(8.0),
        neck=Turn(-8.0),
    )
    tuck = moment(
        arms=swung_arm(86.0, 14.0, elbow=14.0),
        legs=Leg(84.0, 5.0, 4.0, 64.0, -6.0),
        pelvis=Turn(6.0),
        waist=Turn(24.0),
        neck=Turn(-14.0),
    )
    made.pose("far: pushing forward", pushing)
    made.pose("far: toes leave the floor", off)
    made.pose("far: highest, arms up", thrown(hang, flight(start, end, FAR_S, 0.38)))
    made.pose("far: legs reach forward", thrown(tuck, flight(start, end, FAR_S, 0.8)))
    made.pose("far: heels land", on)
    flat = balanced(
        moment(
            legs=feet(0.0, land_y),
            arms=swung_arm(48.0, 15.0, elbow=20.0),
            bend=88.0,
            pelvis=Turn(36.0),
            waist=Turn(26.0),
            neck=Turn(-24.0),
        ),
        ahead_m=-0.12,
    )
    made.pose("far: feet flat", flat)
    made.pose("far: caught, deep", crouched(106.0, 46.0, 24.0, swung_arm(40.0, 16.0, elbow=20.0), y=land_y))
    made.pose("far: rising", crouched(58.0, 26.0, 12.0, swung_arm(16.0, 14.0, elbow=18.0), y=land_y))
    made.pose("far: standing", balanced(moment(legs=feet(y=land_y), arms=HANGING, bend=7.0)))
    off_s = 1.06
    on_s = off_s + FAR_S
    made.motion(
        "jump far",
        [
            ("standing", 0.0),
            ("sinking", 0.34),
            ("crouched, arms back", 0.64),
            ("pushing off, arms pass", 0.80),
            ("far: pushing forward", 0.93),
            ("far: toes leave the floor", off_s),
            ("far: highest, arms up", off_s + 0.38 * FAR_S),
            ("far: legs reach forward", off_s + 0.8 * FAR_S),
            ("far: heels land", on_s),
            ("far: feet flat", on_s + 0.10),
            ("far: caught, deep", on_s + 0.26),
            ("far: rising", on_s + 0.68),
            ("far: standing", on_s + 1.1),
        ],
    )


def _small(made: Composer) -> None:
    """Up a hand's breadth with arms that swing no higher than the waist; it ends as the jump up does."""
    off = on_toes(swung_arm(26.0, 16.0, elbow=34.0))
    start, end = mass_of(off), mass_of(landing())
    top = moment(
        arms=swung_arm(32.0, 24.0, elbow=42.0),
        legs=Leg(9.0, 4.0, 4.0, 18.0, 40.0),
        pelvis=Turn(2.0),
        waist=Turn(3.0),
    )
    made.pose("small: toes leave the floor", off)
    made.pose("small: highest", thrown(top, flight(start, end, SMALL_S, 0.5)))
    off_s = 0.62
    on_s = off_s + SMALL_S
    made.motion(
        "small jump",
        [
            ("standing", 0.0),
            ("sinking", 0.40),
            ("small: toes leave the floor", off_s),
            ("small: highest", off_s + 0.5 * SMALL_S),
            ("toes touch the floor", on_s),
            ("straightening", on_s + 0.22),
            ("standing", on_s + 0.60),
        ],
    )


def _forward(made: Composer) -> None:
    """A casual jump ahead, arms to the height of the chest, landing on flat feet."""
    off = balanced(
        moment(
            legs=feet(54.0),
            arms=swung_arm(62.0, 14.0, elbow=30.0),
            bend=14.0,
            pelvis=Turn(15.0),
            waist=Turn(4.0),
            neck=Turn(-8.0),
        ),
        ahead_m=0.32,
    )
    land_y = -AHEAD_M - 0.32 - 0.14
    on = balanced(
        moment(
            legs=feet(-4.0, land_y),
            arms=swung_arm(42.0, 18.0, elbow=32.0),
            bend=36.0,
            pelvis=Turn(16.0),
            waist=Turn(14.0),
            neck=Turn(-10.0),
        ),
        ahead_m=-0.15,
    )
    start, end = mass_of(off), mass_of(on)
    high = moment(
        arms=swung_arm(64.0, 18.0, elbow=30.0),
        legs=Leg(46.0, 5.0, 4.0, 66.0, 15.0),
        pelvis=Turn(10.0),
        waist=Turn(10.0),
        neck=Turn(-8.0),
    )
    caught = crouched(60.0, 25.0, 16.0, swung_arm(24.0, 18.0, elbow=28.0), y=land_y)
    made.pose("forward: toes leave the floor", off)
    made.pose("forward: highest", thrown(high, flight(start, end, FORWARD_S, 0.5)))
    made.pose("forward: feet land", on)
    made.pose("forward: caught", caught)
    made.pose("forward: standing", balanced(moment(legs=feet(y=land_y), arms=HANGING, bend=7.0)))
    off_s = 0.82
    on_s = off_s + FORWARD_S
    made.motion(
        "jump forward",
        [
            ("standing", 0.0),
            ("sinking", 0.48),
            ("pushing off, arms pass", 0.66),
            ("forward: toes leave the floor", off_s),
            ("forward: highest", off_s + 0.5 * FORWARD_S),
            ("forward: feet land", on_s),
            ("forward: caught", on_s + 0.18),
            ("forward: standing", on_s + 0.75),
        ],
    )


def _astride(made: Composer) -> None:
    """A star in the air, with the jump up's beginning and end."""
    off = on_toes(Arm(elevation=62.0, plane=15.0, rotation=10.0, elbow=18.0, girdle=6.0))
    on = landing()
    start, end = mass_of(off), mass_of(on)
    wide = Arm(elevation=128.0, plane=6.0, rotation=6.0, elbow=8.0, girdle=20.0)
    star = moment(arms=wide, legs=Leg(4.0, 38.0, 8.0, 8.0, 40.0), neck=Turn(-6.0))
    made.pose("star: toes leave the floor", off)
    made.pose("star: wide open", thrown(star, flight(start, end, ASTRIDE_S, 0.52)))
    on_s = 0.94 + ASTRIDE_S
    made.motion(
        "star jump",
        [
            ("standing", 0.0),
            ("sinking", 0.36),
            ("pushing off, arms pass", 0.74),
            ("star: toes leave the floor", 0.94),
            ("star: wide open", 0.94 + 0.52 * ASTRIDE_S),
            ("toes touch the floor", on_s),
            ("caught, knees deep", on_s + 0.18),
            ("straightening", on_s + 0.50),
            ("standing", on_s + 0.90),
        ],
    )
