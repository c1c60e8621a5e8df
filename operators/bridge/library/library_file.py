"""Keyframe libraries in files, by their suffix: .json, or .blend with pose assets."""

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

from ....core.errors import InputError
from ....core.library.library import Library
from ....core.library.library_file import read_library, write_library
from .library_blend import read_library_blend, write_library_blend
from .pose_assets import present_motions

JSON, BLEND = ".json", ".blend"


def read_libraries(path: Path) -> tuple[Library, ...]:
    """The libraries of a file: one in a .json, one or more in a .blend.

    Raises:
        InputError: The file is of another kind, or unusable.
    """
    suffix = path.suffix.lower()
    if suffix == BLEND:
        return read_library_blend(path)
    if suffix == JSON:
        return (read_library(path),)
    raise InputError("{path}: is neither a .json nor a .blend; libraries are kept in these", path=path)


def write_library_file(path: Path, library: Library) -> None:
    """Write a library in the format of the file's suffix.

    Raises:
        InputError: The file is of another kind, or the library is incomplete.
        ConversionError: The file cannot be written.
    """
    suffix = path.suffix.lower()
    if suffix == BLEND:
        write_library_blend(path, library)
    elif suffix == JSON:
        write_library(path, library)
    else:
        raise InputError(
            "{path}: ends in {suffix}; libraries are written as .json or .blend",
            path=path,
            suffix=suffix or "nothing",
        )


def with_postures(library: Library, names: Iterable[str]) -> Library:
    """A library reduced to some of its postures; motions keep the steps to these.

    Raises:
        InputError: None of its postures is named.
    """
    wanted = {name: name for name in names}
    kept = tuple(posture for posture in library.postures if posture.name in wanted)
    if not kept:
        raise InputError(
            "no posture of '{library}' is selected; select some, or take all", library=library.title
        )
    document = replace(library, postures=kept).to_json()
    document["motions"] = present_motions(document.get("motions", []), wanted)
    motions = Library.from_json(document, f"library '{library.title}'").motions
    return replace(library, postures=kept, motions=motions)
