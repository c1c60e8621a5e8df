"""A cache on disk of arrays that are expensive to compute: one file a key, the least recently used evicted.

A key is a digest of everything the arrays were computed from, so that an entry is never out of date. Files
are written atomically; a damaged one counts as absent, and so does a key of another form.
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
from .file_lock import HIDDEN, LOCK, file_lock
from .json_file import WORK, write_atomically

Arrays = dict[str, NDArray[Any]]

SUFFIX = ".npz"
LARGEST_BYTES = 2 * 2**30
"""A hundred takes of a minute or more."""
_KEY = re.compile(r"[a-z0-9][a-z0-9-]{0,120}")
_DAMAGED = (OSError, ValueError, EOFError, KeyError, NotImplementedError, zipfile.BadZipFile, zlib.error)


class ArrayCache:
    """Sets of arrays in a folder, each under a key of lower-case letters, digits and hyphens."""

    def __init__(self, folder: Path, largest_bytes: int = LARGEST_BYTES) -> None:
        """Use a folder, which is made with the first entry.

        Args:
            folder: The folder of the cache's files, and of nothing else.
            largest_bytes: Size of all files together; beyond it the least recently used are removed.
        """
        self.folder, self.largest_bytes = folder, largest_bytes

    def load(self, key: str) -> Arrays | None:
        """The arrays under a key; None where there are none, or none that can be read."""
        if not _KEY.fullmatch(key):
            return None
        path = self._path(key)
        try:
            with np.load(path, allow_pickle=False) as file:
                arrays = {name: file[name] for name in file.files}
        except _DAMAGED:
            return None
        with suppress(OSError):
            os.utime(path)  # counts as use
        return arrays

    def save(self, key: str, arrays: Mapping[str, NDArray[Any]]) -> None:
        """Write arrays of numbers, truth values or text under a key, replacing an older entry.

        An entry larger than the whole cache is not written.

        Raises:
            ValueError: The key has another form, or an array holds Python objects.
            ConversionError: The folder cannot be written.
        """
        if not _KEY.fullmatch(key):
            raise ValueError(f"the key {key!r} is not of lower-case letters, digits and hyphens")
        for name, array in arrays.items():
            if array.dtype.hasobject:
                raise ValueError(f"{name} holds Python objects, which are not kept")
        if sum(array.nbytes for array in arrays.values()) > self.largest_bytes:
            return
        write_atomically(self._path(key), lambda beside: np.savez(beside, **arrays))
        self._evict(self._path(key))

    def _path(self, key: str) -> Path:
        return self.folder / f"{key}{SUFFIX}"

    def _evict(self, newest: Path) -> None:
        """Remove the least recently used files until the rest fits, and those that were never finished."""
        found: list[tuple[float, int, Path]] = []
        for path in self.folder.iterdir():
            with suppress(OSError):  # another Blender may be evicting as well
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
    """Remove the folder of a file that was never finished, unless its writer is alive."""
    lock = folder.with_name(folder.name.removesuffix(WORK) + LOCK)
    with suppress(BusyError), file_lock(lock, f"{folder}: is being written"):
        shutil.rmtree(folder, ignore_errors=True)
