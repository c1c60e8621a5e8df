"""Errors, and values in words for their sentences."""

from collections.abc import Iterable
from reprlib import Repr
from typing import Any

_SHORT = Repr()
"""Reads no more of a value than is shown."""
_SHORT.maxlevel, _SHORT.maxstring, _SHORT.maxother = 8, 400, 400
_SHORT.maxlist = _SHORT.maxdict = _SHORT.maxtuple = 40


def pluralize(count: int, one: str, many: str | None = None) -> str:
    """`1 take`, `2 takes`; `many` is the plural where it is not `one` with an s."""
    return f"{count} {one if count == 1 else many or one + 's'}"


MOST_NAMED = 3  # frames, or other things, that a sentence names


def frames_in_words(frames: Iterable[float], most: int = 12) -> str:
    """Rising frames for a sentence, `frame 5` or `frames 3 to 7, 12`; of more stretches the first ones."""
    runs: list[list[float]] = []
    for frame in frames:
        if runs and frame <= runs[-1][1] + 1.0:
            runs[-1][1] = frame
        else:
            runs.append([frame, frame])
    named = [f"{first:g}" if first == last else f"{first:g} to {last:g}" for first, last in runs[:most]]
    more = f" and {pluralize(len(runs) - most, 'more time')}" if len(runs) > most else ""
    single = len(runs) == 1 and runs[0][0] == runs[0][1]
    return f"frame{'s' * (not single)} {', '.join(named)}{more}"


class KeymarkError(Exception):
    """Base of every error Keymark raises on purpose; its text is one sentence for a person."""


class InputError(KeymarkError):
    """The input cannot be used: the sentence names file, field, value and what would be valid."""


class ConversionError(KeymarkError):
    """The input is usable, but no motion could be computed from it or written."""


class BusyError(KeymarkError):
    """Another process works on the same results, which may be those that are wanted."""


def describe_unexpected(error: BaseException) -> str:
    """Type and message of an unforeseen error in one line, for a sentence."""
    message = " ".join(str(error).split())
    return f"{type(error).__name__}: {message}" if message else type(error).__name__


def shown(value: Any, longest: int = 60) -> str:
    """A value for a sentence: its repr in one line, cut where it is long."""
    text = _SHORT.repr(value)
    return text if len(text) <= longest else f"{text[: longest - 3]}..."
