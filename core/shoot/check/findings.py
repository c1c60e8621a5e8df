"""What is found wrong with a take, so that one thing that is wrong does not hide the next."""

from collections.abc import Iterator
from contextlib import contextmanager

from ...errors import KeymarkError


class Findings:
    """Sentences on a take: why it would not convert, and what is likely to go wrong."""

    def __init__(self) -> None:
        self._problems: dict[str, None] = {}
        self._warnings: dict[str, None] = {}

    @property
    def problems(self) -> tuple[str, ...]:
        """Why it would not convert."""
        return tuple(self._problems)

    @property
    def warnings(self) -> tuple[str, ...]:
        """What is likely to go wrong."""
        return tuple(self._warnings)

    def problem(self, *sentences: str) -> None:
        """Take note of why it would not convert; what is said already is not said again."""
        self._problems.update(dict.fromkeys(sentences))

    def warn(self, *sentences: str) -> None:
        """Take note of what is likely to go wrong."""
        self._warnings.update(dict.fromkeys(sentences))

    @contextmanager
    def noting(self) -> Iterator[None]:
        """Take what is raised inside for a problem."""
        try:
            yield
        except KeymarkError as error:
            self.problem(str(error))
