"""Processes that die, and disks that fill up, at a chosen call of the operating system."""

import errno
import io
import os
import random
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

GROWING = ("mkdir", "open", "replace", "rename", "link", "symlink")
"""Calls that need room on a disk."""
CHANGING = (*GROWING, "unlink", "remove", "rmdir", "fsync", "utime")


class Killed(BaseException):
    """Stands for the end of a process: from then on no call has any effect, so nothing is tidied up."""


class Calls:
    """Counts the calls that change a file system and makes one of them fail.

    Attributes:
        count: Calls so far.
        log: Their names.
    """

    def __init__(self, fails_at: int | None, fault: Callable[[str], BaseException], lasting: bool) -> None:
        self.fails_at, self.fault, self.lasting = fails_at, fault, lasting
        self.count = 0
        self.log: list[str] = []
        self.descriptors: list[int] = []

    def check(self, name: str) -> None:
        """Count a call; raise where it is the one to fail."""
        self.count += 1
        self.log.append(name)
        if self.fails_at is None:
            return
        if self.count == self.fails_at or (self.lasting and self.count > self.fails_at):
            raise self.fault(name)


def killed(_name: str) -> BaseException:
    """The process is gone."""
    return Killed()


def disk_full(_name: str) -> BaseException:
    """There is no room left."""
    return OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


@contextmanager
def faulty_calls(
    fails_at: int | None = None,
    fault: Callable[[str], BaseException] = killed,
    lasting: bool = True,
    names: tuple[str, ...] = CHANGING,
) -> Iterator[Calls]:
    """Let the `fails_at`-th changing call, from 1, fail; None only counts them.

    What is written into a file counts as one call more, and fails with nothing written.

    Args:
        fails_at: Which call.
        fault: What is raised.
        lasting: Whether all later calls fail as well.
        names: Of the calls in `os` that count.
    """
    calls = Calls(fails_at, fault, lasting)
    with pytest.MonkeyPatch.context() as patch:
        for name in names:
            patch.setattr(os, name, _counted(name, getattr(os, name), calls))
        patch.setattr(io, "open", _counted_file(io.open, calls))
        patch.setattr(os, "close", _counted_close(os.close, calls))
        try:
            yield calls
        finally:
            patch.undo()
            for descriptor in calls.descriptors:  # as the end of a process closes them, and so unlocks
                os.close(descriptor)


def _counted(name: str, call: Callable[..., Any], calls: Calls) -> Callable[..., Any]:
    def counted(*args: Any, **words: Any) -> Any:
        reads = name == "open" and not args[1] & (os.O_CREAT | os.O_WRONLY | os.O_RDWR)
        if reads and not (calls.fault is killed and calls.lasting):
            return call(*args, **words)
        calls.check(name)
        result = call(*args, **words)
        if name == "open":
            calls.descriptors.append(result)
        return result

    return counted


def _counted_close(call: Callable[[int], None], calls: Calls) -> Callable[[int], None]:
    """A dead process closes nothing by itself."""

    def counted(descriptor: int) -> None:
        if calls.fault is killed and calls.fails_at is not None and calls.count >= calls.fails_at:
            return
        if descriptor in calls.descriptors:
            calls.descriptors.remove(descriptor)
        call(descriptor)

    return counted


def _counted_file(call: Callable[..., Any], calls: Calls) -> Callable[..., Any]:
    def counted(file: Any, mode: str = "r", *args: Any, **words: Any) -> Any:
        if mode in ("r", "rb"):
            return call(file, mode, *args, **words)
        calls.check("open file")
        opened = call(file, mode, *args, **words)
        try:
            calls.check("write file")
        except BaseException:
            opened.close()
            raise
        return opened

    return counted


def tree(folder: Path) -> dict[str, bytes | None]:
    """Every path below a folder, with what is in the files."""
    return {
        path.relative_to(folder).as_posix(): path.read_bytes() if path.is_file() else None
        for path in sorted(folder.rglob("*"))
    }


def points(seed: int, count: int, latest: float) -> list[float]:
    """Moments at which processes are killed [s], the same in every run."""
    generator = random.Random(seed)
    return [generator.uniform(0.0, latest) for _ in range(count)]
