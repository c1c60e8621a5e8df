"""Locks on places in the file system: one process and one thread at a time; a lock dies with its process.

A lock is an empty hidden file beside what it guards. That it is there means nothing: only holding it does.
"""

import errno
import hashlib
import os
import sys
import time
import unicodedata
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from ..errors import BusyError

HIDDEN = ".keymark-"
LOCK = ".lock"
DIGITS = 16
TRIES = 200
PAUSE_S = 0.01
_LACKING = {errno.ENOLCK, errno.ENOSYS, errno.EOPNOTSUPP, errno.ENOTSUP}

if sys.platform == "win32":
    import msvcrt

    def _take(descriptor: int, wait: bool) -> None:
        msvcrt.locking(descriptor, msvcrt.LK_LOCK if wait else msvcrt.LK_NBLCK, 1)
else:
    import fcntl

    def _take(descriptor: int, wait: bool) -> None:
        fcntl.flock(descriptor, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))


def hidden_name(name: str) -> str:
    """What the names of all hidden files of a place begin with: short, whatever its own name is."""
    if sys.platform in ("win32", "darwin"):  # where names that differ in case are one
        name = unicodedata.normalize("NFC", name).casefold()
    return HIDDEN + hashlib.sha256(os.fsencode(name)).hexdigest()[:DIGITS]


@contextmanager
def folder_lock(file: Path, busy: str, wait: bool = False) -> Iterator[None]:
    """Hold a lock while the block runs. Where a file system has no locks, the block runs without.

    Args:
        file: The lock's own file, made with its parents, and removed afterwards.
        busy: What to say where another holds it.
        wait: Whether to wait for it instead.

    Raises:
        BusyError: Another process or thread holds it.
        OSError: The file cannot be made.
    """
    try:
        descriptor = _acquired(file, busy, wait)
    except KeyboardInterrupt:  # perhaps between making the file and knowing of it
        _remove_idle(file)
        raise
    try:
        yield
    finally:
        try:
            _release(file, descriptor)
        except KeyboardInterrupt:
            _release(file, descriptor)
            raise


def _release(file: Path, descriptor: int) -> None:
    """Remove the lock's file, then let go of it; may be called again where it was interrupted."""
    if sys.platform != "win32":  # where an open file cannot be removed, and a closed one only by the last
        with suppress(OSError):
            if _is_still(file, descriptor):
                file.unlink()
    with suppress(OSError):
        os.close(descriptor)
    if sys.platform == "win32":
        with suppress(OSError):
            file.unlink()


def _remove_idle(file: Path) -> None:
    """Remove the lock's file where nobody holds it."""
    with suppress(OSError):
        descriptor = os.open(file, os.O_RDWR)
        if _locked(descriptor, wait=False) and _is_still(file, descriptor):
            _release(file, descriptor)
        else:
            os.close(descriptor)


def _acquired(file: Path, busy: str, wait: bool) -> int:
    for tried in range(TRIES):
        try:
            descriptor = _opened(file)
        except (FileNotFoundError, PermissionError) as error:
            # Another has just removed the file, or an empty folder above; Windows then forbids both.
            passing = sys.platform == "win32" or isinstance(error, FileNotFoundError)
            if not passing or tried == TRIES - 1:
                raise
            time.sleep(PAUSE_S)
            continue
        try:
            if not _locked(descriptor, wait):
                raise BusyError(busy)
            if _is_still(file, descriptor):
                return descriptor
        except BaseException:
            os.close(descriptor)
            raise
        os.close(descriptor)  # who held it has removed the file: the next to come would not see this lock
    raise BusyError(busy)


def _opened(file: Path) -> int:
    flags = os.O_CREAT | getattr(os, "O_NOFOLLOW", 0)
    file.parent.mkdir(parents=True, exist_ok=True)
    try:
        return os.open(file, flags | os.O_RDWR, 0o666)
    except PermissionError:
        if not file.exists():
            raise
        return os.open(file, (flags & ~os.O_CREAT) | os.O_RDONLY)  # left by another user


def _locked(descriptor: int, wait: bool) -> bool:
    try:
        _take(descriptor, wait)
    except OSError as error:
        if error.errno in _LACKING:
            return True
        if error.errno in (errno.EACCES, errno.EAGAIN, errno.EDEADLK):
            return False
        raise
    return True


def _is_still(file: Path, descriptor: int) -> bool:
    try:
        return os.path.samestat(os.stat(file), os.fstat(descriptor))
    except FileNotFoundError:
        return False
