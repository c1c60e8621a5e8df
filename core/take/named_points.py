"""Named points, and which of them are the principal ones of one person."""

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ..arrays import Array
from ..body.human import HUMAN
from ..detect.layouts import WORDS, named_point
from ..errors import InputError, shown
from ..files.fields import listed

HEADS = (("ear.L", "ear.R"), ("head", "nose"), ("head",), ("nose",))
"""Points whose middle is the head's, the best first: a head alone may be its top."""
POINTS = {*HUMAN.point_names, *(name for head in HEADS for name in head)}
IDLE_WORDS = {"joint", "center", "study", "body", "mediapipe", "marker", "jc"}
MHR_UP = (1, -1)


@dataclass(frozen=True, eq=False)
class PointTable:
    """Named points over F frames."""

    names: tuple[str, ...]
    values: Array  # (F, N, 3) in the file's units; NaN where absent
    rate: float | None = None  # frames a second
    unit_m: float | None = None
    up: tuple[int, int] | None = None  # axis and sign that point up, where the format says


def one_subject(table: PointTable, path: Path, subject: str | None) -> tuple[PointTable, tuple[str, ...]]:
    """The points of one prefix alone, and notes; where some have a prefix, those without are another's."""
    if _missing(table):  # any sign may stand behind prefixes, as in Anna_LKnee
        named = replace(table, names=tuple(map(_with_colon, table.names)))
        if not all(_missing(part) for prefix, part in _by_prefix(named).items() if prefix):
            table = named
    parts = _by_prefix(table)
    if len(parts) == 1 and subject is None:
        return table, ()
    people = {prefix: part for prefix, part in parts.items() if len(_missing(part)) < len(HUMAN.point_names)}
    if not people or (subject is not None and list(people) == [""]):
        if subject is not None:
            raise InputError(f"{path}: has no subject {shown(subject)}; its points have no prefixes")
        return table, ()
    frames = []
    for part in people.values():
        whole = not _missing(part)
        points = principal_points(part, path) if whole else np.full((1, 1, 3), np.nan)
        there = np.isfinite(points).all(axis=(1, 2)) & (points != 0.0).any(axis=2).all(axis=1)
        frames.append(float(whole + there.sum()))
    names = [prefix or "(no prefix)" for prefix in people]
    index, notes = chosen_subject(path, names, frames, subject)
    if subject is None and not any(frames):
        lacking = [
            f"{shown(name)} {listed(_missing(part), 4)}"
            for name, part in zip(names, people.values(), strict=True)
        ]
        raise InputError(
            f"{path}: none of its {len(names)} subjects has all points; missing are those of "
            f"{'; '.join(lacking)}"
        )
    return list(people.values())[index], notes


def _with_colon(name: str) -> str:
    """A name with a colon behind its prefix, where the rest names a point."""
    places = () if ":" in name else (found.start() for found in re.finditer(r"[-_.|/ ]", name))
    ends = (at for at in places if _point_of(name[at + 1 :])[0] in POINTS)
    at = next(ends, None)
    return name if at is None else f"{name[:at]}:{name[at + 1 :]}"


def _alike(prefix: str) -> str:
    """A prefix as all spellings of it have it: Anna B is anna_b."""
    return re.sub(r"[\W_]", "", prefix).casefold()


def _by_prefix(table: PointTable) -> dict[str, PointTable]:
    """The points of each prefix as it is first spelled; an empty one where names have none."""
    columns: dict[str, list[int]] = {}
    spelled: dict[str, str] = {}
    for index, name in enumerate(table.names):
        prefix = name.rpartition(":")[0]
        columns.setdefault(spelled.setdefault(_alike(prefix), prefix), []).append(index)
    return {
        prefix: replace(table, names=tuple(table.names[i] for i in own), values=table.values[:, own])
        for prefix, own in columns.items()
    }


def _missing(table: PointTable) -> list[str]:
    """The principal points that a table does not have."""
    return [point for point, found in _columns(table).items() if not found]


def _columns(table: PointTable) -> dict[str, list[int]]:
    """The columns whose mean is a principal point, by its name; none where it is missing."""
    known: dict[str | None, int] = {}
    for exact in (True, False):  # a name without further words comes first
        for index, name in enumerate(table.names):
            point, idle = _point_of(name)
            if idle != exact:
                known.setdefault(point, index)
    columns = {}
    for point in HUMAN.point_names:
        heads = HEADS[:1] if table.up == MHR_UP else HEADS
        choices: Sequence[Sequence[str]] = heads if point == "head" else ((point,),)
        found: Sequence[str] = next((names for names in choices if all(name in known for name in names)), ())
        columns[point] = [known[name] for name in found]
    return columns


def principal_points(table: PointTable, path: Path) -> Array:
    """(F, 13, 3) the principal points of named ones, in the file's axes and units."""
    missing = _missing(table)
    if missing and table.up == MHR_UP:
        stem, dot, side = missing[0].partition(".")
        names = [f"{'left' if side == 'L' else 'right'}_{stem}"] if dot else ["left_ear", "right_ear"]
        absent = next((name for name in names if name not in table.names), names[0])
        raise InputError(
            f"{path}: has no column {absent}_3DX; a csv of MHR-70's points has columns like nose_3DX, "
            "nose_3DY, nose_3DZ for each point"
        )
    if missing:
        raise InputError(
            f"{path}: has no point for {listed(missing, 4)}; it must have both shoulders, elbows, wrists, "
            "hips, knees and ankles by name, and a head, ears or a nose; its points are "
            f"{listed(table.names, 5)}"
        )
    return np.stack([table.values[:, own].mean(axis=1) for own in _columns(table).values()], axis=1)


def _point_of(name: str) -> tuple[str | None, bool]:
    """The body point of a name without its subject, and whether words were left out."""
    words = WORDS.findall(name.rpartition(":")[2])
    kept = [word for word in words if word.lower() not in IDLE_WORDS]
    return named_point(" ".join(kept)), kept != words


# --- Which of the people in one motion file is meant: one of them whole, never parts of two


def chosen_subject(
    path: Path,
    names: Sequence[str],
    completeness: Sequence[float],
    wanted: str | None,
    kind: str = "subject",
) -> tuple[int, tuple[str, ...]]:
    """The index of the wanted subject, or else of the most complete, the first of equals; and notes.

    Of those with one name the second is NAME 2. `kind` is what they are, and the option of `mend` for it.

    Raises:
        InputError: Nobody is called so; the sentence lists all.
    """
    names = [
        f"{name} {names[:at].count(name) + 1}" if name in names[:at] else name
        for at, name in enumerate(names)
    ]
    every = listed([shown(name) for name in names], 10)
    if wanted is not None:
        found = [index for index, name in enumerate(names) if _alike(name) == _alike(wanted)]
        if not found:
            raise InputError(f"{path}: has no {kind} {shown(wanted)}; its {kind}s are {every}")
        return (names.index(wanted) if wanted in names else found[0]), ()
    index = int(np.argmax(completeness))
    note = (
        f"{path.name} has {len(names)} {kind}s, {every}; the motion is that of {shown(names[index])}, and "
        f"mend --{kind.lower()} names another"
    )
    return index, (note,) if len(names) > 1 else ()
