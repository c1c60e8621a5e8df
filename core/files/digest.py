"""Digests of values and files, which tell whether a result has the same input; arrays kept by digest."""

import hashlib
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

from ..errors import BusyError, InputError
from .file_lock import HIDDEN, LOCK, file_lock
from .json_file import WORK, write_atomically
from .paths import regular_file_size

SAMPLE_BYTES = 65536


def digest(*parts: object) -> str:
    """A digest of numbers, text, bytes, arrays and tuples of these; only equal values have equal digests."""
    hashed = hashlib.sha256()
    for part in parts:
        if isinstance(part, np.ndarray):
            hashed.update(f"array {part.dtype.str} {part.shape}:".encode())
            hashed.update(np.ascontiguousarray(part).tobytes())
        elif isinstance(part, bytes):
            hashed.update(b"bytes %d:" % len(part) + part)
        elif isinstance(part, tuple):
            hashed.update(f"tuple {len(part)}:{digest(*part)}".encode())
        elif part is None or isinstance(part, bool | int | float | str):
            text = repr(part).encode()
            hashed.update(f"{type(part).__name__} {len(text)}:".encode() + text)
        else:
            raise TypeError(f"a {type(part).__name__} has no digest")
    return hashed.hexdigest()[:32]


def file_fingerprint(path: Path) -> str:
    """A quick digest of a file: its size, its modification time and 16 samples, spread over its content."""
    regular_file_size(path, "a file that can be read")
    state = path.stat()
    samples = []
    with path.open("rb") as file:
        for offset in np.linspace(0, max(state.st_size - SAMPLE_BYTES, 0), 16).astype(int):
            file.seek(int(offset))
            samples.append(file.read(SAMPLE_BYTES))
            if state.st_size <= SAMPLE_BYTES:
                break
    return digest(state.st_size, state.st_mtime_ns, tuple(samples))


def content_digest(path: Path) -> str:
    """SHA-256 of a file's whole content."""
    regular_file_size(path, "a file that can be read")
    try:
        with path.open("rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror or error})") from error


Arrays = dict[str, NDArray[Any]]

SUFFIX = ".npz"
LARGEST_BYTES = 2 * 2**30
"""A hundred takes of a minute or more."""
_KEY = re.compile(r"[a-z0-9][a-z0-9-]{0,120}")
_DAMAGED = (OSError, ValueError, EOFError, KeyError, NotImplementedError, zipfile.BadZipFile, zlib.error)


class ArrayCache:
    """Sets of arrays in a folder, each under a key of lower-case letters, digits and hyphens."""

    def __init__(self, folder: Path, largest_bytes: int = LARGEST_BYTES) -> None:
        self.folder, self.largest_bytes = folder, largest_bytes

    def load(self, key: str) -> Arrays | None:
        """The arrays under a key; None where there are none, or none that can be read."""
        if not _KEY.fullmatch(key):
            return None
        path = self.folder / (key + SUFFIX)
        try:
            with np.load(path, allow_pickle=False) as file:
                arrays = {name: file[name] for name in file.files}
        except _DAMAGED:
            return None
        with suppress(OSError):
            os.utime(path)  # counts as use
        return arrays

    def save(self, key: str, arrays: Mapping[str, NDArray[Any]]) -> None:
        """Write arrays of numbers, truth values or text under a key, unless the cache could not hold them."""
        if not _KEY.fullmatch(key):
            raise ValueError(f"the key {key!r} is not of lower-case letters, digits and hyphens")
        for name, array in arrays.items():
            if array.dtype.hasobject:
                raise ValueError(f"{name} holds Python objects, which are not kept")
        if sum(array.nbytes for array in arrays.values()) > self.largest_bytes:
            return
        path = self.folder / (key + SUFFIX)
        write_atomically(path, lambda beside: np.savez(beside, **arrays))
        self._evict(path)

    def _evict(self, newest: Path) -> None:
        """Remove the least recently used files until the rest fits, and those that were never finished."""
        found: list[tuple[float, int, Path]] = []
        for path in self.folder.iterdir():
            with suppress(OSError):  # another Blender may be evicting as well
                state = path.stat()
                if path.suffix == SUFFIX:
                    found.append((state.st_mtime, state.st_size, path))
                elif path.name.startswith(HIDDEN) and path.is_dir():
                    lock = path.with_name(path.name.removesuffix(WORK) + LOCK)
                    with suppress(BusyError), file_lock(lock, f"{path}: is being written"):
                        shutil.rmtree(path, ignore_errors=True)
        total = sum(size for _, size, _ in found)
        for _, size, path in sorted(found):
            if total <= self.largest_bytes:
                break
            if path != newest:
                with suppress(OSError):
                    path.unlink()
                total -= size
