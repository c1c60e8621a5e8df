"""Merging and joining libraries; a conflict is never resolved silently.

Names are equal where people could not tell them apart.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, TypeVar

from ..body.kinematics import Body
from ..errors import InputError, shown
from ..files.fields import listed
from .library import Library, LibraryMotion, LibraryPosture, MotionStep
from .texts import checked_identifier, name_key, unique_name
from .transfer import transferred

Entry = TypeVar("Entry", bound=LibraryPosture | LibraryMotion)


def differing_names(mine: Library, theirs: Library) -> tuple[str, ...]:
    """Names of the postures and motions that two versions of a library both have and that differ.

    Raises:
        InputError: The libraries have different identifiers.
    """
    if mine.identifier != theirs.identifier:
        raise InputError(
            f"libraries {shown(mine.identifier)} and {shown(theirs.identifier)} have different identifiers "
            "and cannot be merged; join them to a new library instead"
        )
    offered = _rows(theirs)
    return tuple(
        name for key, (name, row) in _rows(mine).items() if key in offered and offered[key][1] != row
    )


def merge_versions(mine: Library, theirs: Library, replaces: bool | None = None) -> Library:
    """Merge two versions of a library: theirs is fitted to my actor's proportions and added to mine.

    The header is that of the higher version. The result's version is one above both, unless it equals one
    of them.

    `replaces`: whether theirs replaces what is in both and differs; None where nothing does.

    Raises:
        InputError: Some differ and nothing says which counts, or the libraries have different identifiers.
    """
    fitted = _fitted(theirs, mine)
    differing = differing_names(mine, fitted)
    if differing and replaces is None:
        raise InputError(
            f"library {shown(mine.identifier)}: {listed(map(shown, differing), 5)} differ between version "
            f"{mine.version} and version {theirs.version}; choose which to keep"
        )
    postures = _united(mine.postures, fitted.postures, bool(replaces))
    motions = _united(mine.motions, fitted.motions, bool(replaces))
    spelled = {name_key(posture.name): posture.name for posture in postures}
    head = fitted if theirs.version > mine.version else mine
    whole = replace(
        head, actor=mine.actor, postures=tuple(postures), motions=tuple(_respelled(motions, spelled))
    )
    for one in (mine, theirs):
        if replace(whole, version=one.version).to_json() == one.to_json():
            return one
    return replace(whole, version=max(mine.version, theirs.version) + 1)


def join_libraries(first: Library, second: Library, identifier: str, title: str) -> Library:
    """Join two libraries to a new one with the content of both, on the proportions of the first.

    Different postures or motions of the same name get a number. Authors, licenses, sources and tags of both
    are listed.

    Raises:
        InputError: The identifier is invalid.
    """
    fitted = _fitted(second, first)
    rows, others = _rows(first), _rows(fitted)
    names: dict[str, str] = {}
    postures, motions = list(first.postures), list(first.motions)
    for posture in fitted.postures:
        key = ("posture", name_key(posture.name))
        if key in rows and rows[key][1] == others[key][1]:
            names[name_key(posture.name)] = rows[key][0]
            continue
        taken = [entry.name for entry in (*postures, *fitted.postures) if entry is not posture]
        name = unique_name(posture.name, taken)
        names[name_key(posture.name)] = name
        postures.append(replace(posture, name=name))
    for motion in _respelled(fitted.motions, names):
        if not any(replace(old, name="") == replace(motion, name="") for old in first.motions):
            motions.append(replace(motion, name=unique_name(motion.name, [entry.name for entry in motions])))
    return Library(
        identifier=checked_identifier(identifier, "the identifier of the new library"),
        title=title,
        version=1,
        author=", ".join(_union([first.author], [second.author])),
        license=_both_licenses(first.license, second.license),
        actor=first.actor,
        postures=tuple(postures),
        motions=tuple(motions),
        description=" ".join(_union([first.description], [second.description])).strip(),
        sources=_union(first.sources, second.sources),
        tags=_union(first.tags, second.tags),
    )


def _both_licenses(first: str, second: str) -> str:
    if first == second:
        return first
    return " AND ".join(f"({license_})" if " " in license_ else license_ for license_ in (first, second))


def _fitted(library: Library, other: Library) -> Library:
    body = Body(other.actor)
    postures = tuple(
        replace(entry, posture=transferred(entry, library.actor, body)) for entry in library.postures
    )
    return replace(library, actor=other.actor, postures=postures)


def _rows(library: Library) -> dict[tuple[str, str], tuple[str, Any]]:
    """Name and JSON content of every posture and motion, by kind and `name_key`."""
    value = library.to_json()
    rows: dict[tuple[str, str], tuple[str, Any]] = {}
    for kind in ("posture", "motion"):
        for row in value.get(f"{kind}s", []):
            rows[kind, name_key(row["name"])] = (row["name"], row)
    return rows


def _united(mine: Sequence[Entry], theirs: Sequence[Entry], replaces: bool) -> list[Entry]:
    """The union: mine in their order, then those in theirs alone."""
    offered = {name_key(entry.name): entry for entry in theirs}
    kept = [offered.get(name_key(own.name), own) if replaces else own for own in mine]
    there = {name_key(own.name) for own in mine}
    return [*kept, *(entry for entry in theirs if name_key(entry.name) not in there)]


def _respelled(motions: Sequence[LibraryMotion], names: Mapping[str, str]) -> list[LibraryMotion]:
    """Motions with the postures of their steps renamed; `names` by `name_key`."""
    return [
        replace(
            motion,
            steps=tuple(MotionStep(names[name_key(step.posture)], step.time_s) for step in motion.steps),
        )
        for motion in motions
    ]


def _union(first: Sequence[str], second: Sequence[str]) -> tuple[str, ...]:
    return tuple(dict.fromkeys([*first, *second]))
