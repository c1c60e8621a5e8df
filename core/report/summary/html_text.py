"""Texts of takes as a page may hold them: nothing in them is markup, and what cannot be seen is spelt out.

Names, sentences and paths come from whoever filmed or shared a take.
"""

import html
import os
from pathlib import Path
from urllib.parse import quote

from ...files.control_characters import escape_control_characters

LONGEST = 1000
"""Characters that are shown of one text."""


def visible(text: str) -> str:
    r"""A text without what a reader cannot see or a page cannot hold: such a letter becomes `\u202e`.

    These are control characters, line breaks, halves of letters (bytes of a file name that are no UTF-8) and
    marks that turn the direction of writing. The longest are cut.
    """
    shown = text if len(text) <= LONGEST else f"{text[:LONGEST]} ..."
    return escape_control_characters(shown)


def escaped(text: str) -> str:
    """`visible` text for between tags or within the quotes of an attribute."""
    return html.escape(visible(text), quote=True)


def isolated(text: str) -> str:
    """`escaped` text in an element that keeps its direction of writing to itself."""
    return f"<bdi>{escaped(text)}</bdi>"


def way_to(folder: Path, output: Path) -> str:
    """The way from a page in `output` to a folder below it, with slashes."""
    return os.path.relpath(folder, output).replace(os.sep, "/")


def address(*parts: str) -> str:
    """A link along a way, whatever letters it holds: none of them can end it or make it another kind."""
    way = "/".join(parts)
    return html.escape(quote(way.encode("utf-8", "surrogatepass"), safe="/"), quote=True)


def percent(share: float) -> str:
    """A share from 0 to 1, rounded down: what falls short of a threshold shall not seem to reach it."""
    return f"{int(100.0 * share + 1e-9)}\u00a0%"


def duration(seconds: float) -> str:
    """A time as people say it: `3.9 s`, `4 min 5 s`, `2 h 10 min`."""
    if seconds < 59.95:
        return f"{seconds:.1f} s"
    whole = round(seconds)
    if whole < 3600:
        return f"{whole // 60} min {whole % 60} s"
    return f"{whole // 3600} h {whole % 3600 // 60} min"
