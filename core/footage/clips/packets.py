"""What a video file holds, without decoding it: how many pictures, when, and where decoding can begin.

The file's packets are read as they are, one a picture. That takes a thousandth of the time of decoding them.
Only what `VideoFile` could open is looked at.
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
"""Of a longer file no more are read: ten minutes of it tell whether the rate varies."""
SEARCH_BEGINS = 16
"""Frames before a wanted one from which OpenCV seeks backwards for a picture that stands by itself."""
MORE = 2
"""Packets that must follow a wanted frame, so that the search for it never meets the end."""


@dataclass(frozen=True, eq=False)
class Packets:
    """The beginning of a video file."""

    time_s: Array
    """(N,) when each picture is shown, ascending."""
    complete: bool
    """Whether that is all the file holds."""


def read_packets(path: Path, most: int = MOST_PACKETS) -> Packets | None:
    """Read the times of a file's pictures; None where the file cannot be read in this way."""
    times: list[float] = []
    with _packets(path) as capture:
        while len(times) < most and capture.grab():
            times.append(float(capture.get(cv2.CAP_PROP_POS_MSEC)) / 1000.0)
    if not times or not np.isfinite(times).all():
        return None
    return Packets(np.sort(np.array(times)), len(times) < most)


def quickly_found(path: Path, wanted: Sequence[int]) -> list[int]:
    """Return frames near the wanted ones, ascending, for each of which few others must be decoded.

    Those that lie beyond what the file really holds are left out.
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
