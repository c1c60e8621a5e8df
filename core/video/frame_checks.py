"""Checks of frames while they are read: blank ones, repeated ones, cuts, and interlacing."""

from collections import deque
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

import cv2
import numpy as np
from numpy.typing import NDArray

from ..arrays import Image
from ..errors import frames_in_words

STEP = 8  # difference of neighboring rows where a moving edge is combed, in levels
TEETH = 5  # alternating steps that make a comb; noise and textures seldom have as many


def _teeth(levels: NDArray[np.int16]) -> float:
    step = np.diff(levels, axis=0)
    if len(step) < TEETH:
        return 0.0
    step[1::2] *= -1
    windows = len(step) - TEETH + 1
    up, down = step > STEP, step < -STEP
    rising = np.logical_and.reduce([up[tooth : tooth + windows] for tooth in range(TEETH)])
    falling = np.logical_and.reduce([down[tooth : tooth + windows] for tooth in range(TEETH)])
    return float(np.mean(rising | falling))


@dataclass(frozen=True)
class FrameFindings:
    """Findings of the frame checks of a clip."""

    frames: int = 0  # number of checked frames
    blank: tuple[int, ...] = ()  # indices of blank frames, in order
    cuts: tuple[int, ...] = ()  # indices of frames after a cut
    changes: tuple[int, ...] = ()  # indices of frames in which the whole picture changes, beside cuts
    interlaced: bool = False  # whether each picture consists of two fields
    repeated: tuple[int, ...] = ()  # indices of frames whose picture is that of the frame before

    def notes(self, first: int, fps: float | None = None) -> tuple[str, ...]:
        """The findings as sentences; the clip's first frame has the number `first`, `fps` is its rate."""
        notes = []
        if self.blank:
            notes.append(
                f"{len(self.blank)} of {self.frames} frames {'is' if len(self.blank) == 1 else 'are'} blank "
                f"({self._named(self.blank, first)}): black, or lost where the file is damaged"
            )
        if self.interlaced:
            notes.append(
                "the clip is interlaced: each picture shows two moments, so that moving things are "
                "torn and keyframes are less exact; convert it first, as with ffmpeg -i CLIP -vf "
                "bwdif=mode=send_frame"
            )
        if self.repeated:
            repeat = "repeats" if len(self.repeated) == 1 else "repeat"
            share = None if fps is None else _share_of_own(self.repeated)
            own = "" if fps is None or share is None else f" of {fps * share:.0f} pictures a second"
            notes.append(
                f"{len(self.repeated)} of {self.frames} pictures {repeat} the one before "
                f"({self._named(self.repeated, first)}), as where a clip{own} was saved at a "
                "higher rate; each counts once, and the motion goes on in between"
            )
        if self.changes:
            notes.append(
                f"the whole picture changes at {self._named(self.changes, first)}: a flash, a fade or "
                "another light; a take must show one scene from one place"
            )
        if self.cuts:
            notes.append(self.cut_note(first))
        return tuple(notes)

    def cut_note(self, first: int) -> str:
        """A sentence with the frame of each cut; the clip's first frame has the number `first`."""
        return f"the clip is cut at {frames_in_words((cut + first for cut in self.cuts), MOST_CUTS)}"

    @staticmethod
    def _named(frames: Sequence[int], first: int) -> str:
        return frames_in_words((frame + first for frame in frames), 3)


NO_FINDINGS = FrameFindings()
MOST_CUTS = 12  # that are named

ALIKE = 0.85
"""Least correlation of two pictures of one shot: in twenty clips neighbors stay above 0.93; pictures of two
rooms, and of one from elsewhere or at another size, are below it."""
CUT_LEVELS = 5.0  # by which half of the pixels change at a cut, at least
ALONE = 3.0  # how many times more a cut changes than the frames beside it: fast pans go on
FLASH = 4  # frames to either side over which a cut stays


