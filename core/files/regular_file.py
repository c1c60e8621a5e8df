"""Regular files, told from devices and pipes, which may have no end, or never begin."""

import stat
from pathlib import Path

from ..errors import InputError


def regular_file_size(path: Path, valid: str) -> int:
    """The size of a regular file in bytes; the file is not opened, which alone could wait for ever.

    Args:
        path: The file.
        valid: What it must be, to follow `it must be`.

    Raises:
        InputError: It is missing, a folder, a device, a pipe or a socket, or cannot be looked at.
    """
    try:
        state = path.stat()
    except FileNotFoundError as error:
        raise InputError(f"{path}: no such file; it must be {valid}") from error
    except (OSError, ValueError) as error:  # a name too long, or with a NUL in it
        reason = error.strerror if isinstance(error, OSError) else error
        raise InputError(f"{path}: cannot be read ({reason}); it must be {valid}") from error
    if not stat.S_ISREG(state.st_mode):
        kind = "a folder" if stat.S_ISDIR(state.st_mode) else "a device, a pipe or a socket"
        raise InputError(f"{path}: is {kind}, no file; it must be {valid}")
    return state.st_size
