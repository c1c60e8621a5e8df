"""Transfer of postures: from an actor into a library, from a library to an actor."""

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


def posture_for_library(body: Body, postures: Posture, actor: Actor, *, on_floor: bool) -> Posture:
    """Postures of one performance, leveled and scaled for a library.

    The first faces -Y above the world's origin; the others keep their poses relative to it.

    Args:
        body: The performer's.
        postures: A batch of F, in the world.
        actor: The library's.
        on_floor: The lowest sole of all touches the floor; else the floor is the world's, z = 0.
    """
    turn = -headings_rad(postures[:1])[0]
    turned = turned_and_shifted(postures, turn, np.zeros(3))
    offset = turned.translation[0] * [-1.0, -1.0, 0.0]
    if on_floor:
        offset[2] = -lower_sole_m(body, turned).min()
    level = turned_and_shifted(turned, np.zeros(1), offset)
    return transferred(level, body.actor, Body(actor))


def posture_for_actor(
    posture: LibraryPosture | Posture, actor: Actor, body: Body, *, mirror: bool
) -> Posture:
    """A library's posture scaled to a body, the floor at z = 0.

    Args:
        posture: The posture.
        actor: The library's.
        body: The body to scale to.
        mirror: Whether left and right are exchanged.
    """
    given = posture.posture if isinstance(posture, LibraryPosture) else posture
    fitting = transferred(given, actor, body)
    return mirrored(fitting) if mirror else fitting


def placed_like(posture: Posture, body: Body, shown: Posture) -> Posture:
    """A posture moved to the location and heading of another, the floor at the other's lower sole.

    Args:
        posture: A single one, the floor at z = 0.
        body: The body of both.
        shown: A single one, in the world.
    """
    both = Posture.stack([posture, shown])
    own, wanted = headings_rad(both)
    turned = turned_and_shifted(both[:1], wanted - own, np.zeros(3))
    offset = shown.translation - turned.translation[0]
    offset[2] = lower_sole_m(body, shown)
    return turned_and_shifted(turned, np.zeros(1), offset)[0]


def named_posture(library: Library, name: str) -> LibraryPosture:
    """The posture of a library with a name.

    Raises:
        InputError: It has none of that name.
    """
    found = library.by_name.get(name)
    if found is None:
        raise InputError(
            "library '{library}' has no posture '{name}'; it has {by_name}",
            library=library.title,
            name=name,
            by_name=_listed(list(library.by_name)),
        )
    return found


def _listed(names: Sequence[str], most: int = 8) -> str:
    more = f" and {len(names) - most} more" if len(names) > most else ""
    return ", ".join(names[:most]) + more
