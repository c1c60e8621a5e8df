"""Frames of a numbered image sequence."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from ...errors import InputError

Image = NDArray[np.uint8]

_EXTENSIONS = frozenset({".png", ".jpg", ".jpeg", ".tif", ".tiff", ".bmp", ".webp", ".jp2", ".ppm", ".pgm"})
_PATTERN = re.compile(r"(#+|%0?\d*d)")
_LAST_NUMBER = re.compile(r"(\d+)(?!.*\d)")


class ImageSequence:
    """Images in the order of their numbers.

    Attributes:
        paths: the files, in order.
        size: width and height of every image in pixels.
        fps: frames per second.
        frame_count: number of files.
    """

    def __init__(self, paths: Sequence[Path], fps: float) -> None:
        """Take the files in order and read the first.

        Raises:
            InputError: the first image cannot be read, or the rate is not above 0.
        """
        if not (np.isfinite(fps) and fps > 0.0):
            raise InputError(f"{paths[0].parent}: fps is {fps!r}; it must be a number above 0")
        self.paths = tuple(paths)
        self.fps = float(fps)
        self.frame_count = len(self.paths)
        first = read_image(self.paths[0])
        self.size: tuple[int, int] = (first.shape[1], first.shape[0])

    def frames(self) -> Iterator[tuple[int, float, Image]]:
        """Yield index, time in seconds and image of every file; see `Clip.frames`."""
        for index in range(self.frame_count):
            yield index, index / self.fps, self._read(index)

    def time_stamps(self) -> Iterator[float]:
        """Yield the time in seconds of every image."""
        yield from (index / self.fps for index in range(self.frame_count))

    def at(self, indices: Sequence[int]) -> Iterator[tuple[int, Image]]:
        """Yield the images of ascending indices, as far as they exist."""
        yield from ((index, self._read(index)) for index in indices if index < self.frame_count)

    def onward(self, first: int) -> Iterator[tuple[float, Image]]:
        """Yield time in seconds and image of the files from one on."""
        yield from ((index / self.fps, self._read(index)) for index in range(max(first, 0), self.frame_count))

    def _read(self, index: int) -> Image:
        image = read_image(self.paths[index])
        if (image.shape[1], image.shape[0]) != self.size:
            raise InputError(
                f"{self.paths[index]}: the image is {image.shape[1]} x {image.shape[0]} pixels; "
                f"it must be {self.size[0]} x {self.size[1]} like the sequence's first"
            )
        return image


def read_image(path: Path) -> Image:
    """Read an image as (height, width, 3) uint8 blue, green, red.

    Sixteen-bit and floating images are brought to eight bits, grey ones to three channels, and alpha is
    dropped.

    Raises:
        InputError: the file is missing or is no image that OpenCV can read.
    """
    try:
        data = np.fromfile(path, dtype=np.uint8)  # imread cannot open every path on Windows
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror}); it must be an image") from error
    image = cv2.imdecode(data, cv2.IMREAD_UNCHANGED) if data.size else None
    if image is None:
        raise InputError(f"{path}: cannot be decoded; it must be an image that OpenCV can read")
    if image.dtype == np.uint16:
        image = np.round(image / 257.0).astype(np.uint8)
    elif image.dtype != np.uint8:
        image = np.round(np.clip(np.nan_to_num(image), 0.0, 1.0) * 255.0).astype(np.uint8)
    if image.ndim == 2 or image.shape[2] == 1:
        image = cv2.cvtColor(image, cv2.COLOR_GRAY2BGR)
    return np.ascontiguousarray(image[:, :, :3])


def find_images(path: Path) -> list[Path] | None:
    """Return the images that a path names, in natural order, or None where it names something else.

    Args:
        path: a folder, a pattern (`img_####.png`, `img_%04d.png`), or one image of a numbered sequence.

    Raises:
        InputError: a folder or pattern without an image.
    """
    if path.is_dir():
        found = [file for file in path.iterdir() if is_image(file)]
        if not found:
            raise InputError(f"{path}: the folder holds no image; it must hold {_names()} files")
        return sorted(found, key=_natural_key)
    if path.suffix.lower() not in _EXTENSIONS:
        return None
    if path.is_file():
        return _siblings(path)
    if not _PATTERN.search(path.name):
        return None
    head, _, tail = _PATTERN.split(path.name, maxsplit=1)
    found = _numbered(path.parent, head, tail)
    if not found:
        raise InputError(f"{path}: no file fits the pattern; name one as in img_####.png or img_%04d.png")
    return found


def is_image(path: Path) -> bool:
    """Tell whether a path is a file that is named like an image."""
    return path.suffix.lower() in _EXTENSIONS and path.is_file()


def stem_of_number(path: Path) -> tuple[str, str] | None:
    """What a numbered image's name has before and behind its number; None for a name without one."""
    number = _LAST_NUMBER.search(path.stem)
    return None if number is None else (path.stem[: number.start()], path.stem[number.end() :] + path.suffix)


def _siblings(path: Path) -> list[Path]:
    """Return the sequence a numbered image belongs to; an image without a number stands alone."""
    around = stem_of_number(path)
    return [path] if around is None else _numbered(path.parent, *around)


def _numbered(folder: Path, head: str, tail: str) -> list[Path]:
    name = re.compile(re.escape(head) + r"\d+" + re.escape(tail) + "$")
    if not folder.is_dir():
        return []
    return sorted((file for file in folder.iterdir() if name.match(file.name)), key=_natural_key)


def _natural_key(path: Path) -> list[tuple[int, int, str]]:
    """Order names as people count: digits by their value, the rest as text."""
    parts = re.split(r"(\d+)", path.name.lower())
    return [(1, int(part), part) if part.isdigit() else (0, 0, part) for part in parts]


def _names() -> str:
    return ", ".join(sorted(extension[1:] for extension in _EXTENSIONS))
