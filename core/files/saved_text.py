"""Texts of other programs, in whatever encoding and with whatever decimal sign they were saved."""

import codecs
import re
from pathlib import Path

from ..errors import InputError

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
