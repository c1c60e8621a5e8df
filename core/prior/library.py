"""A keyframe library: named postures, and motions as timed sequences of them, as its file holds it.

`docs/library_format.md` describes the fields.
"""

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Annotated, Any

from ..body.actor import Actor
from ..body.body_volume import lower_sole_m
from ..body.human import HUMAN
from ..body.kinematics import Body
from ..body.posture import LARGEST_ANGLE_RAD, UP, Posture, PostureValues
from ..body.skeleton import SIDES
from ..errors import pluralize, shown
from ..files.digest import digest
from ..files.json_file import read_json, write_readable_json
from ..files.kinds import Items, Kind, Number, Text, Whole
from ..files.records import Object, Record
from .texts import IDENTIFIER, LONGEST_LINE, LONGEST_NAME, LONGEST_TEXT, SPDX, Tags, line, name_key

MOST_POSTURES, MOST_MOTIONS, MOST_STEPS = 1000, 100, 10_000  # steps: of all motions together
MOST_SOURCES = 100
FARTHEST_M = 100.0
SHORTEST_S, LONGEST_S = 0.001, 600.0  # of a motion: a shorter cycle would repeat without end
HIGHEST_VERSION = 10**6
DECIMALS = 9  # nanometers and nanoradians: Blender's single precision survives

Travel = tuple[float, float, float]
Name = Annotated[str, line(LONGEST_NAME)]


class ActorFields(Object):
    """An actor, whose lengths are written to the nanometer."""

    def write(self, value: Any) -> dict[str, Any]:
        """See `Kind`."""
        return {"segments_m": {name: round(m, DECIMALS) + 0.0 for name, m in value.segments_m.items()}}


@dataclass(frozen=True)
class TravelFields(Record):
    """Displacement and turn of a cycle, as files have them."""

    STRICT = True

    x_m: Annotated[float, Number(-FARTHEST_M, FARTHEST_M, "m", DECIMALS)]
    """Distance [m]."""
    y_m: Annotated[float, Number(-FARTHEST_M, FARTHEST_M, "m", DECIMALS)]
    """Distance [m]."""
    heading_rad: Annotated[float, Number(-LARGEST_ANGLE_RAD, LARGEST_ANGLE_RAD, "rad", DECIMALS)]
    """Angle [rad]."""


class TravelKind(Kind):
    """A cycle's displacement and turn; null for none."""

    like = Object(TravelFields)
    valid = "an object with x_m, y_m and heading_rad"

    def read(self, value: Any, where: str, name: str) -> Travel:
        """See `Kind`."""
        travel = self.like.read(value, where, name)
        return (travel.x_m, travel.y_m, travel.heading_rad)

    def write(self, value: Travel) -> dict[str, Any] | None:
        """See `Kind`."""
        written = TravelFields(*value).to_json()
        return written if any(written.values()) else None


@dataclass(frozen=True, eq=False)
class LibraryPosture(Record):
    """A named posture."""

    STRICT = True
    ORDER = ("name", "tags", "posture")

    name: Name
    """Unique within its library."""
    posture: Annotated[Posture, PostureValues(HUMAN, FARTHEST_M, True, DECIMALS)]
    """A single posture of the library's actor. The floor is z = 0, and facing -Y is straight ahead;
    positions on the floor count within a motion only."""
    tags: Tags = ()
    """Words to find it by."""


@dataclass(frozen=True)
class MotionStep(Record):
    """A step of a motion: a posture and its time."""

    STRICT = True
    ORDER = ("time_s", "posture")

    posture: Annotated[str, Text(LONGEST_NAME, "the name of one of the library's postures")]
    """The posture's name."""
    time_s: Annotated[float, Number(0.0, LONGEST_S, "s", DECIMALS)]
    """Typical time from the motion's beginning [s]."""


@dataclass(frozen=True)
class LibraryMotion(Record):
    """A typical sequence of a library's postures, at a typical speed."""

    STRICT = True
    ORDER = ("name", "cyclic", "duration_s", "travel", "steps")
    REQUIRED = ("cyclic",)

    name: Name
    """Unique within its library."""
    steps: Annotated[
        tuple[MotionStep, ...], Items(f"steps ({MOST_STEPS} in all motions together)", 1, MOST_STEPS)
    ]
    """In order of time; the first is at 0. A posture may occur several times."""
    duration_s: Annotated[float, Number(SHORTEST_S, LONGEST_S, "s", DECIMALS)]
    """Duration of the whole motion, of a cyclic one its period [s]."""
    cyclic: bool = False
    """Whether the motion repeats after `duration_s`."""
    travel: Annotated[Travel, TravelKind()] = (0.0, 0.0, 0.0)
    """Displacement of a cycle along x and y [m], and its turn about Z [rad]."""

    def mistake(self) -> str:
        """See `Record`."""
        before_s = -1.0
        for index, step in enumerate(self.steps):
            if index == 0 and step.time_s != 0.0:
                return f"steps[0]: time_s is {step.time_s:g}; a motion's first step must be at 0"
            if step.time_s <= before_s:
                return (
                    f"steps[{index}]: time_s is {step.time_s:g}; it must be later than that of the step "
                    f"before, {before_s:g}"
                )
            before_s = step.time_s
        if self.duration_s < before_s or (self.cyclic and self.duration_s == before_s):
            valid = "later than the last step's time" if self.cyclic else "no earlier than the last step"
            return (
                f"duration_s is {self.duration_s:g} and the last step's time_s {before_s:g}; the motion must "
                f"end {valid}"
            )
        if any(self.travel) and not self.cyclic:
            return "travel is what a cycle adds; a motion that is not cyclic has none"
        return ""


