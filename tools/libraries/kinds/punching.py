"""Boxing from a guard that the left hand leads, and straight punches from a wide stance.

Mirrored, the right hand leads.
"""

from dataclasses import replace

from keymark.core.library.library import Library

from ..balance import balanced_over
from ..composing import Composer
from ..moment import AnyArm, Arm, Foot, Hand, Moment, Turn, mirrored, moment
from ..placing import pivoted

SOURCES = (
    "Stanley, E. et al. (2018). An analysis of the three-dimensional kinetics and kinematics of maximal"
    " effort punches among amateur boxers. International Journal of Performance Analysis in Sport 18.",
    "Piorkowski, B. A., Lees, A. & Barton, G. J. (2011). Single maximal versus combination punch"
    " kinematics. Sports Biomechanics 10.",
    "Dinu, D. & Louis, J. (2020). Biomechanical analysis of the cross, hook, and uppercut in junior vs. elite"
    " boxers. Frontiers in Sports and Active Living 2.",
    "Winter, D. A. (2009). Biomechanics and Motor Control of Human Movement, 4th ed.",
)
LEAD, REAR = Foot(0.11, -0.20, -14.0), Foot(-0.13, 0.24, -52.0, 16.0)
ASIDE = -34.0
"""How far the hips of a boxer are turned from the opponent, who is straight ahead."""
LEAD_GUARD = Arm(36, 62, 26, 114, 20, 4)
REAR_GUARD = Arm(28, 56, 28, 132, 15, 4)
Path = tuple[tuple[str, float], ...]


def library() -> Library:
    """Compose it."""
    work = Composer(
        "punching",
        "Punching",
        "Jab, cross, hooks and uppercuts from a boxer's guard, slips, ducking, blocking and footwork;"
        " straight punches from a wide stance.",
        SOURCES,
        ("sport", "fight"),
    )
    standing = moment(legs=Foot(0.11, 0.0, 9.0), bend=8, pelvis=Turn(bow=1), waist=Turn(bow=2))
    work.pose("standing", balanced_over(standing), "standing")
    work.pose("guard", _boxing(), "guard")
    _straight_punches(work)
    _bent_punches(work)
    _defence(work)
    _footwork(work)
    _from_a_wide_stance(work)
    return work.library()


def _boxing(
    left: AnyArm = LEAD_GUARD,
    right: AnyArm = REAR_GUARD,
    *,
    turn: float = 0.0,
    chest: float = 0.0,
    bow: float = 0.0,
    lean: float = 0.0,
    bend: float = 24.0,
    forward: float = 0.0,
    aside: float = 0.0,
    feet: tuple[Foot, Foot] = (LEAD, REAR),
) -> Moment:
    """A boxer.

    Args:
        left: The lead arm.
        right: The rear arm.
        turn: Of the hips from those of the guard, to the left [degrees].
        chest: Of the chest on the hips, likewise.
        bow: Of the trunk beyond the guard's, forward.
        lean: Of the trunk, to the left.
        bend: Least flexion of the knees.
        forward: How far the weight is before the middle of the feet [m].
        aside: How far it is to the left [m].
        feet: The lead foot and the rear one.
    """
    weight = 0.5 * (feet[0].y + feet[1].y) - 0.05 - forward
    return balanced_over(
        moment(
            y=weight,
            left_leg=feet[0],
            right_leg=feet[1],
            left_arm=left,
            right_arm=right,
            bend=bend,
            pelvis=Turn(bow=4.0 + 0.3 * bow, lean=0.3 * lean, turn=ASIDE + turn),
            waist=Turn(bow=12.0 + 0.7 * bow, lean=0.7 * lean, turn=chest),
            neck=Turn(bow=6.0 - 0.3 * bow, turn=0.85 * (-ASIDE - turn - chest)),
        ),
        aside,
        weight,
    )


def _fist(
    x: float, ahead: float, height: float, swivel: float, pronation: float, girdle: float = 10.0
) -> Hand:
    """A wrist at a place or as near as it gets."""
    return Hand(x, -ahead, height, swivel, pronation, girdle, short=0.3)


