"""Waving with one hand or both, beckoning, hailing and halting, turned to somebody or away.

Where one hand waves it is the right; mirrored it is the left.
"""

from keymark.core.prior.library import Library

from ..balance import BEFORE_ANKLE_M, balanced_over
from ..composing import Composer
from ..moment import AnyArm, Arm, Foot, Moment, Turn, moment

SOURCES = (
    "Nishihara, K., Kawarazaki, N., Yoshidome, T. & Gao, Q. (2004). Study on recognition of hand waving."
    " Journal of Robotics and Mechatronics 16, 17-22.",
    "Armstrong, N. & Wagner, M. (2003). Field Guide to Gestures.",
    "Flash, T. & Hogan, N. (1985). The coordination of arm movements: an experimentally confirmed"
    " mathematical model. Journal of Neuroscience 5, 1688-1703.",
    "Inman, V. T., Saunders, J. B. & Abbott, L. C. (1944). Observations on the function of the shoulder"
    " joint. Journal of Bone and Joint Surgery 26.",
    "Winter, D. A. (2009). Biomechanics and Motor Control of Human Movement, 4th ed.",
)
FEET = (Foot(0.11, 0.0, 9.0), Foot(-0.11, 0.0, -9.0))
HANGING = Arm(9, 35, 12, 16)
RAISING_S = 0.5
Waves = tuple[str, str]


def library() -> Library:
    """Compose the library."""
    work = Composer(
        "waving",
        "Waving",
        "A hand or both wave, beckon or hail, in standing, at ease or turned away.",
        SOURCES,
        ("gesture", "everyday"),
    )
    work.pose("standing", _standing(HANGING), "standing")
    work.pose("standing at ease", _standing(HANGING, ease=1.0), "standing")
    _one_hand(work)
    _both_hands(work)
    _beckoning_and_hailing(work)
    _turned_away(work)
    return work.library()


def _standing(
    right: AnyArm,
    left: AnyArm = HANGING,
    *,
    lean: float = 0.0,
    turn: float = 0.0,
    head: float = 0.0,
    ease: float = 0.0,
) -> Moment:
    """Standing with the trunk leaning and turned to the left, and the head too.

    `ease` is 0 with weight on both legs and 1 with weight on the left alone.
    """
    return balanced_over(
        moment(
            left_leg=FEET[0],
            right_leg=Foot(-0.11 - 0.04 * ease, -0.06 * ease, -9.0 - 8.0 * ease, 0.0),
            left_arm=left,
            right_arm=right,
            bend=8.0,
            pelvis=Turn(bow=1.0, lean=-2.0 * ease, turn=0.3 * turn),
            waist=Turn(bow=2.0, lean=lean + 2.0 * ease, turn=0.7 * turn),
            neck=Turn(bow=-1.0, lean=-0.4 * lean, turn=head - turn),
        ),
        0.07 * ease,
        -BEFORE_ANKLE_M - 0.01 * ease,
    )


def _wave(
    work: Composer, name: str, raised: str, waves: Waves, period_s: float, at_rest: str = "standing"
) -> None:
    """A motion of waving alone, endless, and one that raises the hand, waves twice and lets it sink."""
    there, back = waves
    half = 0.5 * period_s
    work.motion(name, [(there, 0.0), (back, half)], period_s, cyclic=True)
    steps = [(at_rest, 0.0), (raised, RAISING_S)]
    begin = RAISING_S + 0.35
    steps += [(waves[k % 2], begin + k * half) for k in range(5)]
    end = begin + 4 * half
    work.motion(f"{name}, from standing", [*steps, (raised, end + 0.4), (at_rest, end + 1.0)])


