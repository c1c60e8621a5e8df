"""Weak frames: those worth another keyframe, the worst first, each with its reason.

An error between keyframes is taken to fall, frame by frame, in proportion to the distance from the nearest
one. A new keyframe's worth is the expected squared error that it removes, from its own frame and from those
around it: uncertainty and coverage in one. Frames are chosen greedily, as if those before were posed, so that
none lies beside another.
"""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array, BoolArray, IndexArray

WEAK_CONFIDENCE = 0.75  # frames of a higher confidence need no keyframe
FRAMES_PER_NAMED = 20  # frames of the clip for each one that is named
NEAREST_FRAMES = 4  # least distance of a named frame from a keyframe [frames]

TURNED = ("left hand", "right hand", "head")  # whose turn is seen by looks of their own


class Reason(StrEnum):
    """Why a frame is worth another keyframe."""

    HIDDEN = "hidden"  # a marker, a keypoint or a contour is hidden there
    FAST = "fast"  # the performer moves fast there
    FAR = "far"  # the next keyframe is far
    FOOTAGE = "footage"  # a marker, a keypoint or a contour is not where the motion puts it


@dataclass(frozen=True)
class WeakFrame:
    """A frame worth another keyframe."""

    index: int  # index in the clip, from 0
    reason: Reason
    strength: float  # worth of a keyframe there, relative to the worst frame's: 0 to 1
    marker: int | None = None  # the marker that is hidden or misplaced, where one is the reason
    point: str | None = None  # the body point whose keypoints, or segment whose contour, is the reason


@dataclass(frozen=True, eq=False)
class FrameEvidence:
    """Errors, confidence and observations of F frames: of M markers and K points or segments of the body."""

    squared_error: Array  # (F,) expected squared error of a frame, in any unit
    confidence: Array  # (F,) 0 to 1; NaN where unknown, which counts as weak
    quality: Array  # (F, M + K) quality of regions, contours and keypoints, 0 where hidden
    misfit: Array  # (F, M + K) as in `confidence`; NaN where not compared
    speed: Array  # (F,) V_sum
    points: tuple[str, ...] = ()  # (K,) the points and segments of the last columns


def find_weak_frames(evidence: FrameEvidence, keyframes: ArrayLike) -> tuple[WeakFrame, ...]:
    """Find the frames worth another keyframe, the worst first; `keyframes` are rising, at least one."""
    count = len(evidence.squared_error)
    posed = [int(index) for index in np.asarray(keyframes)]
    weak = ~(evidence.confidence >= WEAK_CONFIDENCE)
    left = evidence.squared_error.copy()
    edges = [-1, *posed, count]  # -1 and F stand for no keyframe
    gaps = [_best_in_gap(left, weak, *gap) for gap in zip(edges[:-1], edges[1:], strict=True)]
    found: list[tuple[float, int]] = []
    while gaps and len(found) < max(1, count // FRAMES_PER_NAMED):
        best = max(gaps)
        worth, index, first, last = best
        # Least worth of a named frame, as a share of the worst one's.
        if worth <= (0.2 * found[0][0] if found else 0.0):
            break
        found.append((worth, index))
        frame, distance = _gap(first, last, count)
        left[frame] *= np.minimum(np.abs(frame - index), distance) / distance
        gaps.remove(best)
        gaps += [_best_in_gap(left, weak, first, index), _best_in_gap(left, weak, index, last)]
    return tuple(_with_reason(evidence, posed, index, worth / found[0][0]) for worth, index in found)


def _gap(first: int, last: int, count: int) -> tuple[IndexArray, IndexArray]:
    """Frames between two keyframes, and the distance of each from the nearer one."""
    frame = np.arange(first + 1, last)
    before = frame - first if first >= 0 else np.full(len(frame), count)
    after = last - frame if last < count else np.full(len(frame), count)
    return frame, np.minimum(before, after)


def _best_in_gap(squared_error: Array, weak: BoolArray, first: int, last: int) -> tuple[float, int, int, int]:
    """The worth of the best new keyframe between two, its index, and the two; 0 where none is weak."""
    frame, distance = _gap(first, last, len(squared_error))
    candidates = frame[weak[frame] & (distance >= NEAREST_FRAMES)]
    if not len(candidates):
        return 0.0, 0, first, last
    # Largest number of frames tried in one gap, evenly spread.
    candidates = candidates[:: -(-len(candidates) // 400)]
    nearer = np.minimum(np.abs(frame - candidates[:, None]), distance)  # (C, N)
    worth = (1.0 - nearer / distance) @ squared_error[frame]
    best = int(worth.argmax())
    return float(worth[best]), int(candidates[best]), first, last


def _with_reason(evidence: FrameEvidence, keyframes: list[int], index: int, strength: float) -> WeakFrame:
    """The frame with the most noticeable reason."""
    count = len(evidence.squared_error)
    distance = min(abs(index - frame) for frame in keyframes)
    reach = max(2, distance // 2)
    nearby = slice(max(0, index - reach), index + reach + 1)
    usual_speed = max(float(np.median(evidence.speed)), 1e-9)
    # Each over what makes it a reason: the distance from keyframes in mean gaps, the speed in median speeds,
    # the share of frames in which something is hidden, and the misfit, whose root counts as it is squared.
    reasons: list[tuple[float, Reason, int | None]] = [
        (distance * len(keyframes) / count / 0.6, Reason.FAR, None),
        (float(evidence.speed[nearby].mean()) / usual_speed / 1.5, Reason.FAST, None),
    ]
    if evidence.quality.shape[1]:
        hidden = (evidence.quality[nearby] < 0.3).mean(axis=0)
        compared = np.isfinite(evidence.misfit[nearby])
        misfit = np.where(compared, evidence.misfit[nearby], 0.0).sum(0) / np.maximum(compared.sum(0), 1)
        reasons += [
            (float(hidden.max()) / 0.4, Reason.HIDDEN, int(hidden.argmax())),
            (float(misfit.max() / 2.0) ** 0.5, Reason.FOOTAGE, int(misfit.argmax())),
        ]
    _, reason, column = max(reasons, key=lambda entry: entry[0])
    markers = evidence.quality.shape[1] - len(evidence.points)
    if column is None or column < markers:
        return WeakFrame(index, reason, float(strength), column)
    return WeakFrame(index, reason, float(strength), point=evidence.points[column - markers])
