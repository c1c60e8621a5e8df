"""Relative paths in fields, which must stay inside their folder, also through symbolic links."""

import os
from collections.abc import Iterable
from pathlib import Path, PurePosixPath, PureWindowsPath

from ..errors import InputError
from .control_characters import is_control_character
from .fields import Fields
from .json_file import shown

LONGEST_PATH, LONGEST_NAME_BYTES = 1000, 255
"""Characters of a path, and bytes of each name in it, as file systems have it."""


def safe_path(fields: Fields, name: str, folder: Path, valid: str) -> Path:
    """The path in a field, relative to a folder that it must not leave.

    Args:
        fields: The object with the field.
        name: The field's name.
        folder: The folder that the path is relative to.
        valid: What it must be, for the sentence.

    Raises:
        InputError: It is no text, absolute, too long, or climbs out of the folder.
    """
    text = fields.text(name, valid)
    outside = PurePosixPath(text).is_absolute() or PureWindowsPath(text).anchor
    climbs = ".." in PureWindowsPath(text).parts  # it reads both kinds of slash
    named = all(
        len(part.encode("utf-8", "surrogatepass")) <= LONGEST_NAME_BYTES
        for part in PureWindowsPath(text).parts
    )
    odd = (
        len(text) > LONGEST_PATH
        or any(map(is_control_character, text))
        or PureWindowsPath(text).name == ""
        or not named
    )
    if outside or climbs or odd:
        raise InputError(f"{fields.source_of(name)}: {name} is {shown(text)}; it must be {valid}")
    return folder / text


def check_symlinks(paths: Iterable[Path], folders: Iterable[Path]) -> None:
    """Refuse paths that leave their folders by a symbolic link; a missing file is left to its reader.

    Args:
        paths: Files or folders.
        folders: Each path must lie in one of these.

    Raises:
        InputError: A path leads out of all of them.
    """
    roots = [os.path.realpath(folder) for folder in folders]
    for path in paths:
        real = os.path.realpath(path)
        if not any(Path(real).is_relative_to(root) for root in roots):
            raise InputError(f"{path}: leads by a link to {real}; it must stay inside {roots[0]}")