@dataclass(frozen=True, eq=False)
class Library(Record):
    """Postures of one kind of motion."""

    STRICT = True
    SCHEMA, VERSION, TITLE = "keymark-library", 1, "keyframe library"
    ORDER = (
        *("identifier", "title", "version", "author", "license", "description", "tags", "sources"),
        *("actor", "motions", "postures"),
    )

    identifier: Annotated[str, IDENTIFIER]
    """The same in every copy: lower-case letters, digits, dots, hyphens, underscores."""
    title: Name
    """Title for people."""
    version: Annotated[int, Whole(1, HIGHEST_VERSION)]
    """Raised with every published change."""
    author: Annotated[str, line(LONGEST_LINE)]
    """Who made it."""
    license: Annotated[str, SPDX]
    """SPDX expression such as `CC0-1.0`."""
    actor: Annotated[Actor, ActorFields(Actor, strict=True)]
    """The proportions of the postures' performer."""
    postures: Annotated[tuple[LibraryPosture, ...], Items("postures", 1, MOST_POSTURES)]
    """Postures in the order shown to people."""
    motions: Annotated[tuple[LibraryMotion, ...], Items("motions", 0, MOST_MOTIONS)] = ()
    """Motions through them."""
    description: Annotated[str, line(LONGEST_TEXT, empty=True)] = ""
    """What it is for."""
    sources: Annotated[tuple[Annotated[str, line(LONGEST_TEXT)], ...], Items("texts", 0, MOST_SOURCES)] = ()
    """Literature and other sources of the postures."""
    tags: Tags = ()
    """Words to find it by."""

    def mistake(self) -> str:
        """See `Record`."""
        alike = _alike("postures", (posture.name for posture in self.postures))
        alike = alike or _alike("motions", (motion.name for motion in self.motions))
        if alike:
            return alike
        if sum(len(motion.steps) for motion in self.motions) > MOST_STEPS:
            return f"motions have too many steps; at most {MOST_STEPS} in all together are read"
        for number, motion in enumerate(self.motions):
            for index, step in enumerate(motion.steps):
                if step.posture not in self.by_name:
                    return (
                        f"motions[{number}].steps[{index}]: posture is {shown(step.posture)}; the "
                        "library has no posture so named"
                    )
        return ""

    @property
    def size(self) -> str:
        """Numbers of postures and motions, in words."""
        return f"{pluralize(len(self.postures), 'posture')}, {pluralize(len(self.motions), 'motion')}"

    @cached_property
    def by_name(self) -> Mapping[str, LibraryPosture]:
        """The postures by name."""
        return {posture.name: posture for posture in self.postures}


def _alike(what: str, names: Iterable[str]) -> str:
    """Names that people, or file systems, cannot tell apart, as a clause; empty where there are none."""
    seen: dict[str, str] = {}
    for name in names:
        key = name_key(name)
        if key in seen:
            return (
                f"{what} has the names {shown(seen[key])} and {shown(name)}, which cannot be told apart; "
                "each needs a name of its own"
            )
        seen[key] = name
    return ""


# --- Library files


LARGEST_BYTES = 4 * 2**20


def read_library(path: Path) -> Library:
    """Read a library file.

    Raises:
        InputError: The file is missing, no library, or invalid.
    """
    return Library.from_json(read_json(path, LARGEST_BYTES), str(path))


def write_library(path: Path, library: Library) -> None:
    """Write a library file, whole or not at all.

    Raises:
        InputError: The library is invalid and could not be read back.
        ConversionError: The file cannot be written.
    """
    value = library.to_json()
    Library.from_json(value, f"library {shown(library.identifier)}")
    write_readable_json(path, value)


def library_digest(library: Library) -> str:
    """Digest of a library's content, whatever the path and the layout of its file."""
    return digest(json.dumps(library.to_json(), sort_keys=True))


# --- Postures on an actor of other proportions


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
