"""Squats and lunges, and boxes lifted with the legs, the back or both, turned with and put on a shelf."""

from dataclasses import replace

from keymark.core.prior.library import Library

from ..balance import balanced_over
from ..composing import Composer
from ..moment import AnyArm, Arm, Foot, Hand, Moment, Turn, moment
from ..placing import pivoted

SOURCES = (
    "Hwang, S., Kim, Y. & Kim, Y. (2009). Lower extremity joint kinetics and lumbar curvature during"
    " squat and stoop lifting. BMC Musculoskeletal Disorders 10, 15.",
    "von Arx, M. et al. (2021). From stoop to squat: a comprehensive analysis of lumbar loading among"
    " different lifting styles. Frontiers in Bioengineering and Biotechnology 9, 769117.",
    "Davis, K. G., Splittstoesser, R. E. & Marras, W. S. (2002). Kinematic contribution and"
    " synchronization of the trunk, hip, and knee during free-dynamic lifting. Occupational Ergonomics 3,"
    " 99-108.",
    "Zawadka, M., Smolka, J., Skublewska-Paszkowska, M., Lukasik, E. & Gawda, P. (2020). How are squat"
    " timing and kinematics in the sagittal plane related to squat depth? Journal of Sports Science and"
    " Medicine 19, 500-507.",
    "Schoenfeld, B. J. (2010). Squatting kinematics and kinetics and their application to exercise"
    " performance. Journal of Strength and Conditioning Research 24, 3497-3506.",
    "Riemann, B. L. et al. (2012). Biomechanical analysis of the anterior lunge during 4 external-load"
    " conditions. Journal of Athletic Training 47.",
    "Winter, D. A. (2009). Biomechanics and Motor Control of Human Movement, 4th ed.",
)
FEET = Foot(0.15, 0.0, turn=12.0)
NARROW = Foot(0.11, 0.0, turn=8.0)
HANGING = Arm(9, 40, 10, 14)
BESIDE_BOX_M = 0.17
"""Distance of the wrists from the center of a box."""


def library() -> Library:
    """Compose the library."""
    work = Composer(
        "squatting_lifting",
        "Squatting and Lifting",
        "Squats, lunges and kneeling; a box lifted from the floor with bent knees, with a bent back or"
        " freely, carried to the side or put on a shelf.",
        SOURCES,
        ("exercise", "work"),
    )
    work.pose("standing", _bent(8, 2, 2, HANGING), "standing")
    _squats(work)
    _stoop_lifts(work)
    _squat_lifts(work)
    _turns_with_a_box(work)
    _lunges(work)
    return work.library()


def _bent(
    bend: float, pelvis: float, waist: float, arms: AnyArm, feet: Foot = FEET, heels: float = 0.0
) -> Moment:
    """Knees bent, the trunk bowed in two parts; the head looks ahead as far as it can."""
    return balanced_over(
        moment(
            legs=replace(feet, pitch=heels),
            arms=arms,
            bend=bend,
            pelvis=Turn(bow=pelvis),
            waist=Turn(bow=waist),
            neck=Turn(bow=-0.45 * (pelvis + waist) + 2.0),
        ),
        y=-0.055,
    )


def _at_box(ahead: float, height: float, swivel: float = 15.0) -> Hand:
    """Hands at the sides of a box."""
    return Hand(BESIDE_BOX_M, -ahead, height, swivel, -10.0, short=0.2)


def _squats(work: Composer) -> None:
    """Arms held forward against falling back; and with hanging arms. Down in half of the time."""

    def forward(pelvis: float, waist: float, share: float = 1.0) -> Arm:
        return Arm(share * (86 + pelvis + waist), 84, 10, 12)

    for name, bend, pelvis, waist, arms in (
        ("squat: quarter", 42, 15, 5, forward(15, 5, 0.6)),
        ("squat: half", 76, 25, 8, forward(25, 8)),
        ("squat: parallel", 106, 31, 10, forward(31, 10)),
        ("squat: deep", 128, 30, 16, forward(30, 16)),
        ("squat: quarter, arms down", 40, 16, 6, Arm(18, 80, 10, 16)),
        ("squat: half, arms down", 74, 28, 10, Arm(30, 84, 10, 18)),
        ("squat: parallel, arms down", 104, 34, 12, Arm(38, 82, 10, 24)),
    ):
        work.pose(name, _bent(bend, pelvis, waist, arms), "squat")
    for name, path, seconds in (
        ("squat", ("quarter", "half", "parallel"), 2.6),
        ("deep squat", ("quarter", "half", "parallel", "deep"), 3.2),
        ("squat with arms down", ("quarter, arms down", "half, arms down", "parallel, arms down"), 2.4),
    ):
        names = ["standing", *(f"squat: {step}" for step in path)]
        names += names[-2:0:-1]
        step_s = seconds / len(names)
        work.motion(name, [(each, k * step_s) for k, each in enumerate(names)], seconds, cyclic=True)


