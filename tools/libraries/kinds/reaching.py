"""Reaching to the front, up, across, aside and to the floor, with one hand or both, standing or with a step.

Where one hand reaches it is the right; mirrored it is the left.
"""

from dataclasses import replace

from keymark.core.prior.library import Library

from ..balance import BEFORE_ANKLE_M, balanced_over
from ..composing import Composer
from ..moment import AnyArm, Arm, Foot, Hand, Moment, Turn, moment

SOURCES = (
    "Flash, T. & Hogan, N. (1985). The coordination of arm movements: an experimentally confirmed"
    " mathematical model. Journal of Neuroscience 5, 1688-1703.",
    "Vandenberghe, A., Levin, O., De Schutter, J., Swinnen, S. & Jonkers, I. (2010). Three-dimensional"
    " reaching tasks: effect of reaching height and width on upper limb kinematics and muscle activity."
    " Gait & Posture 32, 500-507.",
    "Kaminski, T. R., Bock, C. & Gentile, A. M. (1995). The coordination between trunk and arm motion"
    " during pointing movements. Experimental Brain Research 106, 457-466.",
    "Braman, J. P. et al. (2009). In vivo assessment of scapulohumeral rhythm during unconstrained"
    " overhead reaching in asymptomatic subjects. Journal of Shoulder and Elbow Surgery 18, 960-967.",
    "Winter, D. A. (2009). Biomechanics and Motor Control of Human Movement, 4th ed.",
)
LEFT_FOOT, RIGHT_FOOT = Foot(0.12, 0.0, 9.0), Foot(-0.12, 0.0, -9.0)
HANGING = Arm(9, 35, 12, 16)
OUT_S, HOLD_S, BACK_S = 0.75, 0.25, 0.8
"""Durations of a reach at arm's length: out, hold, and back."""
FLOOR_S = 1.15


def library() -> Library:
    """Compose the library."""
    work = Composer(
        "reaching",
        "Reaching",
        "One hand or both reach to the front, up to a shelf, across, to the side or to the floor, standing"
        " or with a step.",
        SOURCES,
        ("work", "everyday"),
    )
    work.pose("standing", _reaching(HANGING), "standing")
    work.pose("hand before the chest", _reaching(Arm(34, 72, 34, 112), bow=2), "one hand")
    _forward(work)
    _up(work)
    _aside(work)
    _to_the_floor(work)
    _with_both_hands(work)
    _with_a_step(work)
    return work.library()


def _reaching(
    right: AnyArm,
    left: AnyArm = HANGING,
    *,
    bow: float = 1.0,
    waist: float = 2.0,
    lean: float = 0.0,
    turn: float = 0.0,
    bend: float = 8.0,
    head: tuple[float, float] = (0.0, 0.0),
    feet: tuple[Foot, Foot] = (LEFT_FOOT, RIGHT_FOOT),
    over: tuple[float, float] = (0.0, -BEFORE_ANKLE_M),
) -> Moment:
    """A trunk that helps by bowing, leaning and turning to the left; a third of the turn is the hips'.

    `head` nods down and turns to the left; `over` is where the weight is.
    """
    return balanced_over(
        moment(
            x=over[0],
            y=over[1],
            left_leg=feet[0],
            right_leg=feet[1],
            left_arm=left,
            right_arm=right,
            bend=bend,
            pelvis=Turn(bow=bow, lean=0.3 * lean, turn=0.33 * turn),
            waist=Turn(bow=waist, lean=0.7 * lean, turn=0.67 * turn),
            neck=Turn(bow=head[0], turn=head[1]),
        ),
        *over,
    )


def _at(x: float, ahead: float, height: float, swivel: float = 20.0, girdle: float = 4.0) -> Hand:
    """The right hand at a position, or as near as it can reach."""
    return Hand(x, -ahead, height, swivel, 30.0, girdle, short=0.4)


def _there_and_back(work: Composer, name: str, path: tuple[str, ...], out_s: float = OUT_S) -> None:
    """From standing along a path, a moment at its end, and back along it."""
    share = out_s / len(path)
    steps = [("standing", 0.0), *((posture, (k + 1) * share) for k, posture in enumerate(path))]
    here = out_s + HOLD_S
    back = [*reversed(path[:-1]), "standing"]
    share = out_s * BACK_S / OUT_S / len(back)
    steps += [(path[-1], here), *((posture, here + (k + 1) * share) for k, posture in enumerate(back))]
    work.motion(name, steps)


