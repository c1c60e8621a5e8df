"""Sentences as lines of a terminal."""

import sys
from shutil import get_terminal_size
from textwrap import wrap

NARROWEST = 60
"""Columns that sentences have at least."""


def terminal_columns() -> int | None:
    """Width of the terminal that standard output is; None where it is none, and nothing is to be broken."""
    if sys.stdout is None or not sys.stdout.isatty():
        return None
    return get_terminal_size().columns


def broken(sentence: str, indent: int, columns: int | None) -> list[str]:
    """A sentence as lines between words; all but the first stand two columns further in.

    Args:
        sentence: The text.
        indent: Columns before the first line.
        columns: Of the terminal; None where the sentence is to stay whole.
    """
    begin = " " * indent
    if columns is None or indent + len(sentence) <= columns:
        return [begin + sentence]
    return wrap(
        sentence,
        max(columns, NARROWEST),
        initial_indent=begin,
        subsequent_indent=f"{begin}  ",
        break_long_words=False,
        break_on_hyphens=False,
    )
