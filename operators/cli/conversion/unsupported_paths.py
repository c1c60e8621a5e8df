"""Paths that Blender cannot work with, refused before the work begins."""

from pathlib import Path

from ....core.errors import InputError
from ....core.files.paths import real_path
from ....core.take.description import Description

LONGEST_BYTES = 1023
"""Of a path in Blender."""
FILE_NAME_BYTES = 64
"""Room for the names of the files that Blender writes, below the folder's path."""


def refuse_unsupported_paths(description: Description, output: Path) -> None:
    """Refuse a take or an output folder whose path is too long for Blender or not valid UTF-8.

    Raises:
        InputError: A path is unsupported; the sentence says how long it may be.
    """
    _check(description.clip, 0)
    refuse_unsupported_output(output)


def refuse_unsupported_output(output: Path) -> None:
    """Refuse an output folder in which Blender could not write.

    Raises:
        InputError: Its path is too long for Blender or not valid UTF-8.
    """
    _check(output, FILE_NAME_BYTES)


def _check(path: Path, reserved_bytes: int) -> None:
    try:
        whole = str(real_path(path))
        length = len(whole.encode())
    except UnicodeEncodeError as error:
        shown = str(path).encode(errors="backslashreplace").decode()
        raise InputError(f"{shown}: the path is no text in UTF-8; rename the part that is not") from error
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: is no path ({error})") from error
    if length + reserved_bytes > LONGEST_BYTES:
        raise InputError(
            f"{path}: the whole path has {length} bytes; Blender can work with one of up to "
            f"{LONGEST_BYTES - reserved_bytes}, so move it nearer to the root"
        )
