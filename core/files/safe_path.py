"""Relative paths in fields, which must stay inside their folder, also through symbolic links."""

import os
from collections.abc import Iterable
from pathlib import Path, PurePosixPath, PureWindowsPath

from ..errors import InputError
from .fields import Fields
from .kinds import Text

LONGEST_PATH, LONGEST_NAME_BYTES = 1000, 255
"""Characters of a path, and bytes of each name in it, as file systems have it."""
INSIDE = r"^(?![\\/])(?![A-Za-z]:)(?!(.*[\\/])?\.\.([\\/]|$)).*\S"
"""What schemas can say of a path that stays inside its folder."""


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
    return folder / relative_path(valid).read(fields.required(name, valid), fields.source_of(name), name)


def relative_path(valid: str) -> Text:
    """The kind of a field that holds a path inside a folder; `valid` is what it must be, for the sentence."""

    def fault(text: str) -> str:
        path = PureWindowsPath(text)  # it reads both kinds of slash
        outside = PurePosixPath(text).is_absolute() or path.anchor or ".." in path.parts or path.name == ""
        longest = max((len(part.encode("utf-8", "surrogatepass")) for part in path.parts), default=0)
        return f"must be {valid}" if outside or longest > LONGEST_NAME_BYTES else ""

    return Text(LONGEST_PATH, valid, pattern=INSIDE, one_line=True, fault=fault)


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
