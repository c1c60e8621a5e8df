"""Validation of a library file's fields: each mistake is an `InputError` of one sentence."""

from collections.abc import Sequence

from ..body.actor import Actor
from ..body.posture_fields import LARGEST_ANGLE_RAD, read_posture
from ..body.skeleton import Skeleton
from ..errors import InputError
from ..files.fields import Fields
from ..files.json_file import shown
from .library import Library, LibraryMotion, LibraryPosture, MotionStep, Travel
from .text_fields import (
    LONGEST_LINE,
    LONGEST_TAG,
    LONGEST_TEXT,
    MOST_TAGS,
    license_expression,
    object_list,
    optional_line,
    text_line,
    text_lines,
)
from .texts import LONGEST_NAME, checked_identifier, name_key

MOST_POSTURES, MOST_MOTIONS, MOST_STEPS = 1000, 100, 10_000
"""Most steps in all motions together."""
MOST_SOURCES = 100
FARTHEST_M = 100.0
SHORTEST_S, LONGEST_S = 0.001, 600.0
"""Bounds of a motion's duration: a shorter cycle would repeat without end between two frames."""
HIGHEST_VERSION = 10**6
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
        title=text_line(fields, "title", LONGEST_NAME),
        version=fields.integer("version", 1, HIGHEST_VERSION),
        author=text_line(fields, "author", LONGEST_LINE),
        license=license_expression(fields),
        actor=_actor(fields),
        postures=postures,
        motions=_motions(fields, {posture.name for posture in postures}),
        description=optional_line(fields, "description", LONGEST_TEXT),
        sources=text_lines(fields, "sources", MOST_SOURCES, LONGEST_TEXT),
        tags=text_lines(fields, "tags", MOST_TAGS, LONGEST_TAG),
    )


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
    for row in object_list(fields, "postures", "postures", 1, MOST_POSTURES):
        row.refuse_others(("name", "tags", "posture"))
        name = text_line(row, "name", LONGEST_NAME)
        values = row.child("posture", "an object of meters and radians by degree of freedom")
        posture = read_posture(values, skeleton, FARTHEST_M, zeros_left_out=True)
        postures.append(LibraryPosture(name, posture, text_lines(row, "tags", MOST_TAGS, LONGEST_TAG)))
    _refuse_alike(fields, "postures", [posture.name for posture in postures])
    return tuple(postures)


def _motions(fields: Fields, known: set[str]) -> tuple[LibraryMotion, ...]:
    if "motions" not in fields.values:
        return ()
    motions: list[LibraryMotion] = []
    left = MOST_STEPS
    for row in object_list(fields, "motions", "motions", 0, MOST_MOTIONS):
        motions.append(_motion(row, known, left))
        left -= len(motions[-1].steps)
    _refuse_alike(fields, "motions", [motion.name for motion in motions])
    return tuple(motions)


def _motion(row: Fields, known: set[str], most_steps: int) -> LibraryMotion:
    row.refuse_others(("name", "cyclic", "duration_s", "travel", "steps"))
    name = text_line(row, "name", LONGEST_NAME)
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
    for step in object_list(row, "steps", f"steps ({MOST_STEPS} in all motions together)", 1, most):
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