def _one_hand(work: Composer) -> None:
    """Beside the head the forearm swings like a pendulum upside down; above it the whole arm does."""
    for name, posed in (
        ("hand rising", _standing(Arm(36, 40, 0, 84, 20, 2))),
        ("low: inward", _standing(Arm(22, 28, -24, 124, 10))),
        ("low: outward", _standing(Arm(24, 24, -62, 112, 10))),
        ("high: inward", _standing(Arm(80, 26, -58, 108, 20, 8), lean=2)),
        ("high: outward", _standing(Arm(80, 18, -66, 60, 20, 8), lean=3)),
        ("above the head: rising", _standing(Arm(96, 42, -40, 76, 20, 10), lean=2)),
        ("above the head: inward", _standing(Arm(140, 36, -46, 50, 20, 18), lean=4)),
        ("above the head: outward", _standing(Arm(128, 20, -60, 18, 20, 16), lean=5)),
        ("hand rising, at ease", _standing(Arm(38, 52, 4, 88, 20, 2), ease=1.0, head=-8)),
        ("high: inward, at ease", _standing(Arm(72, 44, -40, 112, 20, 8), ease=1.0, head=-14)),
        ("high: outward, at ease", _standing(Arm(74, 34, -52, 70, 20, 8), ease=1.0, head=-14)),
    ):
        work.pose(name, posed, "one hand")
    _wave(work, "low wave", "hand rising", ("low: inward", "low: outward"), 0.5)
    _wave(work, "high wave", "hand rising", ("high: inward", "high: outward"), 0.56)
    _wave(
        work,
        "wave above the head",
        "above the head: rising",
        ("above the head: inward", "above the head: outward"),
        0.8,
    )
    _wave(
        work,
        "high wave at ease",
        "hand rising, at ease",
        ("high: inward, at ease", "high: outward, at ease"),
        0.6,
        "standing at ease",
    )


def _both_hands(work: Composer) -> None:
    """Forearms beside the head, and long arms crossing and parting above it to be seen from afar."""
    for name, arms in (
        ("both hands: rising", Arm(70, 30, -40, 74, 20, 6)),
        ("both hands: inward", Arm(82, 24, -60, 108, 20, 8)),
        ("both hands: outward", Arm(82, 16, -68, 58, 20, 8)),
        ("both arms: together", Arm(152, 36, -46, 26, 20, 20)),
        ("both arms: apart", Arm(112, 12, -60, 12, 20, 12)),
    ):
        work.pose(name, _standing(arms, arms), "both hands")
    rising = "both hands: rising"
    _wave(work, "wave with both hands", rising, ("both hands: inward", "both hands: outward"), 0.56)
    _wave(work, "wave with both arms", rising, ("both arms: together", "both arms: apart"), 1.0)


def _beckoning_and_hailing(work: Composer) -> None:
    """The forearm draws somebody near; a stretched arm calls or halts."""
    for name, posed in (
        ("beckoning: away", _standing(Arm(58, 66, 14, 40, 60, 4), turn=4)),
        ("beckoning: near", _standing(Arm(52, 58, 6, 126, 30, 4), turn=-2)),
        ("arm straight up", _standing(Arm(158, 50, 10, 8, 20, 20), lean=4)),
        ("hand held out", _standing(Arm(84, 74, 16, 12, 70, 6), turn=6)),
    ):
        work.pose(name, posed, "one hand")
    _wave(work, "beckoning", "hand rising", ("beckoning: away", "beckoning: near"), 0.8)
    for name, top, rising in (
        ("hailing", "arm straight up", "above the head: rising"),
        ("halting", "hand held out", "hand rising"),
    ):
        steps = [("standing", 0.0), (rising, 0.4), (top, 0.8), (top, 1.6), (rising, 2.0), ("standing", 2.5)]
        work.motion(name, steps)


def _turned_away(work: Composer) -> None:
    """Looking over the right shoulder toward the person waved to."""
    for name, right, turn in (
        ("turned: standing", HANGING, 8.0),
        ("turned: hand rising", Arm(44, 12, -30, 84, 20, 2), -4.0),
        ("turned: inward", Arm(80, 0, -80, 106, 20, 8), -10.0),
        ("turned: outward", Arm(82, -6, -84, 60, 20, 8), -12.0),
    ):
        work.pose(name, _standing(right, turn=turn, head=-52 if "standing" not in name else -12), "turned")
    _wave(
        work,
        "wave turned away",
        "turned: hand rising",
        ("turned: inward", "turned: outward"),
        0.56,
        "turned: standing",
    )