class FrameChecks:
    """Checks every frame once, in order."""

    def __init__(self) -> None:
        self._frames = 0
        self._blank: list[int] = []
        self._color = 0
        self._combed: list[tuple[float, float]] = []
        self._last: Image | None = None
        self._changes: dict[int, float] = {}
        self._moved: dict[int, float] = {}
        self._unlike: dict[int, float] = {}  # 1 less the correlation with the picture before
        self._recent: deque[Image] = deque(maxlen=FLASH)
        self._open: dict[int, tuple[int, Image]] = {}
        """Possible cuts: frames that are yet to be seen, and a picture some frames before."""
        self._stays: set[int] = set()

    def add(self, index: int, image: Image) -> bool:
        """Look at a frame (rows, columns, 3); tell whether anything is to be seen in it."""
        self._frames += 1
        if is_blank(image):
            self._blank.append(index)
            return False
        small = _thinned(image).copy()
        spread = np.sort(np.ptp(small, axis=-1), axis=None)  # of each pixel's channels
        self._color = max(self._color, int(spread[max(len(spread) - 4, 0)]))  # some have colors by accident
        if index % 15 == 0:
            # By rows, as of interlacing, and by columns, to compare.
            green = image[..., 1].astype(np.int16)
            down, across = (max(length // 320, 1) for length in image.shape[:2])
            self._combed.append((_teeth(green[:, ::across]), _teeth(green[::down].T)))
        if self._last is not None:
            change = cv2.absdiff(small, self._last)
            self._changes[index] = float(np.median(change))
            self._moved[index] = float(change.mean())
            self._unlike[index] = 1.0 - _likeness(small, self._last)
            if self._changes[index] > CUT_LEVELS and self._unlike[index] > 1.0 - ALIKE:
                self._open[index] = (FLASH, self._recent[0])
        for cut, (left, before) in list(self._open.items()):
            self._open[cut] = (left - 1, before)
            if left == 1:
                del self._open[cut]
                self._stays |= {cut} if 1.0 - _likeness(small, before) > 0.5 * self._unlike[cut] else set()
        self._recent.append(small)
        self._last = small
        return True

    def findings(self) -> FrameFindings:
        """The findings so far."""
        usual = float(np.median(list(self._changes.values()))) if self._changes else 0.0
        known, unlike = list(self._unlike), [0.0, *self._unlike.values(), 0.0]
        cuts = tuple(  # frames that show another picture all at once, which stays
            index
            for index, before, own, after in zip(known, unlike, unlike[1:], unlike[2:], strict=False)
            if index in self._stays and own > ALONE * max(before, after)
        )
        # Levels, and several times the usual change.
        changed = [index for index, one in self._changes.items() if one > max(10.0, 5.0 * usual)]
        changes = tuple(index for index in changed if index not in cuts)
        rows, columns = np.mean(self._combed, axis=0) if self._combed else (0.0, 0.0)
        # Sixteen progressive clips stay below 1.2e-4 and a ratio of three, three interlaced ones have 1e-2.
        interlaced = bool(rows > 5e-4 and rows > 10.0 * columns)
        repeated = _repeated(self._moved)
        return FrameFindings(self._frames, tuple(self._blank), cuts, changes, interlaced, repeated)

    def nothing_seen(self) -> str | None:
        """The reason why no marker can be found in the clip; None without one."""
        if len(self._blank) == self._frames:
            return "all frames are blank: black, or of one color"
        if self._color < 10:  # levels, after compression
            return "the clip has no colors, by which markers are found; it must be filmed in color"
        return None


def _likeness(one: Image, other: Image) -> float:
    """Correlation of two small pictures' brightness, which no change of light but one of layout lowers."""
    levels = [cv2.GaussianBlur(image.mean(axis=-1), (0, 0), 1.5) for image in (one, other)]
    first, second = (each - each.mean() for each in levels)
    return float((first * second).sum() / (np.linalg.norm(first) * np.linalg.norm(second) + 1.0))


STOPS = 6.0
"""How many times smaller the change of a repeated picture is than those before and after it: it is what
compression leaves. Whoever comes to rest slows down over several frames."""
MOST_REPEATS = 10  # frames in a row; for longer there is nothing to be seen
LEAST_CHANGE = 0.15  # levels, in the mean of the picture, from which anything moves


def _repeated(moved: Mapping[int, float]) -> tuple[int, ...]:
    """Frames in which nothing moves all at once, between such in which it does."""
    found: list[int] = []
    run: list[int] = []
    before = 0.0  # change of the last frame that was none of the run's
    for index, change in moved.items():
        if run and change > STOPS * max(moved[one] for one in run):
            found += run if change > LEAST_CHANGE and len(run) <= MOST_REPEATS else []
            run, before = [], change
        elif change * STOPS < before and (run or before > LEAST_CHANGE):
            run.append(index)
        else:
            run, before = [], change
    return tuple(found)


FEWEST_REPEATS = 3  # of which a pattern is told
LONGEST_PATTERN = 25  # frames after which repeats recur: 24 of 25
FITTING, NOTICED = 0.95, 0.75  # least shares of the repeats that are in the pattern, and of those in it


def _share_of_own(repeated: Sequence[int]) -> Fraction | None:
    """The share of a clip's pictures that are its own: the largest whose even pattern has the repeats.

    None where they have no pattern, as where single pictures were lost.
    """
    pairs = ((own, length) for length in range(2, LONGEST_PATTERN + 1) for own in range(1, length))
    for share in sorted({Fraction(*pair) for pair in pairs}, reverse=True):
        own, length = share.as_integer_ratio()
        pattern = np.diff(np.arange(-1, length) * own // length) == 0
        place = np.bincount(np.mod(repeated, length), minlength=length)
        fitting = max(place @ np.roll(pattern, phase) for phase in range(length))
        expected = (1 - share) * (repeated[-1] - repeated[0] + 1)
        if fitting >= FITTING * len(repeated) and len(repeated) >= max(NOTICED * expected, FEWEST_REPEATS):
            return share
    return None


def is_blank(image: Image) -> bool:
    """Whether a picture (rows, columns, 3) shows one even color and nothing else."""
    # Channel by channel: the first tells of almost every picture, and partitions along an axis are slow.
    for levels in np.moveaxis(_thinned(image), -1, 0).reshape(3, -1):
        stray = int(0.005 * len(levels))  # noise, or a clock in a corner
        ordered = np.partition(levels, (stray, len(levels) - 1 - stray))
        if int(ordered[len(levels) - 1 - stray]) - int(ordered[stray]) > 12:  # levels
            return False
    return True


def _thinned(image: Image) -> Image:
    """Some 64 rows or columns of a picture, whichever are fewer."""
    step = max(min(image.shape[:2]) // 64, 1)
    return image[step // 2 :: step, step // 2 :: step]
