"""Locks on files and folders: one process and one thread at a time; a lock ends with its process.

A lock is held on an empty hidden file beside what it guards. The file alone means nothing; holding it does.
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
ATTEMPTS = 200
_NO_LOCKS = {errno.ENOLCK, errno.ENOSYS, errno.EOPNOTSUPP, errno.ENOTSUP}

if sys.platform == "win32":
    import msvcrt

    def _flock(descriptor: int, wait: bool) -> None:
        msvcrt.locking(descriptor, msvcrt.LK_LOCK if wait else msvcrt.LK_NBLCK, 1)
else:
    import fcntl

    def _flock(descriptor: int, wait: bool) -> None:
        fcntl.flock(descriptor, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))


def hidden_prefix(name: str) -> str:
    """Beginning of the names of all hidden files of a file or folder: short, however long its own name is."""
    if sys.platform in ("win32", "darwin"):  # where names that differ in case are one
        name = unicodedata.normalize("NFC", name).casefold()
    return HIDDEN + hashlib.sha256(os.fsencode(name)).hexdigest()[:16]


@contextmanager
def file_lock(file: Path, busy_message: str, wait: bool = False) -> Iterator[None]:
    """Hold a lock while the block runs. Where a file system has no locks, the block runs without.

    The lock's own file is made with its parents and removed afterwards. Where another holds the lock,
    `BusyError` says so by the message, or else it is waited for.
    """
    try:
        descriptor = _acquire(file, busy_message, wait)
    except KeyboardInterrupt:  # perhaps after the file was made and before its descriptor was returned
        with suppress(OSError):
            descriptor = os.open(file, os.O_RDWR)
            if _try_lock(descriptor, wait=False) and _is_same_file(file, descriptor):
                _release(file, descriptor)
            else:
                os.close(descriptor)
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
    """Remove the lock's file, then release it; may be called again after an interruption."""
    if sys.platform != "win32":  # where an open file cannot be removed, and a closed one only by the last
        with suppress(OSError):
            if _is_same_file(file, descriptor):
                file.unlink()
    with suppress(OSError):
        os.close(descriptor)
    if sys.platform == "win32":
        with suppress(OSError):
            file.unlink()


def _acquire(file: Path, busy_message: str, wait: bool) -> int:
    for attempt in range(ATTEMPTS):
        try:
            descriptor = _open(file)
        except (FileNotFoundError, PermissionError) as error:
            # Another has just removed the file, or an empty parent folder; Windows then forbids both.
            transient = sys.platform == "win32" or isinstance(error, FileNotFoundError)
            if not transient or attempt == ATTEMPTS - 1:
                raise
            time.sleep(0.01)
            continue
        try:
            if not _try_lock(descriptor, wait):
                raise BusyError(busy_message)
            if _is_same_file(file, descriptor):
                return descriptor
        except BaseException:
            os.close(descriptor)
            raise
        os.close(descriptor)  # its last holder has removed the file: others would not see this lock
    raise BusyError(busy_message)


def _open(file: Path) -> int:
    flags = os.O_CREAT | getattr(os, "O_NOFOLLOW", 0)
    file.parent.mkdir(parents=True, exist_ok=True)
    try:
        return os.open(file, flags | os.O_RDWR, 0o666)
    except PermissionError:
        if not file.exists():
            raise
        return os.open(file, (flags & ~os.O_CREAT) | os.O_RDONLY)  # left by another user


def _try_lock(descriptor: int, wait: bool) -> bool:
    try:
        _flock(descriptor, wait)
    except OSError as error:
        if error.errno in _NO_LOCKS:
            return True
        if error.errno in (errno.EACCES, errno.EAGAIN, errno.EDEADLK):
            return False
        raise
    return True


def _is_same_file(file: Path, descriptor: int) -> bool:
    try:
        return os.path.samestat(os.stat(file), os.fstat(descriptor))
    except FileNotFoundError:
        return False
