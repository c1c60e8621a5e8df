"""Keeping OpenCV's own complaints from standard error, where our one sentence shall stand."""

from collections.abc import Iterator
from contextlib import contextmanager

import cv2


@contextmanager
def opencv_silence() -> Iterator[None]:
    """Let OpenCV log nothing meanwhile."""
    level = cv2.getLogLevel()
    cv2.setLogLevel(0)
    try:
        yield
    finally:
        cv2.setLogLevel(level)
