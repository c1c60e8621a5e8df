"""A keyframe library: named postures, and motions as timed sequences of them."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from ..body.actor import Actor
from ..body.posture import Posture
from ..text import pluralize

Travel = tuple[float, float, float]


@dataclass(frozen=True, eq=False)
class LibraryPosture:
    """A named posture."""

    name: str
    """Unique within its library."""
    posture: Posture
    """A single posture of the library's actor. The floor is z = 0, and facing -Y is straight ahead;
    positions on the floor count within a motion only."""
    tags: tuple[str, ...] = ()


@dataclass(frozen=True)
class MotionStep:
    """A step of a motion: a posture and its time."""

    posture: str
    """The posture's name."""
    time_s: float
    """Typical time from the motion's beginning [s]."""


@dataclass(frozen=True)
class LibraryMotion:
    """A typical sequence of a library's postures, at a typical speed."""

    name: str
    steps: tuple[MotionStep, ...]
    """In order of time; the first is at 0. A posture may occur several times."""
    duration_s: float
    """Duration of the whole motion, of a cyclic one its period [s]."""
    cyclic: bool = False
    travel: Travel = (0.0, 0.0, 0.0)
    """Displacement of a cycle along x and y [m], and its turn about Z [rad]."""


@dataclass(frozen=True, eq=False)
class Library:
    """Postures of one kind of motion."""

    identifier: str
    """The same in every copy: lower-case letters, digits, dots, hyphens, underscores."""
    title: str
    version: int
    """Raised with every published change."""
    author: str
    license: str
    """SPDX expression such as `CC0-1.0`."""
    actor: Actor
    """The proportions of the postures' performer."""
    postures: tuple[LibraryPosture, ...]
    motions: tuple[LibraryMotion, ...] = ()
    description: str = ""
    sources: tuple[str, ...] = ()
    """Literature and other sources of the postures."""
    tags: tuple[str, ...] = ()

    @property
    def size(self) -> str:
        """Numbers of postures and motions, in words."""
        return f"{pluralize(len(self.postures), 'posture')}, {pluralize(len(self.motions), 'motion')}"

    @cached_property
    def by_name(self) -> Mapping[str, LibraryPosture]:
        """The postures by name."""
        return {posture.name: posture for posture in self.postures}
