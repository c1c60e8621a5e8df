"""Progress as lines of Open Job Description, which render farms read from a task's output."""

import os
from collections.abc import Callable

VARIABLE, OPENJD = "KEYMARK_PROGRESS", "openjd"
"""Environment variable that asks for these lines, and the value that does."""


class OpenjdProgress:
    """A line for each percent and one for each stage, with the interface of a tqdm bar."""

    def __init__(self, write: Callable[[str], object]) -> None:
        self.n = 0.0
        """Percent."""
        self._write = write
        self._text, self._percent = "", -1

    def set_description(self, text: str, refresh: bool = True) -> None:
        """Write the status line of a new stage."""
        if text != self._text:
            self._text = text
            self._write(f"openjd_status: {text}")

    def update(self, more: float) -> None:
        """Add to the percentage and write a line for each whole percent."""
        self.n += more
        percent = min(int(self.n), 100)
        if percent > self._percent:
            self._percent = percent
            self._write(f"openjd_progress: {percent}")

    def clear(self) -> None:
        """Do nothing: lines need not make room for others."""

    def refresh(self) -> None:
        """Do nothing: lines stay."""

    def close(self) -> None:
        """Do nothing: there is nothing to take away."""


def is_wanted() -> bool:
    """Whether the environment asks for such lines."""
    return os.environ.get(VARIABLE) == OPENJD
