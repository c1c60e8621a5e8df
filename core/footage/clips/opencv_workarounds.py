"""Workarounds for OpenCV: log messages on standard error, and rows that it leaves uninitialized."""

from collections.abc import Iterator
from contextlib import contextmanager

import cv2
import numpy as np

from ...arrays import Image

DEEP_YUV420 = b"Y3\x0b"
"""FFmpeg's code for planar 4:2:0 YCbCr of more than eight bits; the bit depth follows."""
BLOCK = 16
"""Coded pictures have a multiple of this many rows."""
ROWS = 3


@contextmanager
def opencv_silence() -> Iterator[None]:
    """Suppress OpenCV's log, so that standard error has our one sentence alone."""
    level = cv2.getLogLevel()
    cv2.setLogLevel(0)
    try:
        yield
    finally:
        cv2.setLogLevel(level)


def fill_last_rows(capture: cv2.VideoCapture, image: Image) -> None:
    """Repeat the last written row in the uninitialized rows below it.

    OpenCV 4.11 does not write the last three rows of pictures of more than eight bits in 4:2:0 whose height
    is no multiple of 16, such as phones' 1080 rows: their content differs from run to run.

    Args:
        capture: Source of the image.
        image: (rows, columns, 3), rotated as the file asks for; changed in place.
    """
    code = int(capture.get(cv2.CAP_PROP_CODEC_PIXEL_FORMAT)) & 0xFFFFFFFF
    name = code.to_bytes(4, "little")
    if name[:3] != DEEP_YUV420 or name[3] <= 8:
        return
    turned = int(capture.get(cv2.CAP_PROP_ORIENTATION_META)) // 90
    coded = np.rot90(image, turned)
    if coded.shape[0] % BLOCK and coded.shape[0] > ROWS:
        coded[-ROWS:] = coded[-ROWS - 1]
