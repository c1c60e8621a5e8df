"""Frames of a video file, decoded by OpenCV."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from ...errors import InputError
from .container import check_container, check_pixels

Image = NDArray[np.uint8]

_FALLBACK_FPS = 24.0
_HIGHEST_PLAUSIBLE_FPS = 2000.0
_FRAMES_PER_SEEK = 125
"""Seeking decodes from the last key picture on: half of an encoder's usual 250 frames between them."""

# The decoder reads its verbosity once a process, when it is first used.
os.environ.setdefault("OPENCV_FFMPEG_LOGLEVEL", "-8")


class VideoFile:
    """A video file that OpenCV can decode.

    Attributes:
        path: the file.
        size: width and height in pixels, after the rotation that the file asks for.
        fps: nominal frames per second.
        frame_count: number of frames the file claims, at least 1.
    """

    def __init__(self, path: Path) -> None:
        """Open the file and decode its first frame.

        Raises:
            InputError: it is empty, not a video, too large, or broken before the first frame.
        """
        self.path = path
        check_container(path)
        with self._capture() as capture:
            check_pixels(path, capture.get(cv2.CAP_PROP_FRAME_WIDTH), capture.get(cv2.CAP_PROP_FRAME_HEIGHT))
            found, image = capture.read()
            if not found or image is None:
                raise InputError(f"{path}: not one frame can be decoded; the file is damaged or cut off")
            self.size: tuple[int, int] = (int(image.shape[1]), int(image.shape[0]))
            fps = float(capture.get(cv2.CAP_PROP_FPS))
            self.fps: float = fps if 0.0 < fps < _HIGHEST_PLAUSIBLE_FPS else _FALLBACK_FPS
            claimed = capture.get(cv2.CAP_PROP_FRAME_COUNT)
            self.frame_count: int = max(int(claimed), 1) if np.isfinite(claimed) else 1

    def frames(self) -> Iterator[tuple[int, float, Image]]:
        """Yield index, time in seconds and image of every frame; see `Clip.frames`."""
        with self._capture() as capture:
            index, previous = 0, -np.inf
            while True:
                found, image = capture.read()
                if not found:
                    break
                previous = self._stamp(capture, index, previous)
                yield index, previous, _as_image(image)
                index += 1

    def time_stamps(self) -> Iterator[float]:
        """Yield the time in seconds of every frame."""
        with self._capture() as capture:
            index, previous = 0, -np.inf
            while capture.grab():
                previous = self._stamp(capture, index, previous)
                yield previous
                index += 1

    def at(self, indices: Sequence[int]) -> Iterator[tuple[int, Image]]:
        """Yield the frames of ascending indices, as far as they exist.

        Short gaps are run through; in long ones the file is searched, and run through where that fails.
        """
        with self._capture() as capture:
            position = 0
            for done, index in enumerate(indices):
                if index - position > _FRAMES_PER_SEEK:
                    found = capture.set(cv2.CAP_PROP_POS_FRAMES, index) and capture.grab()
                    if not found:
                        yield from self._run_through(indices[done:])
                        return
                else:
                    found = all(capture.grab() for _ in range(index + 1 - position))
                if not found:
                    return
                position = index + 1
                decoded, picture = capture.retrieve()
                if decoded:
                    yield index, _as_image(picture)

    def sought(self, indices: Sequence[int]) -> Iterator[tuple[int, Image]]:
        """Yield frames that the file is searched for one by one, as far as they are found; see `packets`."""
        with self._capture() as capture:
            for index in indices:
                found = index == 0 or capture.set(cv2.CAP_PROP_POS_FRAMES, index)
                if found and capture.grab():
                    decoded, picture = capture.retrieve()
                    if decoded:
                        yield index, _as_image(picture)

    def onward(self, first: int) -> Iterator[tuple[float, Image]]:
        """Yield time in seconds and image of the frames from about one on.

        The file is searched where that is quicker; at a variable rate another frame may be found, but the
        times are its own.
        """
        with self._capture() as capture:
            index, previous = 0, -np.inf
            if first > _FRAMES_PER_SEEK and capture.set(cv2.CAP_PROP_POS_FRAMES, first):
                index = first
            while capture.grab():
                previous = self._stamp(capture, index, previous)
                if index >= first:
                    decoded, picture = capture.retrieve()
                    if decoded:
                        yield previous, _as_image(picture)
                index += 1

    def _run_through(self, indices: Sequence[int]) -> Iterator[tuple[int, Image]]:
        wanted = set(indices)
        with self._capture() as capture:
            for index in range(indices[-1] + 1):
                if not capture.grab():
                    return
                if index in wanted:
                    decoded, picture = capture.retrieve()
                    if decoded:
                        yield index, _as_image(picture)

    def _stamp(self, capture: cv2.VideoCapture, index: int, previous: float) -> float:
        """Return the time of the frame just read; where the file has no usable stamps, count frames."""
        stamp = float(capture.get(cv2.CAP_PROP_POS_MSEC)) / 1000.0
        if np.isfinite(stamp) and stamp > previous and (index == 0 or stamp > 0.0):
            return stamp
        return index / self.fps if index / self.fps > previous else previous + 1.0 / self.fps

    @contextmanager
    def _capture(self) -> Iterator[cv2.VideoCapture]:
        capture = _open_quietly(self.path)
        try:
            if not capture.isOpened():
                raise InputError(f"{self.path}: cannot be decoded; it must be a video that OpenCV can read")
            # Blender always shows the rotated picture; OpenCV's default differs between versions.
            capture.set(cv2.CAP_PROP_ORIENTATION_AUTO, 1)
            yield capture
        finally:
            capture.release()


def _open_quietly(path: Path) -> cv2.VideoCapture:
    """Open a file without OpenCV's own complaints on standard error, where our one sentence shall stand."""
    name = os.path.abspath(path)  # where a name begins with a word and a colon, that is a protocol to FFmpeg
    level = cv2.getLogLevel()
    cv2.setLogLevel(0)
    try:
        capture = cv2.VideoCapture(name, cv2.CAP_FFMPEG)
        return capture if capture.isOpened() else cv2.VideoCapture(name, cv2.CAP_ANY)
    finally:
        cv2.setLogLevel(level)


def _as_image(image: NDArray[np.generic]) -> Image:
    return np.ascontiguousarray(image, dtype=np.uint8)
