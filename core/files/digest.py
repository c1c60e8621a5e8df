"""Digests of values and files: they tell whether a result was computed from the same input."""

import hashlib
from pathlib import Path

import numpy as np

from ..errors import InputError
from .regular_file import regular_file_size

DIGITS = 32
"""Hexadecimal digits: 128 bits."""
SAMPLES = 16
"""Of a file's content, spread evenly, for its fingerprint."""
SAMPLE_BYTES = 65536


def digest(*parts: object) -> str:
    """A digest of numbers, text, bytes, arrays and tuples of these; only equal values have equal digests.

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
    return hashed.hexdigest()[:DIGITS]


def file_fingerprint(path: Path) -> str:
    """A quick digest of a file: its size, its modification time and samples of its content.

    Raises:
        InputError: There is no such regular file.
        OSError: The file cannot be read.
    """
    regular_file_size(path, "a file that can be read")
    state = path.stat()
    samples = []
    with path.open("rb") as file:
        for offset in np.linspace(0, max(state.st_size - SAMPLE_BYTES, 0), SAMPLES).astype(int):
            file.seek(int(offset))
            samples.append(file.read(SAMPLE_BYTES))
            if state.st_size <= SAMPLE_BYTES:
                break
    return digest(state.st_size, state.st_mtime_ns, tuple(samples))


def content_digest(path: Path) -> str:
    """SHA-256 of a file's whole content.

    Raises:
        InputError: The file cannot be read.
    """
    regular_file_size(path, "a file that can be read")
    try:
        with path.open("rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror or error})") from error
