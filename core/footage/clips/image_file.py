"""Image files: decoding of a single image to eight-bit color."""

import zlib
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from ... import MOST_PIXELS
from ...arrays import Image
from ...errors import InputError
from ...files.regular_file import regular_file_size
from .opencv_workarounds import opencv_silence

LARGEST_BYTES = 2**31
"""Size limit of an image file: four channels of the largest image at sixteen bits."""
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
    image = _decoded(data)
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


def _decoded(data: Image) -> NDArray[Any] | None:
    if not data.size or not _is_whole(data.tobytes()):
        return None
    try:
        with opencv_silence():
            image: NDArray[Any] | None = cv2.imdecode(data, cv2.IMREAD_UNCHANGED)
            return image
    except cv2.error:  # among them a size above what core/__init__ lets OpenCV read
        return None


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