def _from_guard(work: Composer, name: str, path: Path) -> None:
    """A motion from the guard and back to it; times are from its beginning [s]."""
    work.motion(name, [("guard", 0.0), *path])


def _rear_pivot(turn: float, pitch: float) -> tuple[Foot, Foot]:
    return LEAD, pivoted(REAR, REAR.turn + turn, pitch)


def _lead_pivot(turn: float, pitch: float) -> tuple[Foot, Foot]:
    return pivoted(LEAD, LEAD.turn + turn, pitch), REAR


def _straight_punches(work: Composer) -> None:
    """Jab with the lead hand, cross with the rear, a jab to the body; a third of a second to the target."""
    for name, posed in (
        ("jab: halfway", _boxing(_fist(0.05, 0.58, 1.42, 24, 50, 8), turn=-4, chest=-8, forward=0.02)),
        ("jab", _boxing(_fist(0.02, 1.0, 1.43, 42, 75, 14), turn=-8, chest=-20, bow=2, forward=0.06)),
        (
            "cross: halfway",
            _boxing(
                right=_fist(-0.06, 0.44, 1.40, 30, 40, 6),
                turn=16,
                chest=8,
                forward=0.03,
                feet=_rear_pivot(18, 26),
            ),
        ),
        (
            "cross",
            _boxing(
                right=_fist(-0.02, 1.0, 1.42, 42, 75, 12),
                turn=32,
                chest=22,
                bow=6,
                forward=0.09,
                feet=_rear_pivot(42, 42),
            ),
        ),
        (
            "jab to the body",
            _boxing(_fist(0.02, 1.0, 1.06, 42, 75, 10), turn=-8, chest=-16, bow=20, bend=52, forward=0.08),
        ),
    ):
        work.pose(name, posed, "straight")
    _from_guard(work, "jab", (("jab: halfway", 0.14), ("jab", 0.26), ("jab: halfway", 0.42), ("guard", 0.62)))
    _from_guard(work, "jab to the body", (("jab to the body", 0.34), ("guard", 0.80)))
    _from_guard(
        work, "cross", (("cross: halfway", 0.17), ("cross", 0.32), ("cross: halfway", 0.52), ("guard", 0.78))
    )
    _from_guard(
        work,
        "jab and cross",
        (
            ("jab: halfway", 0.14),
            ("jab", 0.26),
            ("jab: halfway", 0.38),
            ("cross: halfway", 0.50),
            ("cross", 0.64),
            ("cross: halfway", 0.84),
            ("guard", 1.10),
        ),
    )


def _bent_punches(work: Composer) -> None:
    """Hooks swing level around the body, uppercuts rise from below the chest; both with the elbow bent."""
    hooking, swinging = Arm(92, 52, 36, 86, 40, 10), Arm(72, 12, 14, 88, 30, 8)
    loaded, rising = Arm(14, 18, 6, 104, -20), Arm(58, 84, 8, 98, -60, 8)
    for name, posed in (
        ("lead hook: swinging", _boxing(swinging, turn=6, chest=12, lean=4)),
        ("lead hook", _boxing(hooking, turn=-26, chest=-24, feet=_lead_pivot(-42, 24))),
        ("rear hook: swinging", _boxing(right=swinging, turn=0, chest=-8, feet=_rear_pivot(10, 24))),
        (
            "rear hook",
            _boxing(right=hooking, turn=46, chest=34, bow=4, forward=0.06, feet=_rear_pivot(46, 44)),
        ),
        (
            "rear uppercut: loaded",
            _boxing(right=loaded, turn=-10, chest=-14, bow=10, lean=-14, bend=46, aside=-0.03),
        ),
        (
            "rear uppercut",
            _boxing(
                right=rising,
                turn=34,
                chest=18,
                bow=-6,
                lean=4,
                bend=14,
                forward=0.04,
                feet=_rear_pivot(40, 40),
            ),
        ),
        ("lead uppercut: loaded", _boxing(loaded, turn=12, chest=14, bow=10, lean=14, bend=44, aside=0.03)),
        (
            "lead uppercut",
            _boxing(rising, turn=-16, chest=-14, bow=-6, lean=-4, bend=14, feet=_lead_pivot(-20, 14)),
        ),
    ):
        work.pose(name, posed, "hook" if "hook" in name else "uppercut")
    for name, first in (
        ("lead hook", "lead hook: swinging"),
        ("rear hook", "rear hook: swinging"),
        ("rear uppercut", "rear uppercut: loaded"),
        ("lead uppercut", "lead uppercut: loaded"),
    ):
        _from_guard(work, name, ((first, 0.26), (name, 0.44), ("guard", 0.86)))


