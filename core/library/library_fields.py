"""Validation of a library file's fields: each mistake is an `InputError` of one sentence."""

import re
from collections.abc import Sequence

from ..body.actor import Actor
from ..body.posture_fields import LARGEST_ANGLE_RAD, read_posture
from ..body.skeleton import Skeleton
from ..errors import InputError
from ..files.fields import Fields
from ..files.json_file import shown
from .library import Library, LibraryMotion, LibraryPosture, MotionStep, Travel
from .texts import LONGEST_NAME, checked_identifier, name_key, text_fault

MOST_POSTURES, MOST_MOTIONS, MOST_STEPS = 1000, 100, 10_000
"""Most steps in all motions together."""
MOST_TAGS, MOST_SOURCES = 30, 100
LONGEST_TAG, LONGEST_LICENSE, LONGEST_LINE, LONGEST_TEXT = 40, 100, 200, 2000
FARTHEST_M = 100.0
SHORTEST_S, LONGEST_S = 0.001, 600.0
"""Bounds of a motion's duration: a shorter cycle would repeat without end between two frames."""
HIGHEST_VERSION = 10**6
SPDX = re.compile(r"[A-Za-z0-9.+:() -]+", re.ASCII)
HEADER = (
    *("schema", "schema_version", "identifier", "title", "version", "author", "license", "description"),
    *("tags", "sources", "actor", "motions", "postures"),
)


def read_library_fields(fields: Fields, skeleton: Skeleton) -> Library:
    """Read a library from the fields of its file.

    Raises:
        InputError: A field is missing, unknown or invalid.
    """
    fields.refuse_others(HEADER)
    identifier = fields.required("identifier", "the library's identifier")
    postures = _postures(fields, skeleton)
    return Library(
        identifier=checked_identifier(identifier, f"{fields.where}: identifier"),
        title=_line(fields, "title", LONGEST_NAME),
        version=fields.integer("version", 1, HIGHEST_VERSION),
        author=_line(fields, "author", LONGEST_LINE),
        license=_license(fields),
        actor=_actor(fields),
        postures=postures,
        motions=_motions(fields, {posture.name for posture in postures}),
        description=""
        if fields.values.get("description", "") == ""
        else _line(fields, "description", LONGEST_TEXT),
        sources=_lines(fields, "sources", MOST_SOURCES, LONGEST_TEXT),
        tags=_lines(fields, "tags", MOST_TAGS, LONGEST_TAG),
    )


def _line(fields: Fields, name: str, longest: int) -> str:
    text = fields.required(name, f"a text of at most {longest} characters")
    fault = text_fault(text, longest)
    if fault:
        raise InputError(f"{fields.where}: {name} is {shown(text)}; it {fault}")
    return str(text)


def _lines(fields: Fields, name: str, most: int, longest: int) -> tuple[str, ...]:
    if name not in fields.values:
        return ()
    lines = []
    for index, text in enumerate(_list(fields, name, "texts", 0, most)):
        fault = text_fault(text, longest)
        if fault:
            raise InputError(f"{fields.where}: {name}[{index}] is {shown(text)}; it {fault}")
        lines.append(str(text))
    return tuple(lines)


def _list(fields: Fields, name: str, of_what: str, least: int, most: int) -> list[object]:
    valid = f"a list of {least} to {most} {of_what}" if least else f"a list of at most {most} {of_what}"
    items = fields.required(name, valid)
    if not isinstance(items, list):
        raise InputError(f"{fields.where}: {name} is {shown(items)}; it must be {valid}")
    if not least <= len(items) <= most:
        raise InputError(f"{fields.where}: {name} has {len(items)} of them; it must be {valid}")
    return items


def _rows(fields: Fields, name: str, of_what: str, least: int, most: int) -> list[Fields]:
    items = _list(fields, name, of_what, least, most)
    return [Fields.of(item, f"{fields.where}: {name}[{index}]") for index, item in enumerate(items)]


def _license(fields: Fields) -> str:
    text = _line(fields, "license", LONGEST_LICENSE)
    if not SPDX.fullmatch(text):
        raise InputError(
            f"{fields.where}: license is {shown(text)}; it must be an SPDX expression such as CC0-1.0, "
            "CC-BY-4.0 or LicenseRef-Proprietary"
        )
    return text


def _actor(fields: Fields) -> Actor:
    actor = fields.child("actor", "an object with segments_m")
    actor.refuse_others(("segments_m",))
    lengths = actor.child("segments_m", "an object of lengths in meters").values
    try:
        return Actor(lengths)
    except InputError as error:
        raise InputError(f"{fields.where}: {error}") from error


