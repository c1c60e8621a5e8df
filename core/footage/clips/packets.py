"""Packets of a video file, undecoded: number and times of its pictures, and the keyframes for seeking.

The file's packets are read as they are, one a picture, in a thousandth of the time of decoding them. Only
files that `VideoFile` could open are read.
"""

import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np

from ...arrays import Array
from .opencv_workarounds import opencv_silence

MOST_PACKETS = 20_000
"""Packets read of a longer file: ten minutes tell whether the frame rate varies."""
SEARCH_BEGINS = 16
"""Frames before a wanted one from which OpenCV seeks backwards for a video keyframe."""
MORE = 2
"""Packets that must follow a wanted frame, so that seeking never meets the end."""


@dataclass(frozen=True, eq=False)
class Packets:
    """Presentation times of a video file's first pictures."""

    time_s: Array
    """(N,) time of each picture, ascending."""
    complete: bool
    """Whether these are all of the file's pictures."""


def read_packets(path: Path, most: int = MOST_PACKETS) -> Packets | None:
    """Read the times of a file's pictures; None if its packets cannot be read."""
    times: list[float] = []
    with _packets(path) as capture:
        while len(times) < most and capture.grab():
            times.append(float(capture.get(cv2.CAP_PROP_POS_MSEC)) / 1000.0)
    if not times or not np.isfinite(times).all():
        return None
    return Packets(np.sort(np.array(times)), len(times) < most)


def quickly_found(path: Path, wanted: Sequence[int]) -> list[int]:
    """Indices near the wanted ones, ascending, that can be decoded with few other frames.

    Frames beyond the file's actual end are left out.
    """
    found = set()
    with _packets(path) as capture:
        for index in wanted:
            if not capture.set(cv2.CAP_PROP_POS_FRAMES, index):
                continue
            begins = int(capture.get(cv2.CAP_PROP_POS_FRAMES))
            if 0 <= begins <= index and all(capture.grab() for _ in range(SEARCH_BEGINS + MORE)):
                found.add(begins + SEARCH_BEGINS)
    return sorted(found)


@contextmanager
def _packets(path: Path) -> Iterator[cv2.VideoCapture]:
    capture = cv2.VideoCapture()
    with opencv_silence():
        try:
            capture.open(os.path.abspath(path), cv2.CAP_FFMPEG, [cv2.CAP_PROP_FORMAT, -1])
            yield capture
        finally:
            capture.release()
