"""Aerobic exercise to music: side steps, touches, knee lifts, marching, arm raises, jumping jacks and curls.

The pace is a class's of 128 beats a minute; an exercise takes one, two or four beats to either side.
"""

from collections.abc import Sequence
from dataclasses import replace

from keymark.core.prior.library import Library

from ..balance import balanced_over
from ..composing import Composer
from ..moment import Arm, Foot, Leg, Moment, Turn, mirrored, moment

SOURCES = (
    "Costa, M. J., Oliveira, C., Teixeira, G., Marinho, D. A., Silva, A. J. & Barbosa, T. M. (2011). The"
    " influence of musical cadence into aquatic jumping jacks kinematics. Journal of Sports Science and"
    " Medicine 10, 607-615.",
    "Bishop, J. G. (2013). Fitness through Aerobics.",
    "Inman, V. T., Saunders, J. B. & Abbott, L. C. (1944). Observations on the function of the shoulder"
    " joint. Journal of Bone and Joint Surgery 26.",
    "Winter, D. A. (2009). Biomechanics and Motor Control of Human Movement, 4th ed.",
)
BEAT_S = 60.0 / 128.0
HIP_WIDE = Foot(0.10, 0.0, turn=8.0)
CARRYING = Foot(-0.09, 0.0, turn=-8.0)
"""The right foot while it carries all weight."""
HANGING = Arm(elevation=10, plane=25, rotation=12, elbow=16)


def library() -> Library:
    """Compose the library."""
    work = Composer(
        "aerobic",
        "Aerobic Exercise",
        "Side steps, step touches, knee lifts, marching, raises of the arms, jumping jacks and curls, at a"
        " music of 128 beats a minute.",
        SOURCES,
        ("exercise",),
    )
    work.pose("standing", _standing(HANGING), "standing")
    _side_steps(work)
    _step_touches(work)
    _knee_lifts(work)
    _arm_raises(work)
    _jumping_jacks(work)
    return work.library()


def _standing(arms: Arm, bend: float = 14.0, trunk: float = 2.0) -> Moment:
    return balanced_over(
        moment(arms=arms, legs=HIP_WIDE, bend=bend, pelvis=Turn(bow=trunk), waist=Turn(bow=1.0 + trunk))
    )


def _raised(elevation: float, plane: float = 10.0, elbow: float = 12.0, rotation: float = 0.0) -> Arm:
    """An arm lifted, the shoulder lifting with it: a ninth of the way, the shoulder blade's outer end."""
    girdle = max(elevation - 20.0, 0.0) / 9.0
    return Arm(elevation - girdle, plane, rotation, elbow, 10.0, girdle)


def _counted(work: Composer, name: str, postures: Sequence[str], beats: Sequence[float]) -> None:
    """A cyclic motion by beats; one beat more than postures, for the cycle's end."""
    steps = [(posture, beat * BEAT_S) for posture, beat in zip(postures, beats, strict=False)]
    work.motion(name, steps, beats[-1] * BEAT_S, cyclic=True)


def _side_steps(work: Composer) -> None:
    """To the left: apart with the arms rising to the side, together with the arms falling."""
    far = 0.46
    here, there = HIP_WIDE, Foot(HIP_WIDE.x + far, 0.0, turn=8.0)
    behind = Foot(-HIP_WIDE.x, 0.0, turn=-8.0)
    names = ["standing"]
    leaving, landing = Foot(here.x + 0.20, -0.02, 8.0, 18.0, 0.06), replace(there, pitch=14.0)
    pushing, closing = replace(behind, pitch=6.0), Foot(0.14, -0.01, -8.0, 20.0, 0.05)
    for name, left, right, center, arms, bend, lean in (
        ("leaving", leaving, behind, 0.03, _raised(46, 12, 24), 18, -2),
        ("landing", landing, behind, 0.13, _raised(74, 8, 18), 18, -1),
        ("apart", there, pushing, 0.26, _raised(90, 6, 12), 16, 0),
        ("closing", there, closing, 0.45, _raised(44, 30, 48), 16, 2),
    ):
        posed = moment(
            left_leg=left,
            right_leg=right,
            arms=arms,
            bend=bend,
            pelvis=Turn(bow=4, lean=-lean),
            waist=Turn(bow=3, lean=lean),
        )
        names.append(work.pose(f"side step: {name}", balanced_over(posed, center), "side step"))
    steps = [(name, beat * BEAT_S) for name, beat in zip(names, (0.0, 0.5, 0.78, 1.0, 1.55), strict=True)]
    work.motion("side step", steps, 2.0 * BEAT_S, cyclic=True, travel=(far, 0.0, 0.0))


