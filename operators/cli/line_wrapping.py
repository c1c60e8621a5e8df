"""Wrapping of sentences to the width of the terminal."""

import sys
from shutil import get_terminal_size
from textwrap import wrap

FEWEST_COLUMNS = 60
"""Narrower terminals are wrapped as if they had this many."""


def terminal_columns() -> int | None:
    """Width of the terminal; None where standard output is none, and sentences stay whole."""
    if sys.stdout is None or not sys.stdout.isatty():
        return None
    return get_terminal_size().columns


def wrapped(sentence: str, indent: int, columns: int | None) -> list[str]:
    """A sentence broken into lines between words; all but the first are indented by two columns more.

    Args:
        sentence: The text to wrap.
        indent: Columns before the first line.
        columns: Width of the terminal; None keeps the sentence whole.
    """
    begin = " " * indent
    if columns is None or indent + len(sentence) <= columns:
        return [begin + sentence]
    return wrap(
        sentence,
        max(columns, FEWEST_COLUMNS),
        initial_indent=begin,
        subsequent_indent=f"{begin}  ",
        break_long_words=False,
        break_on_hyphens=False,
    )
