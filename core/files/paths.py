"""Paths and names that can be trusted: absolute ones, regular files, and no control characters."""

import os
import stat
import unicodedata
from collections.abc import Iterable
from pathlib import Path

from ..errors import InputError

CATEGORIES = ("Cc", "Cf", "Cs", "Zl", "Zp")
"""Unicode categories: control, formatting (also what turns the direction of writing), surrogates, line
breaks."""
JOINERS = "\u200c\u200d"
"""Zero-width, but letters of several scripts need them between them."""


def is_control_character(character: str, allowed: str = JOINERS) -> bool:
    """Whether a character is invisible, or changes how others are shown."""
    return character not in allowed and unicodedata.category(character) in CATEGORIES


def escape_control_characters(text: str) -> str:
    """A text with its control characters as escapes, for terminals, which would obey them."""
    return "".join(ascii(char)[1:-1] if is_control_character(char) else char for char in text)


def absolute_path(path: Path) -> Path:
    """An absolute path without `..`: that of `/day1/../day2` has no parent `day1`."""
    return Path(os.path.realpath(path)) if ".." in path.parts else path.absolute()


def real_path(path: Path) -> Path:
    """An absolute path, links resolved, that begins with one slash: two have a meaning in Blender."""
    real = os.path.realpath(path)
    return Path("/" + real.lstrip("/") if real.startswith("//") else real)


def regular_file_size(path: Path, valid: str) -> int:
    """The size of a regular file in bytes; it is not opened, which alone could wait for ever."""
    try:
        state = path.stat()
    except FileNotFoundError as error:
        raise InputError(f"{path}: no such file; it must be {valid}") from error
    except (OSError, ValueError) as error:  # a name too long, or with a NUL in it
        reason = error.strerror if isinstance(error, OSError) else error
        raise InputError(f"{path}: cannot be read ({reason}); it must be {valid}") from error
    if not stat.S_ISREG(state.st_mode):
        kind = "a folder" if stat.S_ISDIR(state.st_mode) else "a device, a pipe or a socket"
        raise InputError(f"{path}: is {kind}, no file; it must be {valid}")
    return state.st_size


def check_symlinks(paths: Iterable[Path], folders: Iterable[Path]) -> None:
    """Refuse paths that leave their folders by a symbolic link; a missing file is left to its reader."""
    roots = [os.path.realpath(folder) for folder in folders]
    for path in paths:
        real = os.path.realpath(path)
        if not any(Path(real).is_relative_to(root) for root in roots):
            raise InputError(f"{path}: leads by a link to {real}; it must stay inside {roots[0]}")
