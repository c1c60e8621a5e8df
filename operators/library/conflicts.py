"""What happens when a library comes to where one of its identifier is: nothing silently."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import bpy

from ...core.errors import InputError
from ...core.library.texts import identifier_from, unique_name
from . import registry

if TYPE_CHECKING:
    from ...core.library.library import Library

CHOICES = [
    ("ASK", "Ask", "Change nothing where another library of the same identifier is there"),
    ("KEEP", "Keep Mine", "Leave the one that is there as it is, and the new one out"),
    ("REPLACE", "Replace", "Put the new one in the place of the one that is there"),
    ("MERGE", "Add What Is New", "Add postures and motions that mine lacks; what both have stays mine"),
    ("BOTH", "Keep Both", "Give the new one an identifier of its own, and keep it beside the other"),
]
"""What to do with a library whose identifier is taken, as an operator's property shows it."""


@dataclass(frozen=True, eq=False)
class Conflict:
    """A library that comes, and the other one that is there under its identifier."""

    new: "Library"
    there: "Library"

    @property
    def sentence(self) -> str:
        """What a person must know to decide."""
        new, there = self.new, self.there
        if new.version > there.version:
            age = "which is newer"
        elif new.version < there.version:
            age = "which is older"
        else:
            age = "which is of the same version, but not the same"
        return (
            f"'{there.title}' ({there.identifier}) is there in version {there.version} by {there.author}; "
            f"this is version {new.version} by {new.author}, {age}"
        )


def conflicts(new: "Iterable[Library]", there: "Callable[[str], Library | None]") -> list[Conflict]:
    """Those of some libraries whose identifier is taken by another one."""
    from ...core.library.merging import compare

    pairs = ((library, there(library.identifier)) for library in new)
    return [
        Conflict(library, other)
        for library, other in pairs
        if other is not None and not compare(other, library).same
    ]


def settled(
    new: "Sequence[Library]", there: "Callable[[str], Library | None]", choice: str
) -> "list[Library]":
    """The libraries that are to be written, under the identifiers they get.

    Args:
        new: Those that come.
        there: What is there under an identifier.
        choice: One of `CHOICES`.

    Raises:
        InputError: Another one is there, and nobody has chosen what to do.
    """
    from ...core.library.merging import Choice, merge_versions

    taken = {conflict.new.identifier: conflict for conflict in conflicts(new, there)}
    if taken and choice == "ASK":
        first = next(iter(taken.values()))
        raise InputError(f"{first.sentence}; choose whether to keep it, replace it or keep both")
    result = []
    used = [library.identifier for library in new]
    for library in new:
        if library.identifier not in taken:
            if there(library.identifier) is None:
                result.append(library)
        elif choice == "REPLACE":
            result.append(library)
        elif choice == "MERGE":
            result.append(merge_versions(taken[library.identifier].there, library, Choice.KEEP))
        elif choice == "BOTH":
            while there(free := identifier_from(library.identifier, used)) is not None:
                used.append(free)
            used.append(free)
            title = unique_name(library.title, [taken[library.identifier].there.title])
            result.append(replace(library, identifier=free, title=title))
    return result


def on_shelf(identifier: str) -> "Library | None":
    """The library on the shelf, if there is one."""
    from ...core.library.registry import registered_libraries

    found = (
        entry.library for entry in registered_libraries(registry.folders()) if entry.identifier == identifier
    )
    return next((library for library in found if library is not None), None)


def keep_on_shelf(libraries: "Iterable[Library]") -> None:
    """Write libraries into the user's folder, and let the list show them.

    Raises:
        InputError: A file of that name is another library's, or no library.
        ConversionError: A file cannot be written.
    """
    from ...core.library.library_file import write_library

    identifier = ""
    files = [(_own_file(registry.own_folder(), library.identifier), library) for library in libraries]
    for file, library in files:
        write_library(file, library)
        identifier = library.identifier
    registry.fill(identifier)


def _own_file(folder: Path, identifier: str) -> Path:
    """Where a library lies in a folder, or would: people may have put files there under any name.

    Raises:
        InputError: Something else lies there.
    """
    from ...core.library.registry import library_path, registered_libraries

    path, there = library_path(folder, identifier), registered_libraries([folder])
    found = next((each.path for each in there if each.library and each.identifier == identifier), path)
    other = next((each for each in there if each.path == found and each.identifier != identifier), None)
    damaged = next((each for each in there if each.path == found and each.library is None), None)
    if other is not None or damaged is not None:
        holds = f"the library '{other.title}'" if other is not None else "something that is no library"
        raise InputError(f"{found}: holds {holds}, which would be lost; give that file another name first")
    return found


def only_postures(library: "Library", names: "Iterable[str]") -> "Library":
    """A library of some of its postures; motions keep the steps that lead to these.

    Raises:
        InputError: None of its postures is named.
    """
    from ...core.library.library_file import library_from_json, library_to_json
    from ..bridge.library.pose_assets import present_motions

    wanted = {name: name for name in names}
    kept = tuple(posture for posture in library.postures if posture.name in wanted)
    if not kept:
        raise InputError(f"no posture of '{library.title}' is selected; select some, or take all")
    document = library_to_json(replace(library, postures=kept))
    document["motions"] = present_motions(document.get("motions", []), wanted)
    return replace(
        library, postures=kept, motions=library_from_json(document, f"library '{library.title}'").motions
    )


def asset_libraries(context: bpy.types.Context) -> dict[str, Path]:
    """The asset libraries that the preferences name, and their folders."""
    listed = context.preferences.filepaths.asset_libraries
    return {item.name: Path(bpy.path.abspath(item.path)) for item in listed if item.path}
