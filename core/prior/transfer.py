"""Transfer of postures to an actor of other proportions."""

from ..body.actor import Actor
from ..body.body_volume import lower_sole_m
from ..body.kinematics import Body
from ..body.posture import UP, Posture
from ..body.skeleton import SIDES

SAME_M = 1e-6  # lengths that differ by less are equal; files keep fewer digits than memory does


def transferred(posture: Posture, actor: Actor, body: Body) -> Posture:
    """Transfer postures to another body: the same joint angles, location and height scaled.

    Both scale with the length of the legs. Height is that of the lowest sole, so that a foot on the floor
    z = 0 stays on it.

    `actor`: the one it was posed on. The very same object where both have the same proportions.
    """
    if all(abs(body.actor.segments_m[name] - length) < SAME_M for name, length in actor.segments_m.items()):
        return posture
    scale = leg_length_m(body.actor) / leg_length_m(actor)
    moved = posture.translation * scale
    height = scale * lower_sole_m(Body(actor, posture.skeleton), posture)
    placed = Posture(posture.skeleton, moved, posture.rotations, posture.angles)
    lift = height - lower_sole_m(body, placed)
    return Posture(posture.skeleton, moved + lift[..., None] * UP, posture.rotations, posture.angles)


def leg_length_m(actor: Actor) -> float:
    """Mean length of the legs, from hip to ankle [m]."""
    return sum(actor.segments_m[f"{part}.{side}"] for part in ("thigh", "shin") for side in SIDES) / 2.0
