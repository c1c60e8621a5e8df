"""Flushing files and folders to the disk, so that they outlive a loss of power."""

import errno
import os
import sys
from pathlib import Path

DISK_ERRORS = frozenset(
    getattr(errno, name) for name in ("ENOSPC", "EDQUOT", "EFBIG", "EIO") if hasattr(errno, name)
)
"""Errors that say the disk is full or broken, not that a path was ill chosen."""


def fsync_path(path: Path) -> None:
    """Wait until a file's content, or a folder's list of names, is on the disk, where the system can.

    Raises:
        OSError: The disk is full or broken.
    """
    if sys.platform == "win32" and path.is_dir():
        return
    try:
        descriptor = os.open(path, os.O_RDWR if sys.platform == "win32" else os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)
    except OSError as error:
        if error.errno in DISK_ERRORS:  # others only mean that this file system has no fsync
            raise
