"""A library's posture on an actor of other proportions."""

import numpy as np

from ..body.actor import Actor
from ..body.kinematics import Body
from ..body.posture import Posture
from ..body.skeleton import SIDES
from ..body.soles import lower_sole_m
from .library import LibraryPosture

SAME_M = 1e-6
"""Lengths that differ by less are the same; files keep fewer digits than memory does."""


def transferred(posture: LibraryPosture | Posture, actor: Actor, body: Body) -> Posture:
    """A posture with the same angles on another body, as high above the floor and as far along it.

    Heights and ways are scaled with the length of the legs. What counts as height is that of the lowest sole,
    so that a foot that stood on the floor z = 0 stands on it again.

    Args:
        posture: A posture of a library, or any posture or batch of them.
        actor: Whom it was posed on: the library's actor.
        body: Whom it shall fit.

    Returns:
        The very same posture where both have the same proportions.
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