def _defence(work: Composer) -> None:
    """The head leaves the line of a punch to either side or below, or goes behind the arms."""
    high = Arm(56, 72, 24, 142, 30, 10)
    for name, posed in (
        ("slip to the left", _boxing(turn=8, chest=10, bow=14, lean=24, bend=40, aside=0.05)),
        ("slip to the right", _boxing(turn=-10, chest=-10, bow=14, lean=-24, bend=42, aside=-0.05)),
        ("block", _boxing(high, high, bow=12, bend=30)),
    ):
        work.pose(name, posed, "defence")
        _from_guard(work, name, ((name, 0.32), ("guard", 0.72)))
    work.pose("duck: half", _boxing(bow=13, bend=50, forward=0.01), "defence")
    work.pose("duck", _boxing(bow=26, bend=76, forward=0.02), "defence")
    _from_guard(work, "duck", (("duck: half", 0.18), ("duck", 0.36), ("duck: half", 0.56), ("guard", 0.76)))


def _footwork(work: Composer) -> None:
    """Bouncing in the guard, and steps to the front: the lead foot first, the rear follows."""
    step = 0.22
    heels = (replace(LEAD, pitch=12.0), replace(REAR, pitch=24.0))
    work.pose("bounce: low", _boxing(bend=34, bow=3), "footwork")
    work.pose("bounce: high", _boxing(bend=14, feet=heels), "footwork")
    work.motion("bouncing", [("bounce: low", 0.0), ("bounce: high", 0.21)], 0.42, cyclic=True)
    lifted = replace(LEAD, y=LEAD.y - 0.6 * step, height=0.04, pitch=8.0)
    landed = replace(LEAD, y=LEAD.y - step)
    closing = replace(REAR, y=REAR.y - 0.5 * step, height=0.03)

    for name, feet, weight in (
        ("advance: lead foot", (lifted, REAR), -0.08),
        ("advance: landed", (landed, replace(REAR, pitch=26.0)), 0.0),
        ("advance: rear foot", (landed, closing), 0.06),
    ):
        work.pose(name, _boxing(feet=feet, forward=weight), "footwork")
    names = ("guard", "advance: lead foot", "advance: landed", "advance: rear foot")
    times = (0.0, 0.12, 0.24, 0.38)
    work.motion("advance", list(zip(names, times, strict=True)), 0.52, cyclic=True, travel=(0.0, -step, 0.0))
    work.motion("into the guard", [("standing", 0.0), ("guard", 0.7)])


def _from_a_wide_stance(work: Composer) -> None:
    """Left and right in turn, square to the front, the other fist at the hip."""
    stance = Foot(0.26, 0.0, 14.0)
    at_hip, straight = Arm(-18, 100, 10, 98, -70), Arm(86, 84, 30, 8, 75, 10)
    passing = Arm(26, 76, 20, 88, 20, 4)

    def square(left: AnyArm, right: AnyArm, turn: float) -> Moment:
        return balanced_over(
            moment(
                legs=stance,
                left_arm=left,
                right_arm=right,
                bend=44,
                pelvis=Turn(bow=2, turn=0.3 * turn),
                waist=Turn(bow=2, turn=turn),
                neck=Turn(turn=-1.2 * turn),
            )
        )

    right_out = square(at_hip, straight, 18)
    work.pose("wide stance: right punch", right_out, "wide stance")
    work.pose("wide stance: passing", square(passing, passing, 0), "wide stance")
    work.pose("wide stance: left punch", mirrored(right_out), "wide stance")
    names = ["right punch", "passing", "left punch", "passing"]
    times = (0.0, 0.34, 0.56, 0.90)
    steps = [(f"wide stance: {name}", t) for name, t in zip(names, times, strict=True)]
    work.motion("punches from a wide stance", steps, 1.12, cyclic=True)