def _stoop_lifts(work: Composer) -> None:
    """Knees nearly straight, the back doing the work; and freely, in between of stoop and squat."""
    for name, posed in (
        ("stoop: quarter", _bent(12, 22, 16, _at_box(0.34, 0.82), NARROW)),
        ("stoop: half", _bent(18, 42, 28, _at_box(0.38, 0.58), NARROW)),
        ("stoop: grasping", _bent(26, 62, 40, _at_box(0.36, 0.33), NARROW)),
        ("free lift: bending", _bent(24, 22, 12, _at_box(0.40, 0.76))),
        ("free lift: half", _bent(50, 40, 28, _at_box(0.40, 0.48))),
        ("free lift: grasping", _bent(78, 50, 43, _at_box(0.34, 0.24))),
    ):
        work.pose(name, posed, "lift")
    work.pose("box at the waist", _bent(10, 0, -3, _at_box(0.34, 1.02)), "lift", "box")
    down = [("standing", 0.0), ("stoop: quarter", 0.45), ("stoop: half", 0.8), ("stoop: grasping", 1.3)]
    up = [("stoop: grasping", 1.6), ("stoop: half", 2.0), ("stoop: quarter", 2.3), ("box at the waist", 2.8)]
    work.motion("stoop lift", [*down, *up])
    work.motion(
        "touching the floor with straight knees",
        [*down, *((name, t) for name, t in up[:3]), ("standing", 2.8)],
    )
    work.motion(
        "free lift",
        [
            ("standing", 0.0),
            ("free lift: bending", 0.4),
            ("free lift: half", 0.7),
            ("free lift: grasping", 1.15),
            ("free lift: grasping", 1.4),
            ("free lift: half", 1.85),
            ("free lift: bending", 2.15),
            ("box at the waist", 2.5),
        ],
    )


def _squat_lifts(work: Composer) -> None:
    """Knees bent, the back upright; the box is put on a shelf, the heels leaving the floor."""
    for name, posed in (
        ("squat lift: bending", _bent(46, 18, 12, _at_box(0.40, 0.72))),
        ("squat lift: low", _bent(84, 28, 16, _at_box(0.42, 0.42))),
        ("squat lift: grasping", _bent(112, 36, 32, _at_box(0.38, 0.24))),
        ("squat lift: rising", _bent(72, 34, 14, _at_box(0.36, 0.50))),
        ("squat lift: box at the knees", _bent(40, 22, 10, _at_box(0.36, 0.78))),
        ("box at the chest", _bent(10, 0, -2, _at_box(0.36, 1.26, 35))),
        ("box on a shelf", _bent(8, 3, 0, _at_box(0.48, 1.46, 30))),
        ("box on a high shelf", _bent(8, 3, -3, _at_box(0.42, 1.74, 30), heels=14)),
        ("letting go of a box", _bent(8, 2, 2, Arm(38, 62, 18, 74))),
    ):
        work.pose(name, posed, "lift", "box")
    work.motion(
        "squat lift",
        [
            ("standing", 0.0),
            ("squat lift: bending", 0.5),
            ("squat lift: low", 0.85),
            ("squat lift: grasping", 1.25),
            ("squat lift: grasping", 1.55),
            ("squat lift: rising", 1.95),
            ("squat lift: box at the knees", 2.3),
            ("box at the waist", 2.8),
        ],
    )
    for name, top, seconds in (
        ("to a shelf", "box on a shelf", 0.5),
        ("to a high shelf", "box on a high shelf", 0.75),
    ):
        steps = [("box at the waist", 0.0), ("box at the chest", 0.5), (top, 0.5 + seconds)]
        steps += [("letting go of a box", 1.1 + seconds), ("standing", 1.7 + seconds)]
        work.motion(name, steps)


