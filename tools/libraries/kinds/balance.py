"""Balance: on one leg in many ways, wobbling, on tiptoe, and walking along a beam.

Where one leg carries it is the right; mirrored it is the left.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from keymark.core.prior.library import Library

from ..balance import balanced_over
from ..composing import Composer
from ..moment import AnyArm, AnyLeg, Arm, Foot, Leg, Moment, Turn, mirrored, moment
from ..placing import moved

SOURCES = (
    "Boström, K. J., Dirksen, T., Zentgraf, K. & Wagner, H. (2018). The contribution of upper body"
    " movements to dynamic balance regulation during challenged locomotion. Frontiers in Human"
    " Neuroscience 12, 8.",
    "Hill, M. W., Wdowski, M. M., Pennell, A., Stodden, D. F. & Duncan, M. J. (2019). Dynamic postural"
    " control in children: do the arms lend the legs a helping hand? Frontiers in Physiology 9, 1932.",
    "McCurdy, K. & Langford, G. (2006). The relationship between maximum unilateral squat strength and"
    " balance in young adult men and women. Journal of Sports Science and Medicine 5, 282-288.",
    "Otten, E. (1999). Balancing on a narrow ridge: biomechanics and control. Philosophical Transactions"
    " of the Royal Society B 354, 869-875.",
    "Winter, D. A. (2009). Biomechanics and Motor Control of Human Movement, 4th ed.",
)
CARRYING = Foot(-0.06, 0.0, -6.0)
OTHER = replace(CARRYING, x=-CARRYING.x, turn=-CARRYING.turn)
HANGING = Arm(9, 35, 12, 16)
ALONG_FOOT_M = -0.04
"""Position of the weight along a foot that carries it alone, from the ankle."""
HOLD_S = 1.0


def library() -> Library:
    """Compose the library."""
    work = Composer(
        "balance",
        "Balance",
        "Standing on one leg in many ways, on tiptoe, and walking along a beam.",
        SOURCES,
        ("exercise",),
    )
    standing = moment(legs=Foot(0.09, 0.0, 8.0), bend=8, pelvis=Turn(bow=1), waist=Turn(bow=2))
    work.pose("standing", balanced_over(standing), "standing")
    work.pose(
        "standing, arms out",
        balanced_over(replace(standing, arms={"L": _out(70), "R": _out(70)})),
        "standing",
    )
    _on_one_leg(work)
    _wobbling(work)
    _leg_away(work)
    _along_a_beam(work)
    _swaying_step(work)
    _heel_to_toe(work)
    return work.library()


def _out(elevation: float, plane: float = 8.0, elbow: float = 16.0, rotation: float = 0.0) -> Arm:
    """An arm held away for balance, the shoulder lifting with it."""
    girdle = max(elevation - 20.0, 0.0) / 9.0
    return Arm(elevation - girdle, plane, rotation, elbow, 10.0, girdle)


def _one_leg(
    free: AnyLeg,
    left: AnyArm,
    right: AnyArm | None = None,
    *,
    bow: float = 1.0,
    waist: float = 2.0,
    lean: float = 0.0,
    turn: float = 0.0,
    bend: float = 8.0,
    head: float = 0.0,
    pelvis_lean: float | None = None,
) -> Moment:
    """On the right leg; the trunk bows, leans and turns to the left, a third of the lean in the pelvis."""
    return balanced_over(
        moment(
            x=CARRYING.x,
            left_leg=free,
            right_leg=CARRYING,
            left_arm=left,
            right_arm=right or left,
            bend=bend,
            pelvis=Turn(bow=bow, lean=0.33 * lean if pelvis_lean is None else pelvis_lean, turn=0.3 * turn),
            waist=Turn(bow=waist, lean=0.67 * lean, turn=0.7 * turn),
            neck=Turn(bow=head, lean=-0.4 * lean),
        ),
        CARRYING.x,
        ALONG_FOOT_M,
    )


def _and_back(
    work: Composer, name: str, path: Sequence[str], step_s: float = 0.6, start: str = "standing"
) -> None:
    """From standing along a path, held at its end, and back."""
    steps = [(posture, k * step_s) for k, posture in enumerate((start, *path))]
    held = len(path) * step_s + HOLD_S
    back = (*reversed(path[:-1]), start)
    steps += [(path[-1], held), *((posture, held + (k + 1) * step_s) for k, posture in enumerate(back))]
    work.motion(name, steps)


def _on_one_leg(work: Composer) -> None:
    """The other foot just off the floor, the knee high, or the foot at the knee as a stork or a tree."""
    shifted = moment(
        left_leg=replace(OTHER, pitch=16.0), right_leg=CARRYING, arms=_out(34), bend=8, waist=Turn(bow=2)
    )
    work.pose("weight on one leg", balanced_over(shifted, -0.045), "one leg")
    for name, posed in (
        ("foot off the floor", _one_leg(Leg(26, 4, 0, 46, 15), _out(46))),
        ("knee high", _one_leg(Leg(88, 4, 0, 92, 20), _out(82), pelvis_lean=-3)),
        ("knee high, arms down", _one_leg(Leg(84, 4, 0, 90, 20), _out(22, 30), pelvis_lean=-3)),
        ("foot at the knee", _one_leg(Leg(48, 34, 40, 106, 40), _out(88), pelvis_lean=-2)),
        ("foot at the knee, arms up", _one_leg(Leg(48, 36, 42, 108, 40), _out(166, 26, 20), pelvis_lean=-2)),
        ("shin back", _one_leg(Leg(-4, 3, 0, 94, 30), _out(60))),
    ):
        work.pose(name, posed, "one leg")
    tiptoe = moment(
        legs=Foot(0.07, 0.0, 8.0, 36.0), arms=_out(80), bend=8, pelvis=Turn(bow=1), waist=Turn(bow=1)
    )
    work.pose("tiptoe", balanced_over(tiptoe, 0.0, -0.125), "tiptoe")
    lifting = ("weight on one leg", "foot off the floor")
    _and_back(work, "knee high", (*lifting, "knee high"))
    _and_back(work, "knee high, arms down", (*lifting, "knee high, arms down"))
    _and_back(work, "foot at the knee", (*lifting, "foot at the knee"))
    _and_back(work, "tree", (*lifting, "foot at the knee", "foot at the knee, arms up"))
    _and_back(work, "shin back", ("weight on one leg", "foot off the floor", "shin back"))
    _and_back(work, "on tiptoe", ("standing, arms out", "tiptoe"))


def _wobbling(work: Composer) -> None:
    """On one leg the trunk leans from side to side and the arms and the free leg against it."""
    to_left = _one_leg(Leg(24, 2, 0, 44, 15), _out(48), _out(112), lean=16, turn=-6, bend=16, waist=6)
    to_right = _one_leg(Leg(20, 26, 0, 30, 15), _out(116), _out(40), lean=-18, turn=8, bend=18, waist=8)
    forward = _one_leg(
        Leg(-16, 8, 0, 34, 15), _out(80, 40), _out(74, 30), bow=18, waist=20, bend=22, head=-12
    )
    work.pose("wobble: to the left", to_left, "wobble")
    work.pose("wobble: to the right", to_right, "wobble")
    work.pose("wobble: forward", forward, "wobble")
    names = ("wobble: to the left", "foot off the floor", "wobble: to the right", "wobble: forward")
    work.motion("wobble", [(name, 0.42 * k) for k, name in enumerate(names)], 1.68, cyclic=True)


def _leg_away(work: Composer) -> None:
    """The free leg straight to the back, in line with the trunk or not; to the side; to the front."""
    for name, posed in (
        ("leg back: half", _one_leg(Leg(-8, 4, 0, 16, 30), _out(72), bow=34, waist=4, bend=12, head=-14)),
        ("leg back: level", _one_leg(Leg(-6, 2, 0, 6, 35), _out(88, 14), bow=74, waist=4, bend=14, head=-40)),
        (
            "arabesque",
            _one_leg(
                Leg(-34, 6, 12, 8, 40), _out(76, 0, 10), _out(100, 84, 10), bow=34, waist=-16, turn=6, bend=9
            ),
        ),
        ("leg to the side: half", _one_leg(Leg(2, 18, 6, 6, 20), _out(64), lean=-10)),
        (
            "leg to the side",
            _one_leg(Leg(4, 34, 10, 6, 30), _out(106, 16, 46, -40), _out(38), lean=-26, pelvis_lean=-16),
        ),
        ("leg to the front", _one_leg(Leg(52, 2, 4, 8, 25), _out(84), bow=-6, waist=4)),
        (
            "dip: leg beside",
            _one_leg(
                Leg(-4, 34, 4, 12, 20),
                _out(112, 20, 58, -40),
                _out(32),
                bow=22,
                waist=16,
                lean=-26,
                bend=44,
                head=-8,
            ),
        ),
    ):
        work.pose(name, posed, "one leg")
    first = "foot off the floor"
    _and_back(work, "leg back", (first, "leg back: half", "leg back: level"), 0.7)
    _and_back(work, "arabesque", (first, "leg back: half", "arabesque"), 0.7)
    _and_back(work, "leg to the side", ("weight on one leg", "leg to the side: half", "leg to the side"))
    _and_back(work, "leg to the front", (first, "leg to the front"), 0.7)
    _and_back(work, "dip", ("weight on one leg", "leg to the side: half", "dip: leg beside"), 0.5)


@dataclass(frozen=True)
class Swing:
    """A moment of the right foot's way past the left, which stands a step before where it started."""

    name: str
    share: float
    """Time, as a share of the step."""
    foot: Foot
    come: float
    """Position of the weight, in steps from the rear foot."""
    aside: float
    """Offset of the weight to the left of the line [m]."""
    left_arm: Arm
    right_arm: Arm
    lean: float = 0.0
    """Lean of the trunk, to the left [degrees]."""


