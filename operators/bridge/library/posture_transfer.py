"""An actor's pose as a library keeps it, and a library's posture where an actor stands."""

from collections.abc import Sequence

import numpy as np

from ....core.body.actor import Actor
from ....core.body.heading import headings_rad, turned_and_shifted
from ....core.body.kinematics import Body
from ....core.body.mirror import mirrored
from ....core.body.posture import Posture
from ....core.body.soles import lower_sole_m
from ....core.errors import InputError
from ....core.library.library import Library, LibraryPosture
from ....core.library.transfer import transferred


def as_kept(body: Body, postures: Posture, actor: Actor, *, on_floor: bool) -> Posture:
    """Postures of one performance as a library of an actor keeps them.

    The first faces -Y above the world's origin, the others lie to it as they did.

    Args:
        body: Whose postures they are.
        postures: A batch of F, in the world.
        actor: The library's.
        on_floor: The lowest sole of all stands on the floor; else the floor is the world's, z = 0.
    """
    turn = -headings_rad(postures[:1])[0]
    turned = turned_and_shifted(postures, turn, np.zeros(3))
    place = turned.translation[0] * [-1.0, -1.0, 0.0]
    if on_floor:
        place[2] = -lower_sole_m(body, turned).min()
    level = turned_and_shifted(turned, np.zeros(1), place)
    return transferred(level, body.actor, Body(actor))


def on_actor(posture: LibraryPosture | Posture, actor: Actor, body: Body, *, mirror: bool) -> Posture:
    """A library's posture with a body's proportions, the floor at z = 0.

    Args:
        posture: The posture.
        actor: The library's.
        body: Whom it shall fit.
        mirror: With left and right exchanged.
    """
    given = posture.posture if isinstance(posture, LibraryPosture) else posture
    fitting = transferred(given, actor, body)
    return mirrored(fitting) if mirror else fitting


def standing_as(posture: Posture, body: Body, shown: Posture) -> Posture:
    """A posture with the place and the heading of another, the floor where the other's lower sole is.

    Args:
        posture: A single one, the floor at z = 0.
        body: Whose postures both are.
        shown: A single one, in the world.
    """
    both = Posture.stack([posture, shown])
    own, wanted = headings_rad(both)
    turned = turned_and_shifted(both[:1], wanted - own, np.zeros(3))
    place = shown.translation - turned.translation[0]
    place[2] = lower_sole_m(body, shown)
    return turned_and_shifted(turned, np.zeros(1), place)[0]


def named_posture(library: Library, name: str) -> LibraryPosture:
    """A library's posture.

    Raises:
        InputError: It has none of that name.
    """
    found = library.by_name.get(name)
    if found is None:
        raise InputError(
            f"library '{library.title}' has no posture '{name}'; it has {_some(list(library.by_name))}"
        )
    return found


def _some(names: Sequence[str], most: int = 8) -> str:
    more = f" and {len(names) - most} more" if len(names) > most else ""
    return ", ".join(names[:most]) + more
