"""Walking at three speeds and with quiet arms, starting and stopping, and on the spot."""

from keymark.core.prior.library import Library

from ..balance import balanced
from ..composing import Composer
from ..gait import LEADS, STANCE, Footfall, Style, Walk, steady
from ..moment import Foot, Leg, Moment, Turn, mirrored, moment, swung_arm

PHASES = (
    ("left heel strike", 0.0),
    ("right toe off", 0.11),
    ("right leg swings", 0.21),
    ("feet pass, left stands", 0.31),
    ("left heel off", 0.41),
    ("right heel strike", 0.5),
    ("left toe off", 0.61),
    ("left leg swings", 0.71),
    ("feet pass, right stands", 0.81),
    ("right heel off", 0.91),
)
FEWER_PHASES = (
    ("left heel strike", 0.0),
    ("right toe off", 0.12),
    ("feet pass, left stands", 0.26),
    ("left heel off", 0.39),
    ("right heel strike", 0.5),
    ("left toe off", 0.62),
    ("feet pass, right stands", 0.76),
    ("right heel off", 0.89),
)
SOURCES = (
    "Perry, J. & Burnfield, J. M. (2010). Gait Analysis: Normal and Pathological Function, 2nd ed.",
    "Winter, D. A. (2009). Biomechanics and Motor Control of Human Movement, 4th ed.",
    "Kadaba, M. P., Ramakrishnan, H. K. & Wootten, M. E. (1990). Measurement of lower extremity"
    " kinematics during level walking. Journal of Orthopaedic Research 8.",
    "Murray, M. P., Drought, A. B. & Kory, R. C. (1964). Walking patterns of normal men. Journal of Bone"
    " and Joint Surgery 46-A.",
    "Murray, M. P., Sepic, S. B. & Barnard, E. J. (1967). Patterns of sagittal rotation of the upper"
    " limbs in walking. Physical Therapy 47.",
)
USUAL = Style()
WALK = (1.42, 1.08, USUAL)
GAITS = {
    "walk": (*WALK, PHASES),
    "slow walk": (1.06, 1.28, Style(arms=0.4, elbow=12.0), FEWER_PHASES),
    "brisk walk": (1.72, 0.94, Style(elbow=22.0, bow=3.0), FEWER_PHASES),
}
"""Stride [m], duration of a stride [s], style, and the phases that have a posture, by gait."""
FIRST_STEP_M = 0.5
"""Distance between the ankles after the first step from standing; the next is a usual step."""


def library() -> Library:
    """Compose the library."""
    made = Composer(
        "walking",
        "Walking",
        "Walking ahead: slowly with quiet arms, as usual, and briskly; setting out and coming to rest;"
        " walking on the spot.",
        SOURCES,
        ("walking", "gait"),
    )
    for name, (stride_m, stride_s, style, phases) in GAITS.items():
        walk = steady(stride_m, stride_s, style)

        def at(phase: float, walk: Walk = walk, stride_s: float = stride_s) -> Moment:
            return walk.at(phase * stride_s)

        made.cycle(name, at, phases, stride_s, (0.0, -stride_m, 0.0))
    _set_out(made)
    _come_to_rest(made)
    _on_the_spot(made)
    return made.library()


def _set_out(made: Composer) -> None:
    """From standing to the walk's right heel strike, at whose position it ends."""
    stride_m, stride_s, style = WALK
    strikes = {"L": 0.0, "R": 0.5 * stride_s, "L again": stride_s}
    ahead = {name: (strike / stride_s + LEADS) * stride_m for name, strike in strikes.items()}
    stand_m = ahead["L"] - FIRST_STEP_M
    aside, toes, stands_s = style.apart_m, style.toes_out, STANCE * stride_s
    falls = [
        Footfall("L", -3.0, -0.42, aside, -stand_m, toes, push=0.4),
        Footfall("R", -3.0, 0.11 * stride_s, -aside, -stand_m, -toes),
        Footfall("L", 0.0, stands_s, aside, -ahead["L"], toes, heel=0.6),
        Footfall("R", strikes["R"], strikes["R"] + stands_s, -aside, -ahead["R"], -toes),
        Footfall("L", stride_s, stride_s + stands_s, aside, -ahead["L again"], toes),
    ]
    walk = Walk(falls, 0.5 * stride_s, style)
    moments = {
        "set out: standing": -1.2,
        "set out: left leg swings": -0.26,
        "set out: left foot lands": 0.0,
        "set out: right leg swings": 0.28,
    }
    steps = [(made.pose(name, walk.at(time_s)), time_s + 1.2) for name, time_s in moments.items()]
    made.motion("set out", [*steps, ("walk: right heel strike", strikes["R"] + 1.2)])


def _come_to_rest(made: Composer) -> None:
    """From the walk's left heel strike, at whose position it begins, to standing."""
    stride_m, stride_s, style = WALK
    aside, toes = style.apart_m, style.toes_out
    left_m = LEADS * stride_m
    stand_m = left_m + FIRST_STEP_M
    right_s, left_s = 0.56 * stride_s, 1.12 * stride_s
    falls = [
        Footfall("R", -0.5 * stride_s, 0.11 * stride_s, -aside, 0.5 * stride_m - left_m, -toes),
        Footfall("L", 0.0, right_s + 0.16 * stride_s, aside, -left_m, toes),
        Footfall("R", right_s, 4.0, -aside, -stand_m, -toes, heel=0.6, push=0.0),
        Footfall("L", left_s, 4.0, aside, -stand_m, toes, heel=0.1, push=0.0),
    ]
    walk = Walk(falls, 0.5 * stride_s, style)
    moments = {
        "come to rest: right leg swings": 0.26,
        "come to rest: right foot lands": right_s,
        "come to rest: left leg follows": 0.5 * (right_s + left_s) + 0.1,
        "come to rest: feet together": left_s + 0.05,
        "come to rest: standing": left_s + 0.7,
    }
    steps = [(made.pose(name, walk.at(time_s)), time_s) for name, time_s in moments.items()]
    made.motion("come to rest", [("walk: left heel strike", 0.0), *steps])


def _on_the_spot(made: Composer) -> None:
    """Knees half as high as in marching, arms that swing a little."""
    foot, calm = Foot(0.08, 0.0, 6.0), {"elbow": 24.0, "rotation": 10.0}
    left_up = balanced(
        moment(
            left_leg=Leg(40.0, 0.0, 4.0, 66.0, 15.0),
            right_leg=Foot(-foot.x, 0.0, -foot.turn),
            left_arm=swung_arm(-14.0, 7.0, **calm),
            right_arm=swung_arm(16.0, 7.0, **calm),
            bend=7.0,
            pelvis=Turn(1.0, 1.0, -3.0),
            waist=Turn(2.0, -1.0, 5.0),
        )
    )
    both = moment(legs=foot, arms=swung_arm(1.0, 7.0, **calm), bend=12.0, pelvis=Turn(2.0), waist=Turn(2.0))
    names = [
        made.pose("on the spot: left knee up", left_up),
        made.pose("on the spot: changing", balanced(both)),
        made.pose("on the spot: right knee up", mirrored(left_up)),
    ]
    steps = [(names[0], 0.0), (names[1], 0.27), (names[2], 0.54), (names[1], 0.81)]
    made.motion("walk on the spot", steps, 1.08, cyclic=True)
