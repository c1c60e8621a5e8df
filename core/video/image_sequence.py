"""Image files: decoding of a single image to eight-bit color."""

import math
import re
import zlib
from collections.abc import Iterator, Sequence
from contextlib import suppress
from itertools import islice
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from .. import MOST_FRAMES, MOST_PIXELS
from ..arrays import Image
from ..errors import InputError
from ..files.fields import listed
from ..files.paths import regular_file_size
from .container import opencv_silence

LARGEST_BYTES = 2**31  # size limit of an image file: four channels of the largest image at sixteen bits
PNG = b"\x89PNG\r\n\x1a\n"


def read_image(path: Path) -> Image:
    """Read an image as (height, width, 3) uint8 blue, green, red.

    Sixteen-bit and floating images are brought to eight bits, gray ones to three channels, and alpha is
    dropped.

    Raises:
        InputError: The file is missing, too large, or no image that OpenCV can read.
    """
    if regular_file_size(path, "an image") > LARGEST_BYTES:
        raise InputError(f"{path}: has more than {LARGEST_BYTES / 2**20:g} MiB; it must be a smaller image")
    try:
        data = np.fromfile(path, dtype=np.uint8)  # imread cannot open every path on Windows
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror}); it must be an image") from error
    image: NDArray[Any] | None = None
    if data.size and _is_whole(data.tobytes()):
        with opencv_silence(), suppress(cv2.error):  # among them a size above what core/__init__ lets it read
            image = cv2.imdecode(data, cv2.IMREAD_UNCHANGED)
    if image is None:
        raise InputError(
            f"{path}: cannot be decoded; it must be a whole image that OpenCV can read, of at most "
            f"{MOST_PIXELS} pixels (without the file its frame counts as missing)"
        )
    if image.dtype == np.uint16:
        image = cv2.convertScaleAbs(image, alpha=1.0 / 257.0)
    elif image.dtype != np.uint8:
        image = np.round(np.clip(np.nan_to_num(image), 0.0, 1.0) * 255.0).astype(np.uint8)
    if image.ndim == 2 or image.shape[2] < 3:
        gray = np.ascontiguousarray(image.reshape(*image.shape[:2], -1)[:, :, 0])
        image = cv2.cvtColor(gray, cv2.COLOR_GRAY2BGR)
    return np.ascontiguousarray(image[:, :, :3])


def _is_whole(data: bytes) -> bool:
    """Whether a PNG is undamaged, as its decoder reports damage on standard error; True for other formats."""
    if not data.startswith(PNG):
        return True
    at = len(PNG)
    while at + 12 <= len(data):
        length = int.from_bytes(data[at : at + 4], "big")
        end = at + 8 + length
        if zlib.crc32(data[at + 4 : end]) != int.from_bytes(data[end : end + 4], "big"):
            return False
        if data[at + 4 : at + 8] == b"IEND":
            return True
        at = end + 4
    return False


EXTENSIONS = frozenset({".png", ".jpg", ".jpeg", ".tif", ".tiff", ".bmp", ".webp", ".jp2", ".ppm", ".pgm"})
PATTERN = re.compile(r"(#+|%0?\d*d)")
LAST_NUMBER = re.compile(r"(\d+)(?!.*\d)")


class ImageSequence:
    """Images in the order of their numbers.

    A missing number, as of a lost image, keeps its frame, which is black.
    """

    paths: tuple[Path | None, ...]  # the file of every frame, in order; None where it is missing
    size: tuple[int, int]  # width and height of every image in pixels
    fps: float  # frames per second
    frame_count: int  # number of frames
    notes: tuple[str, ...]  # sentences on missing images

    def __init__(self, paths: Sequence[Path], fps: float) -> None:
        if not (np.isfinite(fps) and fps > 0.0):
            raise InputError(f"{paths[0].parent}: fps is {fps!r}; it must be a number above 0")
        self.paths, self.notes = _placed(paths)
        self.fps = float(fps)
        self.frame_count = len(self.paths)
        first = read_image(paths[0])
        self.size = (first.shape[1], first.shape[0])

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
        path = self.paths[index]
        if path is None:
            return np.zeros((self.size[1], self.size[0], 3), dtype=np.uint8)
        image = read_image(path)
        if (image.shape[1], image.shape[0]) != self.size:
            raise InputError(
                f"{path}: the image is {image.shape[1]} x {image.shape[0]} pixels; "
                f"it must be {self.size[0]} x {self.size[1]} like the sequence's first"
            )
        return image