def _turns_with_a_box(work: Composer) -> None:
    """A quarter to the left in two steps, the box before the chest."""
    carried = Arm(22, 62, 14, 86, -30)

    def holding(left: Foot, right: Foot, pelvis: float, waist: float, x: float, y: float) -> Moment:
        return balanced_over(
            moment(
                left_leg=left,
                right_leg=right,
                arms=carried,
                bend=14,
                pelvis=Turn(bow=2, turn=pelvis),
                waist=Turn(bow=-3, turn=waist),
                neck=Turn(turn=18),
            ),
            x,
            y,
        )

    lifted, there = Foot(0.17, 0.06, 48.0, 14.0, 0.06), Foot(0.12, 0.15, 92.0)
    stays, pivoting = Foot(-0.15, 0.0, -12.0), pivoted(Foot(-0.15, 0.0, -12.0), 14.0, 24.0)
    for name, posed in (
        ("turn with a box: first foot", holding(lifted, stays, 18, 14, -0.12, -0.03)),
        ("turn with a box: between", holding(there, pivoting, 44, 12, 0.03, 0.05)),
        (
            "turn with a box: second foot",
            holding(there, Foot(0.0, -0.07, 46.0, 18.0, 0.06), 64, 8, 0.15, 0.12),
        ),
        ("turn with a box: turned", holding(there, Foot(0.12, -0.14, 72.0), 80, 0, 0.17, 0.0)),
    ):
        work.pose(name, posed, "turn", "box")
    names = ["first foot", "between", "second foot", "turned"]
    times = (0.35, 0.65, 1.0, 1.4)
    work.motion(
        "turn with a box",
        [
            ("box at the waist", 0.0),
            *((f"turn with a box: {name}", t) for name, t in zip(names, times, strict=True)),
        ],
    )


def _lunges(work: Composer) -> None:
    """Forward with the left leg until the right knee is just over the floor; and kneeling to pick up."""
    behind, ahead = Foot(-0.10, 0.0, -6.0), Foot(0.11, -0.74, 4.0)

    def lunging(height: float, heel: float, y: float, bow: float, arms: AnyArm) -> Moment:
        return balanced_over(
            moment(
                y=y,
                left_leg=ahead,
                right_leg=replace(behind, turn=-4.0, pitch=heel),
                arms=arms,
                height=height,
                pelvis=Turn(bow=bow),
                waist=Turn(bow=0.6 * bow),
            ),
            0.01,
            y,
        )

    stepping = moment(
        left_leg=Foot(0.11, -0.34, 4.0, 8.0, 0.10),
        right_leg=replace(behind, pitch=4.0),
        arms=HANGING,
        bend=10,
        pelvis=Turn(bow=4),
        waist=Turn(bow=2),
    )
    for name, posed in (
        ("lunge: stepping", balanced_over(stepping, -0.04, -0.12)),
        ("lunge: landed", lunging(0.80, 34, -0.40, 5, HANGING)),
        ("lunge: sinking", lunging(0.72, 41, -0.41, 6, HANGING)),
        ("lunge: half", lunging(0.64, 46, -0.42, 6, HANGING)),
        ("lunge: down", lunging(0.50, 58, -0.43, 7, HANGING)),
        ("kneeling to pick up", lunging(0.48, 60, -0.46, 34, Hand(0.15, -0.82, 0.36, 25, short=0.2))),
    ):
        work.pose(name, posed, "lunge")
    down = ["stepping", "landed", "sinking", "half"]
    path = ["standing", *(f"lunge: {name}" for name in (*down, "down", *reversed(down)))]
    times = (0.0, 0.5, 0.95, 1.15, 1.35, 1.8, 2.25, 2.42, 2.6, 3.05)
    work.motion("lunge", list(zip(path, times, strict=True)), 3.5, cyclic=True)
    path[5] = "kneeling to pick up"
    work.motion("kneeling to pick up", list(zip([*path, "standing"], (*times, 3.5), strict=True)))
