"""What is noticed of a clip's frames while they pass, and a person should know before trusting the result."""

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np

from ...arrays import Image
from .interlacing import combed_shares

SIDE = 64
"""Rows and columns of the pictures that are compared, about."""
COMBED_EVERY = 15
"""Frames between two that are looked at for combing."""
COMBED, _COMBED_MORE = 5e-4, 10.0
"""Share of an interlaced picture that is combed, and how much more than by columns. Sixteen clips
that are not interlaced stay below 1.2e-4 and three times as much; three made so have 1e-2 and more."""
COLORLESS = 10
"""Levels between the channels of gray, but for what compression adds."""
CUT = 10.0
"""Levels by which half of the picture changes at once where the scene does."""
CUT_MORE = 5.0
"""How many times what it usually changes."""
FEW_PIXELS = 4
"""So many of a small picture may have colors by accident."""
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
    """What was noticed of a clip."""

    frames: int = 0
    """How many were looked at."""
    blank: tuple[int, ...] = ()
    """Those in which nothing is to be seen, in order, counted from 0."""
    cuts: tuple[int, ...] = ()
    """Those that show quite another picture than the one before."""
    interlaced: bool = False
    """Whether pictures show two moments each."""

    def notes(self, first: int) -> tuple[str, ...]:
        """Sentences on what a person should know; the clip's first frame is called `first`."""
        notes = []
        if self.blank:
            notes.append(
                f"nothing is to be seen in {len(self.blank)} of {self.frames} frames "
                f"({_ranges(self.blank, first)}): they are black, or lost where the file is damaged"
            )
        if self.interlaced:
            notes.append(
                "the clip is interlaced: each picture shows two moments, so that what moves is torn and "
                "keyframes are less exact; convert it first, as with ffmpeg -i CLIP -vf bwdif=mode=send_frame"
            )
        if self.cuts:
            notes.append(
                f"the whole picture changes at frame {_ranges(self.cuts, first)}: a cut, a fade or another "
                "light; a take must show one scene from one place"
            )
        return tuple(notes)


NO_FINDINGS = FrameFindings()


class FrameChecks:
    """Looks at every frame once."""

    def __init__(self) -> None:
        """Begin; no frame was seen."""
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
        """Return what was noticed so far."""
        return FrameFindings(self._frames, tuple(self._blank), self._cuts(), self._interlaced())

    def nothing_seen(self) -> str | None:
        """Say why no marker can be found in the clip; None where that is not known."""
        if len(self._blank) == self._frames:
            return "nothing is to be seen in any frame: all are black, or of one color"
        if self._color < COLORLESS:
            return "the clip has no colors, by which markers are found; it must be filmed in color"
        return None

    def _interlaced(self) -> bool:
        if not self._combed:
            return False
        rows, columns = np.mean(self._combed, axis=0)
        return bool(rows > COMBED and rows > _COMBED_MORE * columns)

    def _cuts(self) -> tuple[int, ...]:
        usual = float(np.median(list(self._changes.values()))) if self._changes else 0.0
        return tuple(index for index, one in self._changes.items() if one > max(CUT, CUT_MORE * usual))


def _colorfulness(image: Image) -> int:
    """Levels between the channels of all but a few pixels, at most."""
    blue, green, red = cv2.split(image)
    brightest, darkest = cv2.max(cv2.max(blue, green), red), cv2.min(cv2.min(blue, green), red)
    spread = (brightest - darkest).ravel()
    last = spread.size - min(FEW_PIXELS, spread.size)
    return int(np.partition(spread, last)[last])


def _ranges(frames: Sequence[int], first: int) -> str:
    """Frames as people name them: 3 to 7, 12, 20 to 21."""
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
