"""Reading and writing pictures for the docs: whole or not at all, and no larger than they need be."""

from pathlib import Path

import cv2
import numpy as np
from keymark.core.arrays import Image

MOST_BYTES = 200_000
BEST, WORST = 88, 48
"""Qualities of JPEG that are tried, the best first."""


def read_picture(path: Path) -> Image:
    """Read a picture.

    Raises:
        SystemExit: It is missing or broken.
    """
    image = cv2.imread(str(path))
    if image is None:
        raise SystemExit(f"{path}: cannot be read as a picture")
    return np.asarray(image, dtype=np.uint8)


def reduced(image: Image, most_width: int) -> Image:
    """A picture of at most this width [px]."""
    height, width = image.shape[:2]
    factor = min(1.0, most_width / width)
    size = (round(factor * width), round(factor * height))
    return np.asarray(cv2.resize(image, size, interpolation=cv2.INTER_AREA), dtype=np.uint8)


def write_picture(path: Path, image: Image, most_bytes: int = MOST_BYTES) -> None:
    """Write a picture as JPEG, at the best quality that is small enough.

    Raises:
        SystemExit: There is none.
    """
    for quality in range(BEST, WORST, -4):
        done, data = cv2.imencode(".jpg", image, [cv2.IMWRITE_JPEG_QUALITY, quality])
        if done and len(data) <= most_bytes:
            draft = path.with_name(f"draft_{path.name}")
            draft.write_bytes(data.tobytes())
            draft.replace(path)
            return
    raise SystemExit(f"{path}: the picture does not fit into {most_bytes} bytes; draw it smaller")
