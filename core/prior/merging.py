"""Merging and joining libraries; a conflict is never resolved silently.

Names are equal where people could not tell them apart.
"""

from collections.abc import Iterable, Mapping
from dataclasses import replace

from ..body.kinematics import Body
from ..errors import InputError, shown
from .library import Library, LibraryMotion, LibraryPosture
from .texts import checked_identifier, name_key, unique_name
from .transfer import transferred

Entry = LibraryPosture | LibraryMotion
Entries = dict[tuple[type, str], Entry]


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
    offered = _entries(_fitted(theirs, mine))
    return tuple(
        entry.name for key, entry in _entries(mine).items() if key in offered and _differ(entry, offered[key])
    )


def merge_versions(mine: Library, theirs: Library, replaces: bool) -> Library:
    """Merge two versions of a library: theirs is fitted to my actor's proportions and added to mine.

    The header is that of the higher version. The result's version is one above both, unless it equals one
    of them.

    `replaces`: whether theirs replaces what is in both and differs.
    """
    fitted = _fitted(theirs, mine)
    both = _entries(mine)
    both |= {key: entry for key, entry in _entries(fitted).items() if replaces or key not in both}
    spelled = {key: entry.name for (_, key), entry in both.items() if isinstance(entry, LibraryPosture)}
    whole = replace(
        fitted if theirs.version > mine.version else mine,
        actor=mine.actor,
        postures=tuple(entry for entry in both.values() if isinstance(entry, LibraryPosture)),
        motions=tuple(_respelled(both.values(), spelled)),
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
    fitted, known = _fitted(second, first), _entries(first)
    names: dict[str, str] = {}  # of the second's postures, in the new library
    postures, motions = list(first.postures), list(first.motions)
    for posture in fitted.postures:
        key = name_key(posture.name)
        same = known.get((LibraryPosture, key))
        if same is not None and not _differ(same, posture):
            names[key] = same.name
            continue
        taken = [entry.name for entry in (*postures, *fitted.postures) if entry is not posture]
        names[key] = unique_name(posture.name, taken)
        postures.append(replace(posture, name=names[key]))
    for motion in _respelled(fitted.motions, names):
        if not any(replace(old, name="") == replace(motion, name="") for old in first.motions):
            motions.append(replace(motion, name=unique_name(motion.name, [entry.name for entry in motions])))
    licenses = dict.fromkeys((first.license, second.license))
    terms = [f"({terms})" if " " in terms and len(licenses) > 1 else terms for terms in licenses]
    return Library(
        identifier=checked_identifier(identifier, "the identifier of the new library"),
        title=title,
        version=1,
        author=", ".join(dict.fromkeys((first.author, second.author))),
        license=" AND ".join(terms),
        actor=first.actor,
        postures=tuple(postures),
        motions=tuple(motions),
        description=" ".join(dict.fromkeys((first.description, second.description))).strip(),
        sources=tuple(dict.fromkeys(first.sources + second.sources)),
        tags=tuple(dict.fromkeys(first.tags + second.tags)),
    )


def _fitted(library: Library, other: Library) -> Library:
    body = Body(other.actor)
    postures = tuple(
        replace(entry, posture=transferred(entry.posture, library.actor, body)) for entry in library.postures
    )
    return replace(library, actor=other.actor, postures=postures)


def _entries(library: Library) -> Entries:
    """Postures and motions, by kind and `name_key`."""
    entries: list[Entry] = [*library.postures, *library.motions]
    return {(type(entry), name_key(entry.name)): entry for entry in entries}


def _differ(one: Entry, other: Entry) -> bool:
    """Whether files would have different contents of the two."""
    return one.to_json() != other.to_json()


def _respelled(entries: Iterable[Entry], names: Mapping[str, str]) -> list[LibraryMotion]:
    """The motions with the postures of their steps renamed; `names` by `name_key`."""
    return [
        replace(
            entry, steps=tuple(replace(step, posture=names[name_key(step.posture)]) for step in entry.steps)
        )
        for entry in entries
        if isinstance(entry, LibraryMotion)
    ]
