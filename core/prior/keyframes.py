"""Keyframes: frames with a given posture, posed by a person or found in the footage."""

from dataclasses import dataclass
from typing import Annotated

import numpy as np

from ..arrays import Array, IndexArray
from ..body.posture import Posture, headings_rad, yawed_at
from ..body.posture_spline import cubic_spline
from ..files.kinds import Number, Text
from ..files.records import Record
from .texts import REFERENCE

DOUBTFUL = 0.5  # confidence below which a found keyframe is doubtful: more likely wrong than about right


LONGEST_NAME = 200  # characters of a library's or a posture's name
Name = Annotated[str, Text(LONGEST_NAME, f"a name of at most {LONGEST_NAME} characters")]


@dataclass(frozen=True)
class Matched(Record):
    """Origin of a found keyframe: the posture of a library that it resembles."""

    library: Name
    """Identifier of the library that was matched, or `COMPOSED` where parts of several are put together."""
    posture: Name
    """Name of the nearest posture of the library."""
    mirrored: bool
    """Whether left and right are exchanged."""
    confidence: Annotated[float, Number(0.0, 1.0)]
    """Probability that it is about right, 0 to 1."""

    @property
    def is_doubtful(self) -> bool:
        """Whether the keyframe is worth a check."""
        return self.confidence < DOUBTFUL

    @property
    def is_referred(self) -> bool:
        """Whether it is that of a reference motion."""
        return self.library == REFERENCE


@dataclass(frozen=True, eq=False)
class Keyframe:
    """A frame with a given posture."""

    index: int  # frame index in the clip, 0 for the first decoded frame
    posture: Posture  # a single posture
    residual_m: float = 0.0  # mean distance of the points it was read from [m]; 0 where posed
    matched: Matched | None = None  # what was found; None for a keyframe that a person has posed or corrected
    depth_found: bool = False
    """Whether a person vouches for the picture only: corrected in the camera's view, at the depth found."""

    @property
    def is_posed(self) -> bool:
        """Whether a person vouches for its place in space."""
        return self.matched is None and not self.depth_found


# --- Turns the other way round


FULL_TURN = 2.0 * np.pi


def heading_steps_rad(posed: Posture) -> Array:
    """(K - 1,) turns from each of K postures to the next, the short way round, -π to π."""
    step = np.diff(headings_rad(posed))
    return np.asarray(step - FULL_TURN * np.round(step / FULL_TURN))


def with_turns(prior: Posture, keyframes: IndexArray, turns: IndexArray) -> Posture:
    """Interpolated postures with whole turns added between keyframes, spread smoothly.

    The heading is the monotone cubic (Fritsch & Carlson 1980) through the keyframes' headings unwound with
    these turns instead of without; leans and all else stay those of the interpolation, seen from the body.

    `turns` (K - 1,): counterclockwise seen from above, 0 for none.
    """
    if not turns.any():
        return prior
    from scipy.interpolate import PchipInterpolator

    wound = np.concatenate([[0.0], np.cumsum(heading_steps_rad(prior[keyframes]))])
    more = np.concatenate([[0.0], np.cumsum(FULL_TURN * turns)])
    frame = np.clip(np.arange(prior.batch[0]), keyframes[0], keyframes[-1])
    before, after = (PchipInterpolator(keyframes, heading)(frame) for heading in (wound, wound + more))
    added = after - before
    # Whole turns are none: far from those added the interpolation stays as it is, to the last digit.
    added -= FULL_TURN * np.round(added / FULL_TURN)
    added[np.abs(added) < 1e-9] = 0.0
    turned = np.flatnonzero(added)
    if not len(turned):
        return prior
    changed = yawed_at(prior[turned], added[turned], prior.translation[turned])
    rotations = prior.rotations.copy()
    rotations[turned] = changed.rotations
    return Posture(prior.skeleton, prior.translation, rotations, prior.angles)


# --- Interpolation


def interpolate(keyframes: tuple[Keyframe, ...], frame_count: int) -> Posture:
    """The a priori posture of every frame."""
    index = np.array([keyframe.index for keyframe in keyframes], dtype=np.float64)
    posed = Posture.stack([keyframe.posture for keyframe in keyframes])
    return cubic_spline(posed, index, np.arange(frame_count, dtype=np.float64))


# --- Doubt in found keyframes


BEYOND_S = 0.1  # time outside the found keyframes over which the nearest ceases to stand for them


def found_doubt(keyframes: tuple[Keyframe, ...], fps: float) -> Array:
    """(K,) deviation of keyframes that is left of a usual one: 1 where nothing was posed, 0 at posed ones.

    How a performer differs from what was found is a Gaussian process over time, which posed keyframes tell
    (Rasmussen & Williams 2006, ch. 2).
    """
    posed = np.array([keyframe.is_posed for keyframe in keyframes])
    doubt = np.where(posed, 0.0, 1.0)
    if posed.all() or not posed.any():
        return doubt
    index = np.array([keyframe.index for keyframe in keyframes])
    at, found = index[posed], index[~posed]
    beyond_s = np.maximum(np.maximum(found[0] - at, at - found[-1]), 0) / fps
    across = _covariance(at / fps, found / fps)
    known = _covariance(at / fps, at / fps) + np.diag(0.1 + (beyond_s / BEYOND_S) ** 2)
    left = 1.0 - np.sum(np.linalg.solve(known, across) * across, axis=0)
    doubt[~posed] = np.sqrt(np.maximum(left, 0.05))  # never none
    return doubt


def _covariance(one: Array, other: Array) -> Array:
    # Half of the variance is constant over a clip, the rest is correlated over half a second.
    return np.asarray(0.5 + 0.5 * np.exp(-np.abs(one[:, None] - other) / 0.5))
