"""Findings of a check: problems and warnings, collected so that one does not hide the next."""

from collections.abc import Iterator
from contextlib import contextmanager

from ...errors import KeymarkError


class Findings:
    """Sentences on a take: problems stop its conversion, warnings are what is likely to go wrong."""

    def __init__(self) -> None:
        self._problems: dict[str, None] = {}
        self._warnings: dict[str, None] = {}

    @property
    def problems(self) -> tuple[str, ...]:
        """Reasons why it would not convert."""
        return tuple(self._problems)

    @property
    def warnings(self) -> tuple[str, ...]:
        """What is likely to go wrong."""
        return tuple(self._warnings)

    def problem(self, *sentences: str) -> None:
        """Add problems; the same sentence is kept once."""
        self._problems.update(dict.fromkeys(sentences))

    def warn(self, *sentences: str) -> None:
        """Add warnings; the same sentence is kept once."""
        self._warnings.update(dict.fromkeys(sentences))

    @contextmanager
    def catching(self) -> Iterator[None]:
        """Turn an error raised inside into a problem."""
        try:
            yield
        except KeymarkError as error:
            self.problem(str(error))