def _along_a_beam(work: Composer) -> None:
    """Steps of half a meter on a line, the free foot swinging out around the other."""
    off, around, there = (
        Foot(0.0, 0.02, -6.0, 26.0, 0.02),
        Foot(-0.2, -0.4, -8.0, 16.0, 0.1),
        Foot(-0.06, -0.86, -6.0, 4.0, 0.05),
    )
    swings = (
        Swing("both feet", 0.0, Foot(-0.02, 0.0, -5.0, 14.0), 0.5, 0.0, _out(72), _out(72)),
        Swing("toe off", 0.12, off, 0.62, 0.02, _out(66), _out(74), 3),
        Swing("swinging around", 0.38, around, 0.90, 0.05, _out(60), _out(86), 8),
        Swing("reaching", 0.72, there, 1.12, 0.02, _out(70), _out(78), 2),
    )
    _steps(work, "beam walk", 0.50, 0.80, swings)


def _swaying_step(work: Composer) -> None:
    """A step of the beam walk that nearly fails: a leg is thrown out, the trunk and an arm against it."""
    standing = Foot(0.02, -0.5, 5.0)

    def on_left(
        right: AnyLeg, arms: tuple[Arm, Arm], lean: float, bow: float, bend: float, come: float = 1.0
    ) -> Moment:
        weight = -0.5 * come + ALONG_FOOT_M
        posed = moment(
            y=weight,
            left_leg=replace(standing, pitch=28.0 * (come - 1.0)),
            right_leg=right,
            left_arm=arms[0],
            right_arm=arms[1],
            bend=bend,
            pelvis=Turn(bow=0.5 * bow, lean=0.5 * lean, turn=-4),
            waist=Turn(bow=0.5 * bow, lean=0.5 * lean, turn=-4),
            neck=Turn(bow=8, lean=-0.3 * lean),
        )
        return balanced_over(posed, 0.02, weight)

    thrown = Leg(4, 32, 6, 12, 20)
    for name, posed in (
        ("leg thrown out", on_left(thrown, (_out(22, 24), _out(118, 30, 74, -40)), 32, 20, 30)),
        (
            "leg across",
            on_left(
                Foot(0.04, -0.74, 0.0, 10.0, 0.10),
                (_out(26, 30), Arm(84, 66, 30, 88, 20, 8)),
                12,
                16,
                26,
                1.05,
            ),
        ),
        ("caught", on_left(Foot(0.0, -0.98, -5.0), (_out(104, 10, 22), Arm(22, 40, 24, 66)), -6, 8, 16, 1.5)),
    ):
        work.pose(f"swaying step: {name}", posed, "beam", "wobble")
    names = ("leg thrown out", "leg across", "caught")
    steps = [(f"swaying step: {name}", 0.5 + 0.38 * k) for k, name in enumerate(names)]
    begin = [("beam walk: both feet, right foot", 0.0), ("beam walk: toe off, right foot", 0.15)]
    work.motion("swaying step", [*begin, *steps, ("beam walk: both feet, left foot", 1.6)])


