"""Escaping of untrusted texts for HTML: nothing in them is markup, and invisible characters are spelt out.

Names, sentences and paths come from the people who filmed or shared a take.
"""

import html
import os
from pathlib import Path
from urllib.parse import quote

from ...files.control_characters import escape_control_characters

LONGEST = 1000
"""Characters shown of one text."""


def visible(text: str) -> str:
    r"""A text with invisible and invalid characters spelt out, as `\u202e`, cut at `LONGEST` characters.

    Spelt out are control characters, line breaks, surrogates (bytes of a file name that are not UTF-8) and
    marks that change the direction of writing.
    """
    shown = text if len(text) <= LONGEST else f"{text[:LONGEST]} ..."
    return escape_control_characters(shown)


def escaped(text: str) -> str:
    """`visible` text, escaped for use between tags or within a quoted attribute."""
    return html.escape(visible(text), quote=True)


def isolated(text: str) -> str:
    """`escaped` text in an element that isolates its direction of writing."""
    return f"<bdi>{escaped(text)}</bdi>"


def relative_path(folder: Path, output: Path) -> str:
    """Path of a folder relative to a page in `output`, with slashes."""
    return os.path.relpath(folder, output).replace(os.sep, "/")


def address(*parts: str) -> str:
    """A percent-encoded relative link; no character of the parts can end it or add a scheme."""
    path = "/".join(parts)
    return html.escape(quote(path.encode("utf-8", "surrogatepass"), safe="/"), quote=True)


def percent(share: float) -> str:
    """A share from 0 to 1 in percent, rounded down: a value below a threshold never appears to reach it."""
    return f"{int(100.0 * share + 1e-9)}\u00a0%"


def duration(seconds: float) -> str:
    """A duration for people: `3.9 s`, `4 min 5 s`, `2 h 10 min`."""
    if seconds < 59.95:
        return f"{seconds:.1f} s"
    whole = round(seconds)
    if whole < 3600:
        return f"{whole // 60} min {whole % 60} s"
    return f"{whole // 3600} h {whole % 3600 // 60} min"
