"""What a conversion needs beside its take: libraries, paths Blender can work with, and files it writes."""

import os
import sys
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from ....core.errors import InputError
from ....core.files.paths import real_path
from ....core.prior.library import Library
from ....core.prior.registry import SHIPPED, find_libraries
from ....core.take.conversion_record import BLEND, BVH
from ....core.take.description import Description
from ....core.take.motion import Motion
from ....core.take.take import Take
from ..blender_silence import blender_silence

VARIABLE = "KEYMARK_LIBRARIES"
"""Environment variable with further folders of libraries and character maps, separated as in PATH."""


def library_folders() -> list[Path]:
    """The folders that are searched, in order; the first library with an identifier counts."""
    folders = [Path(folder) for folder in os.environ.get(VARIABLE, "").split(os.pathsep) if folder]
    blender = sys.modules.get("bpy")
    if blender is not None and blender.app.binary_path:  # where users keep libraries of their own
        from ...library.registry import own_folder

        folders.append(own_folder())
    return [*folders, SHIPPED]


def requested_libraries(wanted: str) -> tuple[Library, ...]:
    """The libraries that a setting means: one by name or file, or every usable one."""
    return find_libraries(wanted, library_folders())


@contextmanager
def hidden_files(names: Iterable[str], staging_folder: Path, output: Path) -> Iterator[Mapping[str, Path]]:
    """Give paths of files to write, as deep as `output`; when all ends well, they go into the staging folder.

    Blender stores paths relative to the folder it writes in: where the staging folder does not lie beside
    `output`, a real path, the files are written into `output` under hidden names meanwhile.
    """
    folder = staging_folder if staging_folder.parent == output.parent else output
    hidden = {name: folder / f"{staging_folder.name}-{name}" for name in names}
    try:
        yield hidden
        for name, file in hidden.items():
            os.replace(file, staging_folder / name)
    finally:
        for file in hidden.values():
            file.unlink(missing_ok=True)


LONGEST_BYTES = 1023
"""Of a path in Blender."""
FILE_NAME_BYTES = 64
"""Room for the names of the files that Blender writes, below the folder's path."""


def refuse_unsupported_paths(description: Description, output: Path) -> None:
    """Refuse a take or an output folder whose path is too long for Blender or not valid UTF-8."""
    _check(description.clip, 0)
    refuse_unsupported_output(output)


def refuse_unsupported_output(output: Path) -> None:
    """Refuse an output folder in which Blender could not write."""
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


def write_blender_files(take: Take, motion: Motion, staging_folder: Path, output: Path, debug: bool) -> str:
    """Let Blender write both files into the staging folder."""
    with hidden_files((BLEND, BVH), staging_folder, output) as hidden, blender_silence(debug):
        from ...bridge.result_files import write_scene

        return write_scene(take, motion, hidden[BLEND], hidden[BVH])
