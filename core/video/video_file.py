"""Frames of a video file, decoded by OpenCV."""

import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from itertools import islice
from pathlib import Path

import cv2
import numpy as np

from ..arrays import Image
from ..errors import InputError
from .container import check_container, check_pixels, fill_last_rows, opencv_silence
from .header import dynamic_range_note, pixel_shape, trimmed_s

FRAMES_PER_SEEK = 125  # mean cost of seeking: half of the usual 250 frames between video keyframes
LONGEST_PAUSE_S = 3600.0  # longest step between valid time stamps

CONVERT = "convert it, as with ffmpeg -i CLIP -c:v libx264 -crf 12 -pix_fmt yuv420p converted.mp4"

# The decoder reads its verbosity once a process, when it is first used.
os.environ.setdefault("OPENCV_FFMPEG_LOGLEVEL", "-8")


class VideoFile:
    """A video file that OpenCV can decode."""

    path: Path
    stored_size: tuple[int, int]  # width and height in pixels, after the rotation that the file asks for
    size: tuple[int, int]  # the same in square pixels, to which frames are scaled
    fps: float  # nominal frames per second
    frame_count: int  # number of frames according to the file, at least 1
    is_trimmed: bool  # whether it holds pictures that it does not show, as a clip trimmed on a phone
    notes: tuple[str, ...]  # sentences on faults of the file

    def __init__(self, path: Path, size: tuple[int, int] | None = None) -> None:
        """Open a video; where `size` is that of its oblong pixels as stored, they are left so."""
        self.path = path
        check_container(path)
        with self._capture() as capture:
            check_pixels(path, capture.get(cv2.CAP_PROP_FRAME_WIDTH), capture.get(cv2.CAP_PROP_FRAME_HEIGHT))
            step = next(_steps(capture), None)
            decoded, image = (False, None) if step is None else capture.retrieve()
            if not decoded or image is None:
                code = int(capture.get(cv2.CAP_PROP_FOURCC)) & 0xFFFFFFFF
                name = code.to_bytes(4, "little").decode("ascii", "replace").strip("\0 ")
                codec = name if name.isalnum() and name.isascii() else "unknown"
                raise InputError(
                    f"{path}: not one frame of this {codec} video can be decoded; it is damaged, "
                    f"cut off or coded in a way that OpenCV cannot read here; {CONVERT}"
                )
            width, height = self.stored_size = (int(image.shape[1]), int(image.shape[0]))
            shape = pixel_shape(capture)
            # The longer side grows, so that no detail is lost.
            square = (round(width * max(shape, 1.0)), round(height / min(shape, 1.0)))
            self.size = self.stored_size if size == self.stored_size else square
            check_pixels(path, *self.size)
            fps = float(capture.get(cv2.CAP_PROP_FPS))
            self.fps = fps if 0.0 < fps < 2000.0 else 24.0
            claimed = capture.get(cv2.CAP_PROP_FRAME_COUNT)
            shown_s = trimmed_s(path)
            self.is_trimmed = shown_s is not None
            if shown_s is not None:
                claimed = min(claimed, max(1.0, round(shown_s * self.fps)))
            self.notes = tuple(note for note in (dynamic_range_note(path),) if note)
            if shape != 1.0:
                stored = " x ".join(map(str, self.stored_size))
                scaled = f": its pictures of {stored} were scaled to {self.size[0]} x {self.size[1]}"
                unscaled = (
                    ", and its size is given as if they were square: the motion is out of shape; convert the "
                    "clip first, as with ffmpeg -i CLIP -vf scale=iw*sar:ih,setsar=1"
                )
                what = f"the pixels of {path.name} are {shape:.3g} times as wide as high"
                self.notes = (what + (scaled if self.size != self.stored_size else unscaled), *self.notes)
        most = path.stat().st_size // 8  # bytes a frame bound what a header may claim
        self.frame_count = int(min(claimed, most)) if np.isfinite(claimed) else 0
        if self.frame_count < 2:  # it claims nothing
            self.frame_count = sum(1 for _ in self.time_stamps())

    def frames(self) -> Iterator[tuple[int, float, Image]]:
        """Yield index, time in seconds and image of every frame; see `Clip.frames`.

        Frames that cannot be decoded, with others after them, are black: later ones keep their indices.
        """
        with self._capture() as capture:
            for index, (stamp, found) in enumerate(self._stamped(capture)):
                yield index, stamp, self._picture(capture, index) if found else self._nothing()

    def time_stamps(self) -> Iterator[float]:
        """Yield the time in seconds of every frame."""
        with self._capture() as capture:
            yield from (stamp for stamp, _ in self._stamped(capture))

    def at(self, indices: Sequence[int]) -> Iterator[tuple[int, Image]]:
        """Yield the frames of ascending indices, as far as they exist.

        Short gaps are decoded, long ones seeked; where seeking fails, the file is decoded from its beginning.
        """
        with self._capture() as capture:
            position = 0
            for done, index in enumerate(indices):
                if index - position > FRAMES_PER_SEEK:
                    found = capture.set(cv2.CAP_PROP_POS_FRAMES, index) and capture.grab()
                else:
                    found = all(capture.grab() for _ in range(index + 1 - position))
                if not found:  # damaged here; a pass from the beginning counts what is lost
                    wanted = set(indices[done:])
                    frames = ((number, picture) for number, _, picture in self.frames() if number in wanted)
                    yield from islice(frames, len(wanted))
                    return
                position = index + 1
                yield index, self._picture(capture, index)

    def sought(self, indices: Sequence[int]) -> Iterator[tuple[int, Image]]:
        """Yield frames by seeking to each, as far as that succeeds; see `packets`."""
        with self._capture() as capture:
            for index in indices:
                found = index == 0 or capture.set(cv2.CAP_PROP_POS_FRAMES, index)
                if found and capture.grab():
                    yield index, self._picture(capture, index)

    def onward(self, first: int) -> Iterator[tuple[float, Image]]:
        """Yield time in seconds and image of the frames from about `first` on.

        Seeks where that is quicker; at a variable frame rate it may begin with another frame, but the times
        are right.
        """
        with self._capture() as capture:
            index = 0
            if first > FRAMES_PER_SEEK and capture.set(cv2.CAP_PROP_POS_FRAMES, first):
                index = first
            for position, (stamp, found) in enumerate(self._stamped(capture, index), index):
                if position >= first:
                    yield stamp, self._picture(capture, position) if found else self._nothing()

    def _stamped(self, capture: cv2.VideoCapture, index: int = 0) -> Iterator[tuple[float, bool]]:
        """Yield the time of every frame from `index` on, and whether it was decoded.

        Decoders skip frames that they cannot decode, and may deliver others late. After the first failure the
        time stamps tell how many frames are lost.
        """
        damaged, previous = False, -np.inf
        for failures in _steps(capture):
            damaged = damaged or failures > 0
            stamp = self._stamp(capture, index, previous)
            if stamp is None and damaged:
                continue
            if stamp is None:  # no usable stamps: count
                stamp = max(index / self.fps, previous + 0.5 / self.fps)
            elif damaged and index > 0:
                lost = round((stamp - previous) * self.fps) - 1
                for _ in range(min(lost, self.frame_count - index - 1)):
                    previous += 1.0 / self.fps
                    yield previous, False
                    index += 1
            yield stamp, True
            previous = stamp
            index += 1

    def _stamp(self, capture: cv2.VideoCapture, index: int, previous: float) -> float | None:
        """The time of the frame just read; None if its stamp is invalid."""
        stamp = float(capture.get(cv2.CAP_PROP_POS_MSEC)) / 1000.0
        if np.isinf(previous):
            return stamp if 0.0 <= stamp < max(LONGEST_PAUSE_S, 2.0 * index / self.fps) else index / self.fps
        return stamp if previous < stamp < previous + LONGEST_PAUSE_S else None

    def _picture(self, capture: cv2.VideoCapture, index: int) -> Image:
        """The frame just read; black if it has no picture."""
        decoded, image = capture.retrieve()
        if not decoded or image is None:
            return self._nothing()
        size = (int(image.shape[1]), int(image.shape[0]))
        if size != self.stored_size:
            was = self.stored_size
            raise InputError(
                f"{self.path}: the picture changes its size from {was[0]} x {was[1]} to "
                f"{size[0]} x {size[1]} pixels after {index} frames; it must stay the same; {CONVERT}"
            )
        picture = np.ascontiguousarray(image, dtype=np.uint8)
        fill_last_rows(capture, picture)
        return picture if size == self.size else np.asarray(cv2.resize(picture, self.size), dtype=np.uint8)

    def _nothing(self) -> Image:
        return np.zeros((self.size[1], self.size[0], 3), dtype=np.uint8)

    @contextmanager
    def _capture(self) -> Iterator[cv2.VideoCapture]:
        name = os.path.abspath(self.path)  # a name of a word and a colon begins like FFmpeg's protocols
        with opencv_silence():
            capture = cv2.VideoCapture(name, cv2.CAP_FFMPEG)
            capture = capture if capture.isOpened() else cv2.VideoCapture(name, cv2.CAP_ANY)
        try:
            if not capture.isOpened():
                raise InputError(
                    f"{self.path}: cannot be decoded; it must be a video whose picture OpenCV can read, "
                    "and whole: where recording or copying was broken off, the index at its end is missing"
                )
            # Blender always shows the rotated picture; OpenCV's default differs between versions.
            capture.set(cv2.CAP_PROP_ORIENTATION_AUTO, 1)
            yield capture
        finally:
            capture.release()


def _steps(capture: cv2.VideoCapture) -> Iterator[int]:
    """Step from frame to frame; yield the number of decoder failures before each."""
    failures = 0
    while failures <= 500:  # the distance of two video keyframes
        if capture.grab():
            yield failures
            failures = 0
        else:
            failures += 1
