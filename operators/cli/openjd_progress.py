"""Progress for render farms that read it from what a task writes: Open Job Description's lines."""

import os
from collections.abc import Callable

VARIABLE, OPENJD = "KEYMARK_PROGRESS", "openjd"
"""Environment variable that asks for it, and what it must be."""


class FarmProgress:
    """Takes the place of a bar: a line for each percent, and one for what is being done."""

    def __init__(self, write: Callable[[str], object]) -> None:
        self.n = 0.0
        """Percent."""
        self._write = write
        self._text, self._percent = "", -1

    def set_description(self, text: str, refresh: bool = True) -> None:
        """Say what is being done."""
        if text != self._text:
            self._text = text
            self._write(f"openjd_status: {text}")

    def update(self, more: float) -> None:
        """Say how far it is, so many percent farther."""
        self.n += more
        percent = min(int(self.n), 100)
        if percent > self._percent:
            self._percent = percent
            self._write(f"openjd_progress: {percent}")

    def clear(self) -> None:
        """Lines need not make room for others."""

    def refresh(self) -> None:
        """Lines stay."""

    def close(self) -> None:
        """Nothing is left behind."""


def is_wanted() -> bool:
    """Whether the environment asks for such lines."""
    return os.environ.get(VARIABLE) == OPENJD
