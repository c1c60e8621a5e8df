"""Description of a performer's surroundings: lamps, walls, and things that stand or move."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Triple = tuple[float, float, float]
Array = NDArray[np.float64]
WALL_BEHIND_Y, WALL_RIGHT_X = 1.75, -2.75
"""Where the room's walls stand [m]."""


@dataclass(frozen=True)
class Lamp:
    """A square area light aimed at the performer's chest."""

    place: Triple
    """Its center [m]."""
    size: float
    """Length of an edge [m]; small lamps cast hard shadows."""
    power: float
    """Watts."""
    color: Triple
    """Red, green and blue, linear."""


@dataclass(frozen=True)
class Thing:
    """A box or a ball that is not part of the room."""

    size: Triple
    """Edges [m]; a ball has three equal ones and is `round`."""
    color: Triple
    """Red, green and blue, linear."""
    path: Mapping[float, Triple]
    """Its positions [m] by frame, with even motion between; with a single one it stands still."""
    round: bool = False
    """Whether it is a ball."""

    @property
    def moves(self) -> bool:
        """Whether it moves."""
        return len(self.path) > 1

    def place(self, frame: float) -> Array:
        """(3,) position of its center at a frame [m]."""
        frames, places = np.array(list(self.path)), np.array(list(self.path.values()))
        return np.array([np.interp(frame, frames, places[:, axis]) for axis in range(3)])


@dataclass(frozen=True)
class Room:
    """A performer's surroundings."""

    lamps: tuple[Lamp, ...] = (
        Lamp((-0.6, -4.0, 3.3), 2.4, 215.0, (1.0, 0.96, 0.90)),
        Lamp((3.4, -2.2, 2.6), 1.8, 80.0, (0.92, 0.96, 1.0)),
    )
    """The lamps, the brightest first."""
    sky: tuple[float, float, float, float] = (0.95, 0.97, 1.0, 0.42)
    """Red, green, blue and strength of the light from everywhere."""
    wall: Triple = (0.72, 0.69, 0.63)
    """Color of the walls, linear."""
    planks: tuple[Triple, Triple, Triple] = ((0.36, 0.27, 0.19), (0.31, 0.23, 0.16), (0.2, 0.15, 0.1))
    """Colors of the floor's planks and of the gaps between them, linear."""
    furnished: bool = True
    """Whether the room has wall bars, pictures, a bench and a ball."""
    things: tuple[Thing, ...] = ()
    """Further things, which may move or hide the performer."""
