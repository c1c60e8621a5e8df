"""Words that people wrote, as the pictures' font can show them and as much as fits."""

import textwrap
import unicodedata
from collections.abc import Sequence

from .canvas import Canvas

DOTS = "..."


def plain(text: str) -> str:
    """The text in the letters that can be drawn."""
    return unicodedata.normalize("NFKD", text).encode("ascii", "ignore").decode()


def wrapped(text: str, width: float, size: float, most_lines: int) -> Sequence[str]:
    """Lines of at most about `width` in letters of a `size`; what does not fit is cut off."""
    letters = max(int(width / Canvas.text_width("n", size)), 8)
    lines = textwrap.wrap(text, letters) or [""]
    if len(lines) <= most_lines:
        return lines
    return [*lines[: most_lines - 1], lines[most_lines - 1][: letters - len(DOTS)] + DOTS]


def cut(text: str, width: float, size: float) -> str:
    """The text, or as much of its beginning as is no wider than `width` in letters of a `size`."""
    if Canvas.text_width(text, size) <= width:
        return text
    while text and Canvas.text_width(text + DOTS, size) > width:
        text = text[:-1]
    return text.rstrip() + DOTS
