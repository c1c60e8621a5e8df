"""Places in the file system that Blender cannot work with, found before the work rather than after."""

from pathlib import Path

from ....core.errors import InputError
from ....core.files.paths import real_path
from ....core.take.description import Description

LONGEST_BYTES = 1023
"""Of a path in Blender."""
DEEPEST = 64
"""What the names of the files that Blender writes add to the folder's."""


def check_places(description: Description, output: Path) -> None:
    """Refuse a take or an output folder whose path is too long for Blender, or no text.

    Raises:
        InputError: One is; the sentence says how long it may be.
    """
    _check(description.clip, 0)
    _check(output, DEEPEST)


def _check(path: Path, more: int) -> None:
    try:
        whole = str(real_path(path))
        length = len(whole.encode())
    except UnicodeEncodeError as error:
        shown = str(path).encode(errors="backslashreplace").decode()
        raise InputError(f"{shown}: the path is no text in UTF-8; rename what is no text in it") from error
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: is no path ({error})") from error
    if length + more > LONGEST_BYTES:
        raise InputError(
            f"{path}: the whole path has {length} bytes; Blender can work with one of up to "
            f"{LONGEST_BYTES - more}, so move it nearer to the root"
        )