def _placed(paths: Sequence[Path]) -> tuple[tuple[Path | None, ...], tuple[str, ...]]:
    """Each image at the index of its number, None for missing ones, and sentences on those."""
    around = {stem_of_number(path) for path in paths}
    if len(paths) < 2 or len(around) > 1 or None in around:
        return tuple(paths), ()
    numbers = [int(number[0]) for number in map(LAST_NUMBER.search, (path.stem for path in paths)) if number]
    if len(set(numbers)) < len(paths):
        return tuple(paths), ()
    step = math.gcd(*(number - numbers[0] for number in numbers))
    indices = [(number - numbers[0]) // step for number in numbers]
    missing = indices[-1] + 1 - len(indices)
    if missing == 0:
        return tuple(paths), ()
    if missing > len(paths):
        return tuple(paths), (
            (
                f"the numbers of the images in {paths[0].parent} have more gaps than images; they are "
                f"taken one after the other, from {paths[0].name} to {paths[-1].name}"
            ),
        )
    found = dict(zip(indices, paths, strict=True))
    lost = [str(numbers[0] + step * index) for index in range(indices[-1] + 1) if index not in found]
    note = (
        f"{missing} of {indices[-1] + 1} images are missing in {paths[0].parent}, number "
        f"{listed(lost, 3)}: nothing is seen in their frames; Blender shows the sequence up to the "
        "first gap only"
    )
    return tuple(found.get(index) for index in range(indices[-1] + 1)), (note,)


def find_images(path: Path) -> list[Path] | None:
    """The images of a folder, a pattern or a numbered image, in natural order; None of anything else.

    Raises:
        InputError: A folder or pattern without an image, or a folder with several sequences.
    """
    if path.is_dir():
        found = sorted(_limited(path, (f for f in path.iterdir() if is_image(f))), key=_natural_key)
        if not found:
            kinds = ", ".join(sorted(extension[1:] for extension in EXTENSIONS))
            raise InputError(f"{path}: the folder holds no image; it must hold {kinds} files")
        sequences: dict[tuple[str, str], list[Path]] = {}
        for image in found:
            sequences.setdefault(stem_of_number(image) or ("", image.name), []).append(image)
        several = sorted((own for own in sequences.values() if len(own) > 1), key=len, reverse=True)
        if len(several) > 1:
            raise InputError(
                f"{path}: holds {len(several)} sequences of images, as {several[0][0].name} and "
                f"{several[1][0].name}; name one by a pattern, as in img_####.png, or keep each in its own "
                "folder"
            )
        return several[0] if several else found  # numbered ones without stray ones
    if path.suffix.lower() not in EXTENSIONS:
        return None
    if path.is_file():
        around = stem_of_number(path)
        return [path] if around is None else _numbered(path.parent, *around)
    if not PATTERN.search(path.name):
        return None
    head, _, tail = PATTERN.split(path.name, maxsplit=1)
    found = _numbered(path.parent, head, tail)
    if not found:
        raise InputError(f"{path}: no file fits the pattern; name one as in img_####.png or img_%04d.png")
    return found


def left_out(path: Path, images: Sequence[Path]) -> tuple[str, ...]:
    """A sentence on the images of a folder that are not of its sequence, if there are any."""
    if not path.is_dir():
        return ()
    used = {image.name for image in images}
    unused = sorted(file.name for file in path.iterdir() if file.name not in used and is_image(file))
    if not unused:
        return ()
    return ((f"{path}: holds also {listed(unused, 3)}, left out: not of the sequence from {images[0].name}"),)


def is_image(path: Path) -> bool:
    """Whether a path is a file named like an image."""
    hidden = path.name.startswith(".")  # macOS puts one beside every file it copies to other disks
    return path.suffix.lower() in EXTENSIONS and not hidden and path.is_file()


def stem_of_number(path: Path) -> tuple[str, str] | None:
    """Prefix and suffix of a numbered image's name around its number; None for a name without one."""
    number = LAST_NUMBER.search(path.stem)
    return None if number is None else (path.stem[: number.start()], path.stem[number.end() :] + path.suffix)


def _numbered(folder: Path, head: str, tail: str) -> list[Path]:
    name = re.compile(re.escape(head) + r"\d+" + re.escape(tail) + "$")
    if not folder.is_dir():
        return []
    return sorted(_limited(folder, (f for f in folder.iterdir() if name.match(f.name))), key=_natural_key)


def _limited(folder: Path, images: Iterator[Path]) -> list[Path]:
    found = list(islice(images, MOST_FRAMES + 1))
    if len(found) > MOST_FRAMES:
        raise InputError(f"{folder}: holds more than {MOST_FRAMES} images; name a folder of fewer")
    return found


def _natural_key(path: Path) -> list[tuple[int, int, str]]:
    """Sort key of natural order: digits by value, the rest as text."""
    parts = re.split(r"(\d+)", path.name.lower())
    return [(1, int(part), part) if part.isdecimal() else (0, 0, part) for part in parts]