def _forward(work: Composer) -> None:
    """Within arm's length, at shoulder height and over a table, and beyond it, where the trunk follows."""
    for name, posed in (
        ("front: half", _reaching(Arm(36, 80, 24, 76), bow=2, turn=4)),
        ("front", _reaching(_at(-0.14, 0.56, 1.34), bow=3, waist=4, turn=10)),
        ("far to the front: half", _reaching(Arm(52, 82, 20, 62), bow=7, waist=9, turn=8, over=(0.0, -0.07))),
        (
            "far to the front",
            _reaching(
                _at(-0.06, 0.92, 1.06, 20, 8),
                Arm(16, 40, 10, 16),
                bow=22,
                waist=24,
                turn=22,
                bend=12,
                head=(-22, -8),
                over=(0.02, -0.11),
            ),
        ),
        ("table", _reaching(_at(-0.12, 0.50, 0.98), bow=8, waist=10, turn=8, head=(16, 0))),
    ):
        work.pose(name, posed, "one hand", "front")
    _there_and_back(work, "reach to the front", ("front: half", "front"))
    _there_and_back(work, "reach far to the front", ("far to the front: half", "far to the front"), 0.95)
    _there_and_back(work, "reach over a table", ("front: half", "table"))


def _up(work: Composer) -> None:
    """To a shelf, and to a higher one with the heels off the floor."""
    tiptoe = (replace(LEFT_FOOT, pitch=26.0), replace(RIGHT_FOOT, pitch=32.0))
    for name, posed in (
        ("shelf: half", _reaching(Arm(74, 74, 26, 88, 10, 4), turn=4, head=(-12, -6))),
        ("shelf", _reaching(Arm(138, 72, 22, 18, 20, 14), bow=0, waist=-2, lean=5, turn=6, head=(-22, -8))),
        (
            "high shelf",
            _reaching(
                Arm(160, 66, 16, 8, 20, 22),
                Arm(14, 20, 12, 18),
                bow=0,
                waist=-4,
                lean=11,
                turn=8,
                head=(-30, -8),
                feet=tiptoe,
                over=(-0.02, -0.12),
            ),
        ),
    ):
        work.pose(name, posed, "one hand", "up")
    _there_and_back(work, "reach to a shelf", ("shelf: half", "shelf"), 0.9)
    _there_and_back(work, "reach to a high shelf", ("shelf: half", "shelf", "high shelf"), 1.2)


def _aside(work: Composer) -> None:
    """Across to the left, high and low; to the right, level and down beside the leg."""
    for name, posed in (
        ("across: half", _reaching(Arm(46, 92, 40, 84), turn=14, head=(0, 8))),
        ("across", _reaching(_at(0.26, 0.42, 1.24, 60, 6), bow=3, waist=4, turn=38, head=(0, 10))),
        (
            "low across",
            _reaching(
                _at(0.36, 0.30, 0.66, 40, 2), bow=16, waist=22, lean=8, turn=34, bend=18, head=(14, 10)
            ),
        ),
        ("side: half", _reaching(Arm(46, 24, 10, 56), turn=-6, head=(0, -20))),
        (
            "side",
            _reaching(
                Arm(86, 8, 6, 10, 10, 8), lean=-5, turn=-16, head=(2, -34), over=(-0.02, -BEFORE_ANKLE_M)
            ),
        ),
        (
            "down beside",
            _reaching(
                _at(-0.42, 0.06, 0.50, 20, -4),
                Arm(24, 10, 12, 22),
                bow=10,
                waist=12,
                lean=-38,
                turn=-12,
                bend=26,
                head=(14, -16),
            ),
        ),
    ):
        work.pose(name, posed, "one hand", "aside")
    _there_and_back(work, "reach across", ("across: half", "across"))
    _there_and_back(work, "reach low across", ("across: half", "low across"), 0.95)
    _there_and_back(work, "reach to the side", ("side: half", "side"))
    _there_and_back(work, "reach down beside", ("side: half", "down beside"), 1.1)


