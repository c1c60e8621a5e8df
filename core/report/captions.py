"""Captions from texts that people wrote: in ASCII, which the font has, wrapped and truncated to fit."""

import textwrap
import unicodedata
from collections.abc import Sequence

from .canvas import Canvas

ELLIPSIS = "..."


def ascii_text(text: str) -> str:
    """The text in ASCII; accents are dropped, as are other characters that the font lacks."""
    return unicodedata.normalize("NFKD", text).encode("ascii", "ignore").decode()


def wrapped(text: str, width: float, size: float, most_lines: int) -> Sequence[str]:
    """Lines of at most about `width` in letters of a `size`; text beyond `most_lines` is cut off."""
    letters = max(int(width / Canvas.text_width("n", size)), 8)
    lines = textwrap.wrap(text, letters) or [""]
    if len(lines) <= most_lines:
        return lines
    return [*lines[: most_lines - 1], lines[most_lines - 1][: letters - len(ELLIPSIS)] + ELLIPSIS]


def truncated(text: str, width: float, size: float) -> str:
    """The text, truncated to a `width` in letters of a `size`."""
    if Canvas.text_width(text, size) <= width:
        return text
    while text and Canvas.text_width(text + ELLIPSIS, size) > width:
        text = text[:-1]
    return text.rstrip() + ELLIPSIS
