"""Digests by which it is known again what a result was computed from."""

import hashlib
from pathlib import Path

import numpy as np

from ..errors import InputError
from .regular_file import ordinary_size

LENGTH = 32
"""Hexadecimal digits: 128 bits."""
SAMPLES = 16
SAMPLE_BYTES = 65536


def digest(*parts: object) -> str:
    """A digest of numbers, text, bytes, arrays and tuples of such; only like values have like digests.

    Raises:
        TypeError: A part is of another kind.
    """
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
    return hashed.hexdigest()[:LENGTH]


def file_digest(path: Path) -> str:
    """A digest of a file by its size, its time of change and samples of what is in it.

    Raises:
        InputError: There is no such ordinary file.
        OSError: The file cannot be read.
    """
    ordinary_size(path, "a file that can be read")
    state = path.stat()
    samples = []
    with path.open("rb") as file:
        for place in np.linspace(0, max(state.st_size - SAMPLE_BYTES, 0), SAMPLES).astype(int):
            file.seek(int(place))
            samples.append(file.read(SAMPLE_BYTES))
            if state.st_size <= SAMPLE_BYTES:
                break
    return digest(state.st_size, state.st_mtime_ns, tuple(samples))


def content_digest(path: Path) -> str:
    """SHA-256 of a file's content.

    Raises:
        InputError: The file cannot be read.
    """
    ordinary_size(path, "a file that can be read")
    try:
        with path.open("rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror or error})") from error
