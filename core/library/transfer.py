"""Transfer of postures to an actor of other proportions."""

import numpy as np

from ..body.actor import Actor
from ..body.kinematics import Body
from ..body.posture import Posture
from ..body.skeleton import SIDES
from ..body.soles import lower_sole_m
from .library import LibraryPosture

SAME_M = 1e-6
"""Lengths that differ by less are equal; files keep fewer digits than memory does."""


def transferred(posture: LibraryPosture | Posture, actor: Actor, body: Body) -> Posture:
    """Transfer a posture to another body: the same joint angles, location and height scaled.

    Both scale with the length of the legs. Height is that of the lowest sole, so that a foot on the floor
    z = 0 stays on it.

    Args:
        posture: A posture of a library, or any posture or batch of them.
        actor: The actor it was posed on: the library's.
        body: The body to transfer it to.

    Returns:
        The transferred posture; the very same object where both have the same proportions.
    """
    given = posture.posture if isinstance(posture, LibraryPosture) else posture
    if _same(actor, body.actor):
        return given
    scale = leg_length_m(body.actor) / leg_length_m(actor)
    moved = given.translation * scale
    height = scale * lower_sole_m(Body(actor, given.skeleton), given)
    placed = Posture(given.skeleton, moved, given.rotations, given.angles)
    lift = height - lower_sole_m(body, placed)
    return Posture(
        given.skeleton, moved + lift[..., None] * np.array([0.0, 0.0, 1.0]), given.rotations, given.angles
    )


def leg_length_m(actor: Actor) -> float:
    """Mean length of the legs, from hip to ankle [m]."""
    return sum(actor.segments_m[f"{part}.{side}"] for part in ("thigh", "shin") for side in SIDES) / 2.0


def _same(first: Actor, second: Actor) -> bool:
    return all(abs(first.segments_m[name] - second.segments_m[name]) < SAME_M for name in first.segments_m)