def _heel_to_toe(work: Composer) -> None:
    """Steps as long as a foot, slowly, the arms level."""
    off, around, there = (
        Foot(-0.04, -0.02, -4.0, 14.0, 0.04),
        Foot(-0.15, -0.28, -4.0, 4.0, 0.07),
        Foot(-0.05, -0.5, -4.0, -4.0, 0.03),
    )
    swings = (
        Swing("both feet", 0.0, Foot(-0.02, 0.0, -5.0, 14.0), 0.5, 0.0, _out(88), _out(88)),
        Swing("lifting", 0.25, off, 0.85, 0.03, _out(84), _out(90), 4),
        Swing("passing", 0.55, around, 1.0, 0.04, _out(80), _out(96), 6),
        Swing("reaching", 0.82, there, 1.1, 0.02, _out(86), _out(90), 2),
    )
    _steps(work, "heel to toe", 0.27, 1.05, swings)


def _steps(work: Composer, name: str, length_m: float, step_s: float, swings: Sequence[Swing]) -> None:
    """A cycle of two steps along the line x = 0, the first with the right foot."""
    standing = Foot(0.02, -length_m, 5.0)
    steps = []
    for first, side in ((True, "right"), (False, "left")):
        for swing in swings:
            weight = -length_m * swing.come + ALONG_FOOT_M
            posed = moment(
                y=weight,
                left_leg=standing,
                right_leg=swing.foot,
                left_arm=swing.left_arm,
                right_arm=swing.right_arm,
                bend=14,
                pelvis=Turn(bow=2, lean=0.2 * swing.lean),
                waist=Turn(bow=4, lean=0.8 * swing.lean),
                neck=Turn(bow=14),
            )
            posed = balanced_over(posed, swing.aside, weight)
            if not first:
                posed = moved(mirrored(posed), 0.0, -length_m)
            posture = work.pose(f"{name}: {swing.name}, {side} foot", posed, "beam")
            steps.append((posture, (swing.share + (not first)) * step_s))
    work.motion(name, steps, 2.0 * step_s, True, (0.0, -2.0 * length_m, 0.0))
