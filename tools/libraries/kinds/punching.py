"""Boxing from a guard that the left hand leads, and punches of people who are no boxers.

Mirrored, the right hand leads.
"""

from dataclasses import replace

from keymark.core.prior.library import Library

from ..balance import balanced_over
from ..boxer import LEAD, REAR, boxing, fist, lead_pivot, rear_pivot
from ..composing import Composer
from ..moment import AnyArm, Arm, Foot, Moment, Turn, mirrored, moment

SOURCES = (
    "Stanley, E., Thomson, E., Smith, G. & Lamb, K. L. (2018). An analysis of the three-dimensional"
    " kinetics and kinematics of maximal effort punches among amateur boxers. International Journal of"
    " Performance Analysis in Sport 18.",
    "Piorkowski, B. A., Lees, A. & Barton, G. J. (2011). Single maximal versus combination punch"
    " kinematics. Sports Biomechanics 10.",
    "Dinu, D. & Louis, J. (2020). Biomechanical analysis of the cross, hook, and uppercut in junior vs."
    " elite boxers: implications for training and talent identification. Frontiers in Sports and Active"
    " Living 2, 598861.",
    "Winter, D. A. (2009). Biomechanics and Motor Control of Human Movement, 4th ed.",
)
Path = tuple[tuple[str, float], ...]


def library() -> Library:
    """Compose the library."""
    work = Composer(
        "punching",
        "Punching",
        "Jab, cross, hooks and uppercuts from a boxer's guard, slips, ducking, blocking and footwork;"
        " straight punches and swings from an easy and from a wide stance.",
        SOURCES,
        ("sport", "fight"),
    )
    standing = moment(legs=Foot(0.11, 0.0, 9.0), bend=8, pelvis=Turn(bow=1), waist=Turn(bow=2))
    work.pose("standing", balanced_over(standing), "standing")
    work.pose("guard", boxing(), "guard")
    low = Arm(24, 52, 20, 96, 10)
    work.pose("guard, hands low", boxing(low, low, turn=6, bow=-4, bend=18), "guard")
    _bent_punches(work)
    _straight_punches(work)
    _defense(work)
    _footwork(work)
    _from_an_easy_stance(work)
    _from_a_wide_stance(work)
    return work.library()


def _from_guard(work: Composer, name: str, path: Path) -> None:
    """A motion from the guard and back to it; times are from its beginning [s]."""
    work.motion(name, [("guard", 0.0), *path])


