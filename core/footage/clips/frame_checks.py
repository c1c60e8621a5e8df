"""Frame checks while a clip is read: blank frames, cuts, interlacing and missing color."""

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np

from ...arrays import Image
from .interlacing import combed_shares

SIDE = 64
"""Rows and columns, about, of the pictures that are compared."""
COMBED_EVERY = 15
"""Frames between two that are checked for combing."""
COMBED, COMBED_MORE = 5e-4, 10.0
"""Combed share of an interlaced picture by rows, and its ratio to that by columns. Sixteen progressive clips
stay below 1.2e-4 and a ratio of three; three interlaced ones have 1e-2 and more."""
COLORLESS = 10
"""Difference of the channels of a gray pixel after compression, in levels."""
CUT = 10.0
"""Change of the median pixel at a cut, in levels."""
CUT_MORE = 5.0
"""Ratio of that change to the clip's usual one."""
FEW_PIXELS = 4
"""Pixels of a small picture that may have colors by accident."""
NAMED = 3
"""Ranges of frames that a note lists."""
BLANK_SAMPLES = 64
"""Sampled rows and columns, about, in the test for a blank frame."""
BLANK_CONTRAST = 12
"""Levels between the darkest and the brightest pixel of a blank frame, but for stray pixels."""
BLANK_STRAY_SHARE = 0.005
"""Share of pixels that noise or a clock in a corner may make brighter or darker."""


@dataclass(frozen=True)
class FrameFindings:
    """Findings of the frame checks of a clip."""

    frames: int = 0
    """Number of checked frames."""
    blank: tuple[int, ...] = ()
    """Indices of blank frames, in order."""
    cuts: tuple[int, ...] = ()
    """Indices of frames after a cut."""
    interlaced: bool = False
    """Whether each picture consists of two fields."""

    def notes(self, first: int) -> tuple[str, ...]:
        """The findings as sentences; the clip's first frame has the number `first`."""
        notes = []
        if self.blank:
            notes.append(
                f"{len(self.blank)} of {self.frames} frames are blank "
                f"({_ranges(self.blank, first)}): black, or lost where the file is damaged"
            )
        if self.interlaced:
            notes.append(
                "the clip is interlaced: each picture shows two moments, so that moving things are "
                "torn and keyframes are less exact; convert it first, as with ffmpeg -i CLIP -vf "
                "bwdif=mode=send_frame"
            )
        if self.cuts:
            notes.append(
                f"the whole picture changes at frame {_ranges(self.cuts, first)}: a cut, a fade or "
                "another light; a take must show one scene from one place"
            )
        return tuple(notes)


NO_FINDINGS = FrameFindings()


class FrameChecks:
    """Checks every frame once, in order."""

    def __init__(self) -> None:
        """Begin without frames."""
        self._frames = 0
        self._blank: list[int] = []
        self._color = 0
        self._combed: list[tuple[float, float]] = []
        self._last: Image | None = None
        self._changes: dict[int, float] = {}

    def add(self, index: int, image: Image) -> bool:
        """Look at a frame (rows, columns, 3); tell whether anything is to be seen in it."""
        self._frames += 1
        if is_blank(image):
            self._blank.append(index)
            return False
        step = max(min(image.shape[:2]) // SIDE, 1)
        small = image[step // 2 :: step, step // 2 :: step].copy()
        self._color = max(self._color, _colorfulness(small))
        if index % COMBED_EVERY == 0:
            self._combed.append(combed_shares(image))
        if self._last is not None:
            self._changes[index] = float(np.median(cv2.absdiff(small, self._last)))
        self._last = small
        return True

    def findings(self) -> FrameFindings:
        """The findings so far."""
        return FrameFindings(self._frames, tuple(self._blank), self._cuts(), self._interlaced())

    def nothing_seen(self) -> str | None:
        """The reason why no marker can be found in the clip; None without one."""
        if len(self._blank) == self._frames:
            return "all frames are blank: black, or of one color"
        if self._color < COLORLESS:
            return "the clip has no colors, by which markers are found; it must be filmed in color"
        return None

    def _interlaced(self) -> bool:
        if not self._combed:
            return False
        rows, columns = np.mean(self._combed, axis=0)
        return bool(rows > COMBED and rows > COMBED_MORE * columns)

    def _cuts(self) -> tuple[int, ...]:
        usual = float(np.median(list(self._changes.values()))) if self._changes else 0.0
        return tuple(index for index, one in self._changes.items() if one > max(CUT, CUT_MORE * usual))


def _colorfulness(image: Image) -> int:
    """Largest difference of the channels of a pixel in levels, but for a few pixels."""
    blue, green, red = cv2.split(image)
    brightest, darkest = cv2.max(cv2.max(blue, green), red), cv2.min(cv2.min(blue, green), red)
    spread = (brightest - darkest).ravel()
    last = spread.size - min(FEW_PIXELS, spread.size)
    return int(np.partition(spread, last)[last])


def _ranges(frames: Sequence[int], first: int) -> str:
    """Frame ranges as text: 3 to 7, 12, 20 to 21."""
    runs: list[list[int]] = []
    for frame in frames:
        if runs and frame == runs[-1][1] + 1:
            runs[-1][1] = frame
        else:
            runs.append([frame, frame])
    named = [f"{a + first}" if a == b else f"{a + first} to {b + first}" for a, b in runs[:NAMED]]
    return ", ".join(named) + (f" and {len(runs) - NAMED} more times" if len(runs) > NAMED else "")


def is_blank(image: Image) -> bool:
    """Whether a picture (rows, columns, 3) shows one even color and nothing else."""
    step = max(min(image.shape[:2]) // BLANK_SAMPLES, 1)
    sampled = image[step // 2 :: step, step // 2 :: step]
    # Channel by channel: the first tells of almost every picture, and partitions along an axis are slow.
    return not any(_has_contrast(sampled[..., channel].ravel()) for channel in range(3))


def _has_contrast(levels: Image) -> bool:
    stray = int(BLANK_STRAY_SHARE * len(levels))
    ordered = np.partition(levels, (stray, len(levels) - 1 - stray))
    return bool(int(ordered[len(levels) - 1 - stray]) - int(ordered[stray]) > BLANK_CONTRAST)
