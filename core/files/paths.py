"""Paths and names that can be trusted, regular files, and texts that other programs saved in any encoding."""

import codecs
import os
import re
import stat
import unicodedata
from collections.abc import Iterable
from pathlib import Path

from ..errors import InputError

VIDEOS = (".avi", ".m4v", ".mkv", ".mov", ".mp4", ".mpeg", ".mpg", ".mts", ".mxf", ".webm", ".wmv")
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


MARKS = {codecs.BOM_UTF8: "utf-8", codecs.BOM_UTF16_LE: "utf-16-le", codecs.BOM_UTF16_BE: "utf-16-be"}
"""Encodings by the byte order mark at the beginning."""
UNMARKED = ("utf-8", "cp932", "latin-1")
"""Encodings without a mark, the first that fits; cp932 is Shift JIS, and latin-1 fits anything."""
_COMMA = re.compile(r"[-+]?\d*,\d+(?:[eE][-+]?\d+)?")


def read_saved_text(path: Path) -> str:
    """The text of a file, in UTF-8 or UTF-16 with or without a byte order mark, or in Shift JIS."""
    try:
        content = path.read_bytes()
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror})") from error
    for mark, encoding in MARKS.items():
        if content.startswith(mark):
            return content[len(mark) :].decode(encoding, errors="replace")
    for place, encoding in ((1, "utf-16-le"), (0, "utf-16-be")):
        # ASCII, as files begin, has a zero in each pair of bytes.
        if len(content) > 3 and not any(content[place:16:2]):
            return content.decode(encoding, errors="replace")
    for encoding in UNMARKED[:-1]:
        try:
            return content.decode(encoding)
        except UnicodeDecodeError:
            continue
    return content.decode(UNMARKED[-1])


def with_decimal_point(word: str) -> str:
    """A number with a decimal comma, as 0,5, with a point; anything else as it is."""
    return word.replace(",", ".") if "," in word and _COMMA.fullmatch(word.strip()) else word
