"""A boxer's guard with the left hand leading, and its turns and bends for punches and evasions."""

from .balance import balanced_over
from .moment import AnyArm, Arm, Foot, Hand, Moment, Turn, moment
from .placing import pivoted

LEAD, REAR = Foot(0.11, -0.20, -14.0), Foot(-0.13, 0.24, -52.0, 16.0)
ASIDE = -34.0
"""Turn of a boxer's hips from the opponent, who is straight ahead."""
LEAD_GUARD = Arm(36, 62, 26, 114, 20, 4)
REAR_GUARD = Arm(28, 56, 28, 132, 15, 4)


def boxing(
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
    """A moment of a boxer.

    Args:
        left: The lead arm.
        right: The rear arm.
        turn: Turn of the hips from the guard, to the left [degrees].
        chest: Turn of the chest on the hips, likewise.
        bow: Bow of the trunk beyond the guard's, forward.
        lean: Lean of the trunk, to the left.
        bend: Least flexion of the knees.
        forward: Offset of the weight before the middle of the feet [m].
        aside: Offset of the weight to the left [m].
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


def fist(
    x: float, ahead: float, height: float, swivel: float, pronation: float, girdle: float = 10.0
) -> Hand:
    """A wrist at a position, or as near as it can reach."""
    return Hand(x, -ahead, height, swivel, pronation, girdle, short=0.3)


def rear_pivot(turn: float, pitch: float) -> tuple[Foot, Foot]:
    """The feet with the rear one turned on its ball from its direction in the guard [degrees]."""
    return LEAD, pivoted(REAR, REAR.turn + turn, pitch)


def lead_pivot(turn: float, pitch: float) -> tuple[Foot, Foot]:
    """The feet with the lead one turned on its ball."""
    return pivoted(LEAD, LEAD.turn + turn, pitch), REAR
