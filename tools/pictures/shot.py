"""What a photograph in the studio shows, of good or of bad filming."""

from dataclasses import dataclass

from keymark.core.arrays import Array
from keymark.core.footage.camera import Camera
from studio.described import Described


@dataclass(frozen=True, eq=False)
class Shot:
    """One photograph of a take."""

    take: Described
    """Who is filmed, how, and in what room; `samples` and `moments` are those of the photograph."""
    frame: int
    """Frame of the take."""
    words: str
    """What there is to see, in a few words."""
    passing: tuple[tuple[Described, int, tuple[float, float]], ...] = ()
    """Further performers: theirs is the first take's room; the frame of each, and by how far they stand
    elsewhere, in x and y [m]."""
    shaken: tuple[Camera, ...] = ()
    """Where else the camera is during the exposure, if it is not held still."""
    lines: tuple[Array, ...] = ()
    """Lines (N, 3) of the room [m] that are drawn over the photograph."""
