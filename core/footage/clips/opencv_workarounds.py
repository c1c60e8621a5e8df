"""Rows that OpenCV leaves as they were in memory, and what is put there."""

import cv2
import numpy as np

from ...arrays import Image

DEEP_YUV420 = b"Y3\x0b"
"""How FFmpeg names planar YCbCr with colors at half the resolution in more than eight bits; the depth
follows."""
BLOCK = 16
"""Coded pictures have so many rows or a multiple."""
ROWS = 3


def fill_last_rows(capture: cv2.VideoCapture, image: Image) -> None:
    """Repeat the row above those that were never written.

    OpenCV 4.11 does not write the last three rows of pictures of more than eight bits in 4:2:0 whose height
    is no multiple of 16, as those of phones in 1080 rows: what they hold is different each time.

    Args:
        capture: Where the image is from.
        image: (rows, columns, 3), turned as the file asks for; it is changed.
    """
    code = int(capture.get(cv2.CAP_PROP_CODEC_PIXEL_FORMAT)) & 0xFFFFFFFF
    name = code.to_bytes(4, "little")
    if name[:3] != DEEP_YUV420 or name[3] <= 8:
        return
    turned = int(capture.get(cv2.CAP_PROP_ORIENTATION_META)) // 90
    coded = np.rot90(image, turned)
    if coded.shape[0] % BLOCK and coded.shape[0] > ROWS:
        coded[-ROWS:] = coded[-ROWS - 1]