def _to_the_floor(work: Composer) -> None:
    """Before the feet, beside the right foot and before the left, by bending knees and back alike."""
    balancing = Arm(46, 66, 10, 30)
    for name, posed in (
        ("floor: bowing", _reaching(Arm(30, 80, 14, 26), HANGING, bow=18, waist=14, bend=26, head=(4, 0))),
        (
            "floor: low",
            _reaching(Arm(54, 84, 10, 16), Arm(34, 66, 10, 24), bow=36, waist=28, bend=60, head=(-6, 0)),
        ),
        (
            "floor",
            _reaching(
                _at(-0.10, 0.42, 0.20),
                balancing,
                bow=48,
                waist=38,
                turn=12,
                bend=88,
                head=(-12, 0),
                over=(0, -0.08),
            ),
        ),
        (
            "floor, to the right",
            _reaching(
                _at(-0.42, 0.20, 0.20),
                balancing,
                bow=44,
                waist=36,
                lean=-10,
                turn=-26,
                bend=88,
                head=(-4, -10),
            ),
        ),
        (
            "floor, to the left",
            _reaching(
                _at(0.28, 0.34, 0.20), balancing, bow=46, waist=40, lean=4, turn=34, bend=84, head=(-4, 10)
            ),
        ),
    ):
        work.pose(name, posed, "one hand", "floor")
    for name in ("floor", "floor, to the right", "floor, to the left"):
        _there_and_back(work, f"reach to the {name}", ("floor: bowing", "floor: low", name), FLOOR_S)
    up = ("floor", "floor: low", "floor: bowing", "hand before the chest", "shelf: half", "shelf")
    work.motion("from the floor to a shelf", [(name, 0.36 * k) for k, name in enumerate(up)])


def _with_both_hands(work: Composer) -> None:
    """To the front, to a shelf and to the floor."""
    overhead = Arm(134, 70, 20, 22, 10, 14)
    floor = Hand(0.14, -0.36, 0.24, 15, 0, 0, short=0.4)
    front = Hand(0.15, -0.60, 1.28, 20, 20, 4, short=0.4)
    half = Arm(40, 78, 22, 78)
    for name, posed in (
        ("both hands: half", _both(half, 2, 3, 8)),
        ("both hands: front", _both(front, 5, 6, 8)),
        ("both hands: shelf", _both(overhead, 0, -4, 8, -18)),
        ("both hands: bowing", _both(Arm(38, 82, 12, 22), 22, 18, 30, 4)),
        ("both hands: low", _both(Arm(58, 84, 10, 18), 38, 30, 58, -4)),
        ("both hands: floor", _both(floor, 48, 40, 84, -8)),
    ):
        work.pose(name, posed, "both hands")
    first = "both hands: half"
    _there_and_back(work, "both hands to the front", (first, "both hands: front"))
    _there_and_back(work, "both hands to a shelf", (first, "both hands: shelf"), 0.9)
    low = ("both hands: bowing", "both hands: low", "both hands: floor")
    _there_and_back(work, "both hands to the floor", low, FLOOR_S)


def _both(arms: Arm | Hand, bow: float, waist: float, bend: float, head: float = 0.0) -> Moment:
    right = replace(arms, x=-arms.x) if isinstance(arms, Hand) else arms
    return _reaching(right, arms, bow=bow, waist=waist, bend=bend, head=(head, 0.0))


def _with_a_step(work: Composer) -> None:
    """A step forward with the right foot before the hand arrives."""
    stepped = Foot(-0.12, -0.52, -6.0)
    for name, posed in (
        (
            "step: foot in the air",
            _reaching(
                Arm(34, 80, 20, 62),
                bow=6,
                waist=5,
                turn=6,
                bend=12,
                feet=(replace(LEFT_FOOT, pitch=10.0), Foot(-0.12, -0.30, -6.0, 4.0, 0.07)),
                over=(0.03, -0.16),
            ),
        ),
        (
            "step: front",
            _reaching(
                _at(-0.10, 1.06, 1.26, 20, 8),
                Arm(10, 40, 10, 20),
                bow=12,
                waist=12,
                turn=18,
                bend=14,
                head=(-10, -6),
                feet=(replace(LEFT_FOOT, pitch=30.0), stepped),
                over=(-0.04, -0.40),
            ),
        ),
        (
            "step: low",
            _reaching(
                _at(-0.10, 0.94, 0.52, 20, 4),
                Arm(50, 76, 10, 26),
                bow=34,
                waist=28,
                turn=16,
                bend=44,
                head=(-6, -4),
                feet=(replace(LEFT_FOOT, pitch=36.0), stepped),
                over=(-0.04, -0.38),
            ),
        ),
    ):
        work.pose(name, posed, "one hand", "step")
    for name in ("front", "low"):
        _there_and_back(work, f"step and reach {name}", ("step: foot in the air", f"step: {name}"), 1.0)