def _straight_punches(work: Composer) -> None:
    """Jab with the lead hand, cross with the rear, a jab to the body; a third of a second to the target."""
    for name, posed in (
        ("jab: halfway", boxing(fist(0.05, 0.58, 1.42, 24, 50, 8), turn=-4, chest=-8, forward=0.02)),
        ("jab", boxing(fist(0.02, 1.0, 1.43, 42, 75, 14), turn=-8, chest=-20, bow=2, forward=0.06)),
        (
            "cross: halfway",
            boxing(
                right=fist(-0.06, 0.44, 1.40, 30, 40, 6),
                turn=16,
                chest=8,
                forward=0.03,
                feet=rear_pivot(18, 26),
            ),
        ),
        (
            "cross",
            boxing(
                right=fist(-0.02, 1.0, 1.42, 42, 75, 12),
                turn=32,
                chest=22,
                bow=6,
                forward=0.09,
                feet=rear_pivot(42, 42),
            ),
        ),
        (
            "jab to the body",
            boxing(fist(0.02, 1.0, 1.06, 42, 75, 10), turn=-8, chest=-16, bow=20, bend=52, forward=0.08),
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
        "jab, cross and hook",
        (
            ("jab: halfway", 0.14),
            ("jab", 0.26),
            ("cross: halfway", 0.46),
            ("cross", 0.60),
            ("lead hook: swinging", 0.84),
            ("lead hook", 1.02),
            ("guard", 1.45),
        ),
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
        ("lead hook: swinging", boxing(swinging, turn=6, chest=12, lean=4)),
        ("lead hook", boxing(hooking, turn=-26, chest=-24, feet=lead_pivot(-42, 24))),
        ("rear hook: swinging", boxing(right=swinging, turn=0, chest=-8, feet=rear_pivot(10, 24))),
        ("rear hook", boxing(right=hooking, turn=46, chest=34, bow=4, forward=0.06, feet=rear_pivot(46, 44))),
        (
            "rear uppercut: loaded",
            boxing(right=loaded, turn=-10, chest=-14, bow=10, lean=-14, bend=46, aside=-0.03),
        ),
        (
            "rear uppercut",
            boxing(
                right=rising,
                turn=34,
                chest=18,
                bow=-6,
                lean=4,
                bend=14,
                forward=0.04,
                feet=rear_pivot(40, 40),
            ),
        ),
        ("lead uppercut: loaded", boxing(loaded, turn=12, chest=14, bow=10, lean=14, bend=44, aside=0.03)),
        (
            "lead uppercut",
            boxing(rising, turn=-16, chest=-14, bow=-6, lean=-4, bend=14, feet=lead_pivot(-20, 14)),
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


def _defense(work: Composer) -> None:
    """The head leaves the line of a punch to either side or below, or goes behind the arms."""
    high = Arm(56, 72, 24, 142, 30, 10)
    for name, posed in (
        ("slip to the left", boxing(turn=8, chest=10, bow=14, lean=24, bend=40, aside=0.05)),
        ("slip to the right", boxing(turn=-10, chest=-10, bow=14, lean=-24, bend=42, aside=-0.05)),
        ("block", boxing(high, high, bow=12, bend=30)),
    ):
        work.pose(name, posed, "defence")
        _from_guard(work, name, ((name, 0.32), ("guard", 0.72)))
    work.pose("duck: half", boxing(bow=13, bend=50, forward=0.01), "defence")
    work.pose("duck", boxing(bow=26, bend=76, forward=0.02), "defence")
    _from_guard(work, "duck", (("duck: half", 0.18), ("duck", 0.36), ("duck: half", 0.56), ("guard", 0.76)))


def _footwork(work: Composer) -> None:
    """Bouncing in the guard, and steps to the front: the lead foot first, the rear follows."""
    step = 0.22
    heels = (replace(LEAD, pitch=12.0), replace(REAR, pitch=24.0))
    work.pose("bounce: low", boxing(bend=34, bow=3), "footwork")
    work.pose("bounce: high", boxing(bend=14, feet=heels), "footwork")
    work.motion("bouncing", [("bounce: low", 0.0), ("bounce: high", 0.21)], 0.42, cyclic=True)
    loose = [("guard, hands low", 0.0), ("bounce: low", 0.3), ("bounce: high", 0.55), ("guard", 0.8)]
    work.motion("moving in the guard", loose, 1.05, cyclic=True)
    lifted = replace(LEAD, y=LEAD.y - 0.6 * step, height=0.04, pitch=8.0)
    landed = replace(LEAD, y=LEAD.y - step)
    closing = replace(REAR, y=REAR.y - 0.5 * step, height=0.03)

    for name, feet, weight in (
        ("advance: lead foot", (lifted, REAR), -0.08),
        ("advance: landed", (landed, replace(REAR, pitch=26.0)), 0.0),
        ("advance: rear foot", (landed, closing), 0.06),
    ):
        work.pose(name, boxing(feet=feet, forward=weight), "footwork")
    names = ("guard", "advance: lead foot", "advance: landed", "advance: rear foot")
    times = (0.0, 0.12, 0.24, 0.38)
    work.motion("advance", list(zip(names, times, strict=True)), 0.52, cyclic=True, travel=(0.0, -step, 0.0))
    work.motion("into the guard", [("standing", 0.0), ("guard", 0.7)])
    _retreating_and_circling(work)


def _retreating_and_circling(work: Composer) -> None:
    """Steps to the back, the rear foot first; and to the left, the lead foot first."""
    step = 0.20
    aside, back = replace(LEAD, x=LEAD.x + step), replace(REAR, y=REAR.y + step)
    lifted = replace(REAR, y=REAR.y + 0.6 * step, height=0.04)
    for name, feet, weight, left in (
        ("retreat: rear foot", (LEAD, lifted), 0.06, 0.0),
        ("retreat: landed", (replace(LEAD, pitch=10.0), back), 0.02, 0.0),
        ("circle: lead foot", (replace(aside, x=LEAD.x + 0.6 * step, height=0.04), REAR), -0.06, -0.03),
        ("circle: landed", (aside, replace(REAR, pitch=28.0)), 0.0, 0.5 * step),
    ):
        work.pose(name, boxing(feet=feet, forward=weight, aside=left), "footwork")
    steps = [("guard", 0.0), ("retreat: rear foot", 0.13), ("retreat: landed", 0.27)]
    work.motion("retreat", steps, 0.54, cyclic=True, travel=(0.0, step, 0.0))
    steps = [("guard", 0.0), ("circle: lead foot", 0.14), ("circle: landed", 0.28)]
    work.motion("circle", steps, 0.56, cyclic=True, travel=(step, 0.0, 0.0))


def _from_an_easy_stance(work: Composer) -> None:
    """Nearly upright with the fists before the chest, as people punch who are no boxers; and a wide swing."""
    feet, square = (Foot(0.14, -0.12, 0.0), Foot(-0.14, 0.12, -20.0)), 24.0
    fists, straight = Arm(26, 66, 26, 106, 20, 2), {"swivel": 38.0, "pronation": 70.0}

    def easy(
        left: AnyArm, right: AnyArm, turn: float = 0.0, chest: float = 0.0, forward: float = 0.0
    ) -> Moment:
        return boxing(
            left, right, turn=square + turn, chest=chest, bow=-9, bend=16, forward=forward, feet=feet
        )

    low = Arm(16, 60, 16, 84, 10)
    drawn, swung = Arm(66, -16, -30, 92, 10, 8), Arm(90, 60, 30, 46, 40, 12)
    for name, posed in (
        ("fists up", easy(fists, fists)),
        ("easy: right punch", easy(fists, fist(-0.06, 1.0, 1.36, **straight), 10, 24, 0.05)),
        ("easy: left punch", easy(fist(0.08, 1.0, 1.36, **straight), fists, -12, -22, 0.05)),
        ("swing: drawn back", easy(fists, drawn, -16, -26, -0.06)),
        ("swing: through", easy(fists, swung, 18, 34, 0.08)),
        ("low hands: right punch", easy(low, fist(-0.04, 0.92, 1.24, **straight), 8, 20, 0.03)),
        ("low hands: left punch", easy(fist(0.06, 0.92, 1.24, **straight), low, -10, -18, 0.03)),
    ):
        work.pose(name, posed, "easy stance")
    names = ("fists up", "easy: right punch", "fists up", "easy: left punch")
    steps = [(name, t) for name, t in zip(names, (0.0, 0.30, 0.60, 0.90), strict=True)]
    work.motion("punches from an easy stance", steps, 1.20, cyclic=True)
    names = ("low hands: right punch", "low hands: left punch")
    work.motion("punches with low hands", list(zip(names, (0.0, 0.42), strict=True)), 0.84, cyclic=True)
    names = ("fists up", "swing: drawn back", "swing: through", "fists up")
    times = (0.0, 0.4, 0.68, 1.15)
    work.motion("swing", list(zip(names, times, strict=True)))


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