def _step_touches(work: Composer) -> None:
    """Side to side with a touch of the toes and a curl of the arms; the same with heels to the buttocks."""
    curled = Arm(14, 55, 10, 122, -40)
    touch = moment(
        left_leg=Foot(0.32, 0.0, 10.0),
        right_leg=Foot(0.13, 0.03, -10.0, 32.0),
        arms=curled,
        bend=14,
        pelvis=Turn(bow=4, lean=-2),
        waist=Turn(bow=4, lean=1),
    )
    passing = moment(
        left_leg=Foot(0.32, 0.0, 10.0),
        right_leg=Foot(-0.06, 0.0, -10.0, 16.0, 0.05),
        arms=Arm(16, 45, 10, 74, -20),
        bend=18,
        pelvis=Turn(bow=4, lean=-1),
        waist=Turn(bow=4),
    )
    curl = moment(
        left_leg=Foot(0.32, 0.0, 10.0),
        right_leg=Leg(flexion=-6, abduction=4, knee=102, ankle=20),
        arms=_raised(82, 70, 40),
        bend=10,
        pelvis=Turn(bow=6, lean=-2),
        waist=Turn(bow=6, lean=1),
    )
    stride = moment(
        legs=Foot(0.32, 0.0, 10.0), arms=Arm(14, 35, 10, 34), bend=20, pelvis=Turn(bow=5), waist=Turn(bow=4)
    )
    work.pose("step touch: apart", balanced_over(stride), "step touch")
    for name, posed, center in (
        ("step touch: touching", touch, 0.29),
        ("step touch: passing", passing, 0.25),
        ("leg curl", curl, 0.31),
    ):
        posed = balanced_over(posed, center)
        work.pose(f"{name} left", posed, "step touch")
        work.pose(f"{name} right", mirrored(posed), "step touch")
    passing_left, passing_right = (f"step touch: passing {side}" for side in ("left", "right"))
    for name, end in (("step touch", "step touch: touching"), ("leg curl", "leg curl")):
        names = [f"{end} left", passing_left, "step touch: apart", passing_right]
        names += [f"{end} right", passing_right, "step touch: apart", passing_left]
        _counted(work, name, names, (0.0, 0.55, 1.0, 1.45, 2.0, 2.55, 3.0, 3.45, 4.0))


def _knee_lifts(work: Composer) -> None:
    """High knees with the opposite arm to the front or bent up, and marching on the spot."""

    def lifted(hip: float, knee: float, left: Arm, right: Arm, turn: float) -> Moment:
        return balanced_over(
            moment(
                left_leg=Leg(flexion=hip, abduction=4, knee=knee, ankle=25),
                right_leg=CARRYING,
                left_arm=left,
                right_arm=right,
                bend=14,
                pelvis=Turn(bow=-0.07 * hip, lean=-0.05 * hip, turn=-0.06 * hip),
                waist=Turn(bow=0.1 * hip, lean=0.07 * hip, turn=0.14 * turn),
                neck=Turn(bow=-2),
            ),
            -0.085,
            -0.04,
        )

    exercises = {
        "knee lift": (
            lifted(52, 78, Arm(30, 4, 12, 62), Arm(52, 70, 20, 60), 52),
            lifted(98, 108, Arm(50, -12, 6, 80), _raised(88, 70, 42, 20), 98),
        ),
        "knee lift with wide arms": (
            lifted(52, 78, _raised(66, 14, 26), _raised(66, 16, 62, -40), 0),
            lifted(96, 104, _raised(80, 10, 16), _raised(84, 16, 84, -62), 0),
        ),
    }
    for name, (half, high) in exercises.items():
        sides = {"left": (half, high), "right": (mirrored(half), mirrored(high))}
        names = []
        for side, (rising, top) in sides.items():
            halfway = work.pose(f"{name}: rising {side}", rising, "knee lift")
            names += ["standing", halfway, work.pose(f"{name}: high {side}", top, "knee lift"), halfway]
        _counted(work, name, names, (0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0))
    march = lifted(56, 74, Arm(-24, 108, 8, 60), Arm(34, 82, 14, 82), 60)
    change = moment(
        left_leg=Foot(0.09, -0.02, 8.0, 14.0),
        right_leg=Foot(-0.09, 0.0, -8.0),
        arms=Arm(8, 60, 10, 66),
        bend=10,
        pelvis=Turn(bow=1),
        waist=Turn(bow=2),
    )
    work.pose("march: left", march, "march")
    work.pose("march: changing", balanced_over(change), "march")
    work.pose("march: right", mirrored(march), "march")
    names = ["march: left", "march: changing", "march: right", "march: changing"]
    _counted(work, "march", names, (0.0, 0.5, 1.0, 1.5, 2.0))


