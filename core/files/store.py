"""A folder of results that are dear to compute again: arrays by key, of bounded size.

A key says everything the arrays were computed from, so what is found under it is never out of date. Files
are written whole; one that is damaged counts as absent, and so does a key that is none of ours.
"""

import os
import re
import shutil
import zipfile
import zlib
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import BusyError
from .folder_lock import HIDDEN, LOCK, folder_lock
from .json_file import WORK, write_whole

Arrays = dict[str, NDArray[Any]]

SUFFIX = ".npz"
LARGEST_BYTES = 2 * 2**30
"""Some hundred takes of a minute."""
_KEY = re.compile(r"[a-z0-9][a-z0-9-]{0,120}")
_DAMAGED = (OSError, ValueError, EOFError, KeyError, NotImplementedError, zipfile.BadZipFile, zlib.error)


class Store:
    """Sets of arrays in a folder, each under a key of small letters, digits and hyphens."""

    def __init__(self, folder: Path, largest_bytes: int = LARGEST_BYTES) -> None:
        """Take a folder, which is made once there is something to keep.

        Args:
            folder: Where the files lie, and nothing else.
            largest_bytes: Size of all files together; beyond it, those unused for longest go.
        """
        self.folder, self.largest_bytes = folder, largest_bytes

    def load(self, key: str) -> Arrays | None:
        """The arrays kept under a key; None where there are none, or none that can be read."""
        if not _KEY.fullmatch(key):
            return None
        path = self._path(key)
        try:
            with np.load(path, allow_pickle=False) as file:
                arrays = {name: file[name] for name in file.files}
        except _DAMAGED:
            return None
        with suppress(OSError):
            os.utime(path)  # so that what is in use is not the oldest
        return arrays

    def save(self, key: str, arrays: Mapping[str, NDArray[Any]]) -> None:
        """Keep arrays of numbers, truth values or text under a key, in place of what was there.

        More than the store may hold is not kept at all.

        Raises:
            ValueError: The key or an array is of no kind that can be kept.
            ConversionError: The folder cannot be written.
        """
        if not _KEY.fullmatch(key):
            raise ValueError(f"the key {key!r} is not of small letters, digits and hyphens")
        for name, array in arrays.items():
            if array.dtype.hasobject:
                raise ValueError(f"{name} holds Python's objects, which are not kept")
        if sum(array.nbytes for array in arrays.values()) > self.largest_bytes:
            return
        write_whole(self._path(key), lambda beside: np.savez(beside, **arrays))
        self._trim(self._path(key))

    def _path(self, key: str) -> Path:
        return self.folder / f"{key}{SUFFIX}"

    def _trim(self, newest: Path) -> None:
        """Remove what was unused for longest until the rest fits, and what was never finished."""
        found: list[tuple[float, int, Path]] = []
        for path in self.folder.iterdir():
            with suppress(OSError):  # another Blender may be tidying up as well
                state = path.stat()
                if path.suffix == SUFFIX:
                    found.append((state.st_mtime, state.st_size, path))
                elif path.name.startswith(HIDDEN) and path.is_dir():
                    _remove_abandoned(path)
        total = sum(size for _, size, _ in found)
        for _, size, path in sorted(found):
            if total <= self.largest_bytes:
                break
            if path != newest:
                with suppress(OSError):
                    path.unlink()
                total -= size


def _remove_abandoned(folder: Path) -> None:
    """Remove what was never finished, unless its writer is alive."""
    lock = folder.with_name(folder.name.removesuffix(WORK) + LOCK)
    with suppress(BusyError), folder_lock(lock, f"{folder}: is being written"):
        shutil.rmtree(folder, ignore_errors=True)
