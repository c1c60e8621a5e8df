"""Captions from texts that people wrote: in ASCII, which the font has, truncated to fit."""

import unicodedata

from .canvas import Canvas

ELLIPSIS = "..."


def ascii_text(text: str) -> str:
    """The text in ASCII; accents are dropped, as are other characters that the font lacks."""
    return unicodedata.normalize("NFKD", text).encode("ascii", "ignore").decode()


def truncated(text: str, width: float, size: float) -> str:
    """The text, truncated to a `width` in letters of a `size`."""
    if Canvas.text_width(text, size) <= width:
        return text
    while text and Canvas.text_width(text + ELLIPSIS, size) > width:
        text = text[:-1]
    return text.rstrip() + ELLIPSIS