def _arm_raises(work: Composer) -> None:
    """Arms alone: to the side, to the front, overhead, pressed up, drawn in, and curled."""
    for name, arms in (
        ("arms half to the side", _raised(48)),
        ("arms to the side", _raised(90, 6, 10)),
        ("arms up and apart", _raised(135, 16, 12)),
        ("arms overhead", _raised(172, 24, 12)),
        ("arms half forward", _raised(48, 84, 14)),
        ("arms forward", _raised(90, 86, 12)),
        ("hands at the shoulders", Arm(42, 40, -14, 142, 0, 4)),
        ("elbows drawn in", Arm(20, 14, -48, 90)),
        ("arms half curled", Arm(10, 50, 6, 70, -50)),
        ("arms curled", Arm(16, 70, 6, 138, -60)),
    ):
        work.pose(name, _standing(arms, bend=18 if "curled" in name else 14), "arms")
    for name, path, hold in (
        ("side raise", ("arms half to the side", "arms to the side"), 1.0),
        ("front raise", ("arms half forward", "arms forward"), 1.0),
        ("curl", ("arms half curled", "arms curled"), 1.0),
        (
            "overhead raise",
            ("arms half to the side", "arms to the side", "arms up and apart", "arms overhead"),
            0.75,
        ),
    ):
        names = ["standing", *path, *reversed(path[:-1])]
        _counted(work, name, names, [hold * beat for beat in range(len(names) + 1)])
    for name, top in (("pull down", "arms up and apart"), ("pull in", "arms to the side")):
        _counted(work, name, ["elbows drawn in", top], (0.0, 1.0, 2.0))
    names = ["hands at the shoulders", "arms up and apart", "arms overhead", "arms up and apart"]
    _counted(work, "overhead press", names, (0.0, 0.5, 1.0, 1.5, 2.0))


def _jumping_jacks(work: Composer) -> None:
    """Two flights a cycle, each shorter than a beat."""
    apart, trunk = 0.38, {"pelvis": Turn(bow=5), "waist": Turn(bow=4)}
    flying = Leg(flexion=10, abduction=11, knee=20, ankle=35)
    names = []
    for name, posed in (
        ("crouched", moment(legs=Foot(0.09, 0.0, 8.0), arms=HANGING, bend=38, **trunk)),
        ("leaving", moment(legs=Foot(0.09, 0.0, 8.0, 38.0), arms=_raised(38, 12, 24), bend=14, **trunk)),
        ("opening", moment(legs=flying, arms=_raised(92, 12, 26), lift=0.05, **trunk)),
        (
            "landing apart",
            moment(legs=Foot(apart, 0.0, 12.0, 22.0), arms=_raised(142, 14, 22), bend=24, **trunk),
        ),
        ("apart", moment(legs=Foot(apart, 0.0, 12.0), arms=_raised(166, 22, 22), bend=36, **trunk)),
        (
            "leaving apart",
            moment(legs=Foot(apart, 0.0, 12.0, 34.0), arms=_raised(142, 14, 30), bend=14, **trunk),
        ),
        ("closing", moment(legs=flying, arms=_raised(76, 12, 40), lift=0.04, **trunk)),
    ):
        ahead = -0.08 if "leaving" in name else -0.05
        names.append(work.pose(f"jumping jack: {name}", balanced_over(posed, y=ahead), "jumping jack"))
    _counted(work, "jumping jack", names, (0.0, 0.28, 0.54, 0.80, 1.06, 1.30, 1.56, 2.0))
