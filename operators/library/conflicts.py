"""Libraries whose identifier is taken: found, and resolved by a person's choice, never silently."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace

from ...core.errors import InputError
from ...core.library.library import Library
from ...core.library.merging import Choice, compare, merge_versions
from ...core.library.texts import identifier_from, unique_name
from .conflict_dialog import Conflict


def find_conflicts(new: Iterable[Library], existing: Callable[[str], Library | None]) -> list[Conflict]:
    """The libraries whose identifier is taken by a different one.

    Args:
        new: Libraries that arrive.
        existing: The library that is there under an identifier.
    """
    pairs = ((library, existing(library.identifier)) for library in new)
    return [
        Conflict(library, other)
        for library, other in pairs
        if other is not None and not compare(other, library).same
    ]


def resolve_conflicts(
    new: Sequence[Library], existing: Callable[[str], Library | None], choice: str
) -> list[Library]:
    """The libraries to write, under the identifiers they get.

    Args:
        new: Libraries that arrive.
        existing: The library that is there under an identifier.
        choice: An identifier of `conflict_dialog.CHOICES`.

    Raises:
        InputError: An identifier is taken, and the choice is to ask.
    """
    taken = {conflict.new.identifier: conflict for conflict in find_conflicts(new, existing)}
    if taken and choice == "ASK":
        first = next(iter(taken.values()))
        raise InputError(
            "{sentence}; choose whether to keep it, replace it or keep both", sentence=first.sentence
        )
    result = []
    used = [library.identifier for library in new]
    for library in new:
        if library.identifier not in taken:
            if existing(library.identifier) is None:
                result.append(library)
        elif choice == "REPLACE":
            result.append(library)
        elif choice == "MERGE":
            result.append(merge_versions(taken[library.identifier].there, library, Choice.KEEP))
        elif choice == "BOTH":
            while existing(free := identifier_from(library.identifier, used)) is not None:
                used.append(free)
            used.append(free)
            title = unique_name(library.title, [taken[library.identifier].there.title])
            result.append(replace(library, identifier=free, title=title))
    return result
