"""Letting what has been written outlive a loss of power."""

import errno
import os
import sys
from pathlib import Path

LOSSES = frozenset(
    getattr(errno, name) for name in ("ENOSPC", "EDQUOT", "EFBIG", "EIO") if hasattr(errno, name)
)
"""Errors that say the disk is full or broken, not that a place was ill chosen."""


def to_disk(path: Path) -> None:
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
        if error.errno in LOSSES:  # others only mean that there is no such thing here
            raise
