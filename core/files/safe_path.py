"""Relative paths in fields, which must stay inside their folder, also through symbolic links."""

import os
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path, PurePosixPath, PureWindowsPath
from typing import Any

import numpy as np

from ..arrays import Array
from ..errors import InputError
from .fields import Fields
from .kinds import Kind, Text, refuse

LONGEST_PATH, LONGEST_NAME_BYTES = 1000, 255
"""Characters of a path, and bytes of each name in it, as file systems have it."""
INSIDE = r"^(?![\\/])(?![A-Za-z]:)(?!(.*[\\/])?\.\.([\\/]|$)).*\S"
"""What schemas can say of a path that stays inside its folder."""


def safe_path(fields: Fields, name: str, folder: Path, valid: str) -> Path:
    """The path in a field, relative to a folder that it must not leave.

    Raises:
        InputError: It is no text, absolute, too long, or climbs out of the folder.
    """
    return folder / relative_path(valid).read(fields.required(name, valid), fields.source_of(name), name)


def relative_path(valid: str) -> Text:
    """The kind of a field that holds a path inside a folder; `valid` is what it must be, for the sentence."""

    def fault(text: str) -> str:
        path = PureWindowsPath(text)  # it reads both kinds of slash
        outside = PurePosixPath(text).is_absolute() or path.anchor or ".." in path.parts or path.name == ""
        longest = max((len(part.encode("utf-8", "surrogatepass")) for part in path.parts), default=0)
        return f"must be {valid}" if outside or longest > LONGEST_NAME_BYTES else ""

    return Text(LONGEST_PATH, valid, pattern=INSIDE, one_line=True, fault=fault)


def check_symlinks(paths: Iterable[Path], folders: Iterable[Path]) -> None:
    """Refuse paths that leave their folders by a symbolic link; a missing file is left to its reader.

    Raises:
        InputError: A path leads out of all of them.
    """
    roots = [os.path.realpath(folder) for folder in folders]
    for path in paths:
        real = os.path.realpath(path)
        if not any(Path(real).is_relative_to(root) for root in roots):
            raise InputError(f"{path}: leads by a link to {real}; it must stay inside {roots[0]}")


def number_array(value: Any, *, nulls: bool = False) -> Array | None:
    """Nested lists of numbers as an array."""
    try:
        items = np.asarray(value, dtype=object)  # as float64, numpy would convert text and truth values
    except ValueError:  # lists of several lengths
        return None
    kinds = set(map(type, items.ravel())) - ({type(None)} if nulls else set())
    if not all(issubclass(kind, int | float) and kind is not bool for kind in kinds):
        return None
    array = items.astype(np.float64)
    return array if nulls or np.isfinite(array).all() else None


@dataclass(frozen=True)
class NumberArray(Kind):
    """Nested lists of numbers, an array once they are read."""

    shape: tuple[int, ...]
    """Lengths of its axes; -1 for any."""
    limit: float
    """Largest absolute value."""

    @property
    def valid(self) -> str:  # type: ignore[override]
        """Follows "it must be"."""
        words = " x ".join("any number" if length < 0 else str(length) for length in self.shape)
        return f"a list of numbers of shape {words}, each within {self.limit:g}"

    def read(self, value: Any, where: str, name: str) -> Array:
        """See `Kind`."""
        array = number_array(value)
        if array is None or array.ndim != len(self.shape) or not np.all(np.abs(array) <= self.limit):
            refuse(where, name, value, self.valid)
        if any(length not in (-1, given) for length, given in zip(self.shape, array.shape, strict=True)):
            refuse(where, name, value, self.valid)
        return array
