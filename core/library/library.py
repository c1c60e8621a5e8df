"""A keyframe library: named postures, and the motions that lead through them."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from ..body.actor import Actor
from ..body.posture import Posture
from ..text import pluralize

Travel = tuple[float, float, float]


@dataclass(frozen=True, eq=False)
class LibraryPosture:
    """A posture with a name."""

    name: str
    """Unique within its library."""
    posture: Posture
    """A single posture of the library's actor. The floor is z = 0, and facing -Y is straight ahead; places on
    the floor count within a motion only."""
    tags: tuple[str, ...] = ()


@dataclass(frozen=True)
class MotionStep:
    """A posture's place in a motion."""

    posture: str
    """The posture's name."""
    time_s: float
    """Typical time from the motion's beginning [s]."""


@dataclass(frozen=True)
class LibraryMotion:
    """A usual way through postures of a library, at a typical speed."""

    name: str
    steps: tuple[MotionStep, ...]
    """In order of time; the first is at 0. A posture may come again."""
    duration_s: float
    """Time of the whole motion; where it is cyclic, until the first posture comes again [s]."""
    cyclic: bool = False
    travel: Travel = (0.0, 0.0, 0.0)
    """What a cycle adds to the place: along x and y [m], and to the heading, about Z [rad]."""


@dataclass(frozen=True, eq=False)
class Library:
    """Postures of one kind of motion."""

    identifier: str
    """What it is known by wherever it is copied: lower-case letters, digits, dots, hyphens, underscores."""
    title: str
    version: int
    """Grows with every change that is published."""
    author: str
    license: str
    """SPDX expression, as in `CC0-1.0`."""
    actor: Actor
    """The proportions that the postures were posed on."""
    postures: tuple[LibraryPosture, ...]
    motions: tuple[LibraryMotion, ...] = ()
    description: str = ""
    sources: tuple[str, ...] = ()
    """Literature and whatever else the postures are drawn from."""
    tags: tuple[str, ...] = ()

    @property
    def size(self) -> str:
        """How many postures and motions, in words."""
        return f"{pluralize(len(self.postures), 'posture')}, {pluralize(len(self.motions), 'motion')}"

    @cached_property
    def by_name(self) -> Mapping[str, LibraryPosture]:
        """The postures by name."""
        return {posture.name: posture for posture in self.postures}