def _postures(fields: Fields, skeleton: Skeleton) -> tuple[LibraryPosture, ...]:
    postures = []
    for row in _rows(fields, "postures", "postures", 1, MOST_POSTURES):
        row.refuse_others(("name", "tags", "posture"))
        name = _line(row, "name", LONGEST_NAME)
        values = row.child("posture", "an object of meters and radians by degree of freedom")
        posture = read_posture(values, skeleton, FARTHEST_M, zeros_left_out=True)
        postures.append(LibraryPosture(name, posture, _lines(row, "tags", MOST_TAGS, LONGEST_TAG)))
    _refuse_alike(fields, "postures", [posture.name for posture in postures])
    return tuple(postures)


def _motions(fields: Fields, known: set[str]) -> tuple[LibraryMotion, ...]:
    if "motions" not in fields.values:
        return ()
    motions: list[LibraryMotion] = []
    left = MOST_STEPS
    for row in _rows(fields, "motions", "motions", 0, MOST_MOTIONS):
        motions.append(_motion(row, known, left))
        left -= len(motions[-1].steps)
    _refuse_alike(fields, "motions", [motion.name for motion in motions])
    return tuple(motions)


def _motion(row: Fields, known: set[str], most_steps: int) -> LibraryMotion:
    row.refuse_others(("name", "cyclic", "duration_s", "travel", "steps"))
    name = _line(row, "name", LONGEST_NAME)
    cyclic = row.required("cyclic", "true or false")
    if not isinstance(cyclic, bool):
        raise InputError(f"{row.where}: cyclic is {shown(cyclic)}; it must be true or false")
    duration_s = row.number("duration_s", SHORTEST_S, LONGEST_S, "s")
    steps = _steps(row, known, most_steps)
    last_s = steps[-1].time_s
    if duration_s < last_s or duration_s <= (last_s if cyclic else 0.0):
        valid = "later than the last step's time" if cyclic else "above 0 and no earlier than the last step"
        raise InputError(
            f"{row.where}: duration_s is {duration_s:g} and the last step's time_s {last_s:g}; "
            f"the motion must end {valid}"
        )
    return LibraryMotion(name, steps, duration_s, cyclic, _travel(row, cyclic))


def _steps(row: Fields, known: set[str], most: int) -> tuple[MotionStep, ...]:
    steps: list[MotionStep] = []
    for step in _rows(row, "steps", f"steps ({MOST_STEPS} in all motions together)", 1, most):
        step.refuse_others(("time_s", "posture"))
        time_s = step.number("time_s", 0.0, LONGEST_S, "s")
        if steps and time_s <= steps[-1].time_s:
            raise InputError(
                f"{step.where}: time_s is {time_s:g}; it must be later than that of the step before, "
                f"{steps[-1].time_s:g}"
            )
        if not steps and time_s != 0.0:
            raise InputError(f"{step.where}: time_s is {time_s:g}; a motion's first step must be at 0")
        posture = step.text("posture", "the name of one of the library's postures")
        if posture not in known:
            raise InputError(
                f"{step.where}: posture is {shown(posture)}; the library has no posture so named"
            )
        steps.append(MotionStep(posture, time_s))
    return tuple(steps)


def _travel(row: Fields, cyclic: bool) -> Travel:
    if "travel" not in row.values:
        return (0.0, 0.0, 0.0)
    travel = row.child("travel", "an object with x_m, y_m and heading_rad")
    travel.refuse_others(("x_m", "y_m", "heading_rad"))
    if not cyclic:
        raise InputError(f"{row.where}: travel is what a cycle adds; a motion that is not cyclic has none")
    return (
        travel.number("x_m", -FARTHEST_M, FARTHEST_M, "m"),
        travel.number("y_m", -FARTHEST_M, FARTHEST_M, "m"),
        travel.number("heading_rad", -LARGEST_ANGLE_RAD, LARGEST_ANGLE_RAD, "rad"),
    )


def _refuse_alike(fields: Fields, what: str, names: Sequence[str]) -> None:
    """Refuse names that people, or file systems, cannot tell apart."""
    seen: dict[str, str] = {}
    for name in names:
        key = name_key(name)
        if key in seen:
            raise InputError(
                f"{fields.where}: {what} has the names {shown(seen[key])} and {shown(name)}, which cannot be "
                "told apart; each needs a name of its own"
            )
        seen[key] = name
