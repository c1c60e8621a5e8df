"""Paths that files name, which must stay inside their folder."""

import os
from collections.abc import Iterable
from pathlib import Path, PurePosixPath, PureWindowsPath

from ..errors import InputError
from .control_characters import is_hidden
from .fields import Fields
from .json_file import shown

LONGEST, LONGEST_PART = 1000, 255
"""Letters of a path, and bytes of each name in it, as file systems have it."""


def inside_path(fields: Fields, name: str, folder: Path, valid: str) -> Path:
    """The path in a field, relative to a folder that it must not leave.

    Args:
        fields: Of the object with the field.
        name: The field's.
        folder: What the path is relative to.
        valid: What it must be, for the sentence.

    Raises:
        InputError: It is no text, absolute, too long, or climbs out of the folder.
    """
    text = fields.text(name, valid)
    outside = PurePosixPath(text).is_absolute() or PureWindowsPath(text).anchor
    climbs = ".." in PureWindowsPath(text).parts  # it reads both kinds of slash
    named = all(
        len(part.encode("utf-8", "surrogatepass")) <= LONGEST_PART for part in PureWindowsPath(text).parts
    )
    odd = len(text) > LONGEST or any(map(is_hidden, text)) or PureWindowsPath(text).name == "" or not named
    if outside or climbs or odd:
        raise InputError(f"{fields.at(name)}: {name} is {shown(text)}; it must be {valid}")
    return folder / text


def check_links(paths: Iterable[Path], folders: Iterable[Path]) -> None:
    """Hold files to folders that they must not leave by a link; what is not there is left to its reader.

    Args:
        paths: The files, or folders.
        folders: Each must lie in one of these.

    Raises:
        InputError: One leads out of them.
    """
    homes = [os.path.realpath(folder) for folder in folders]
    for path in paths:
        real = os.path.realpath(path)
        if not any(Path(real).is_relative_to(home) for home in homes):
            raise InputError(f"{path}: leads by a link to {real}; it must stay inside {homes[0]}")
