"""Fault injection: a process is killed or a disk full at a chosen call of the operating system."""

import errno
import io
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

GROWING = ("mkdir", "open", "replace", "rename", "link", "symlink")
"""Calls that need free space on the disk."""
CHANGING = (*GROWING, "unlink", "remove", "rmdir", "fsync", "utime")


class Killed(BaseException):
    """Stands for SIGKILL: from then on no call has any effect, so nothing is cleaned up."""


class Calls:
    """Counts the calls that change a file system, logs their names, and makes one of them fail."""

    def __init__(self, fails_at: int | None, fault: Callable[[str], BaseException], lasting: bool) -> None:
        self.fails_at, self.fault, self.lasting = fails_at, fault, lasting
        self.count = 0
        self.log: list[str] = []
        self.descriptors: list[int] = []

    def check(self, name: str) -> None:
        """Count a call; raise if it is the one to fail."""
        self.count += 1
        self.log.append(name)
        if self.fails_at is None:
            return
        if self.count == self.fails_at or (self.lasting and self.count > self.fails_at):
            raise self.fault(name)


def killed(_name: str) -> BaseException:
    """The process is killed."""
    return Killed()


def disk_full(_name: str) -> BaseException:
    """The disk is full."""
    return OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


@contextmanager
def faulty_calls(
    fails_at: int | None = None,
    fault: Callable[[str], BaseException] = killed,
    lasting: bool = True,
    names: tuple[str, ...] = CHANGING,
) -> Iterator[Calls]:
    """Let the `fails_at`-th changing call, from 1, fail; None only counts them.

    Writing into a file counts as one more call, and fails with nothing written.

    Args:
        fails_at: Number of the call.
        fault: Makes the error to raise, from the call's name.
        lasting: Whether all later calls fail as well.
        names: Names of the calls in `os` that count.
    """
    calls = Calls(fails_at, fault, lasting)
    with pytest.MonkeyPatch.context() as patch:
        for name in names:
            patch.setattr(os, name, _faulty(name, getattr(os, name), calls))
        patch.setattr(io, "open", _faulty_file(io.open, calls))
        patch.setattr(os, "close", _faulty_close(os.close, calls))
        try:
            yield calls
        finally:
            patch.undo()
            for descriptor in calls.descriptors:  # as the end of a process does, which releases its locks
                os.close(descriptor)


def _faulty(name: str, call: Callable[..., Any], calls: Calls) -> Callable[..., Any]:
    def faulty(*args: Any, **words: Any) -> Any:
        reads = name == "open" and not args[1] & (os.O_CREAT | os.O_WRONLY | os.O_RDWR)
        if reads and not (calls.fault is killed and calls.lasting):
            return call(*args, **words)
        calls.check(name)
        result = call(*args, **words)
        if name == "open":
            calls.descriptors.append(result)
        return result

    return faulty


def _faulty_close(call: Callable[[int], None], calls: Calls) -> Callable[[int], None]:
    """A killed process closes no descriptor itself."""

    def faulty(descriptor: int) -> None:
        if calls.fault is killed and calls.fails_at is not None and calls.count >= calls.fails_at:
            return
        if descriptor in calls.descriptors:
            calls.descriptors.remove(descriptor)
        call(descriptor)

    return faulty


def _faulty_file(call: Callable[..., Any], calls: Calls) -> Callable[..., Any]:
    def faulty(file: Any, mode: str = "r", *args: Any, **words: Any) -> Any:
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

    return faulty


def tree(folder: Path) -> dict[str, bytes | None]:
    """Every path below a folder, with the content of the files."""
    return {
        path.relative_to(folder).as_posix(): path.read_bytes() if path.is_file() else None
        for path in sorted(folder.rglob("*"))
    }
