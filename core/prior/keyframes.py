"""Keyframes: frames with a given posture, posed by a person or found in the footage."""

from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np
from scipy.interpolate import PchipInterpolator

from ..arrays import Array, IndexArray
from ..body.posture import Posture, headings_rad, yawed_at
from ..body.posture_spline import cubic_spline
from ..files.kinds import Number, Text
from ..files.records import Record
from .texts import COMPOSED, REFERENCE

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
    def is_composed(self) -> bool:
        """Whether it was made for this performer in this footage, of no single library."""
        return self.library in (COMPOSED, REFERENCE)

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


# --- Performer offset


CONSTANT_SHARE = (
    0.5  # share of the variance of a performer's offset from a library that is constant over a clip
)
BEYOND_S = (
    0.1  # time outside the matched keyframes over which the nearest ceases to stand for the library [s]
)


def with_offset(keyframes: tuple[Keyframe, ...], fps: float) -> tuple[tuple[Keyframe, ...], Array]:
    """Move the keyframes matched with a library by the performer's offset, learned at the posed ones.

    With (K,) the offset's remaining standard deviation relative to its prior one: 1 where nothing was posed,
    less near posed keyframes, and 0 at these.
    """
    posed = [keyframe for keyframe in keyframes if keyframe.is_posed]
    found = [keyframe for keyframe in keyframes if not keyframe.is_posed]
    matched = [key for key in found if key.matched is not None and not key.matched.is_composed]
    doubt = np.array([0.0 if keyframe.is_posed else 1.0 for keyframe in keyframes])
    if not posed or not found:
        return keyframes, doubt
    difference, beyond_s = _differences(posed, matched or found, fps)
    at, wanted = (np.array([k.index for k in some]) / fps for some in (posed, found))
    known = _known(at, beyond_s)
    across = _covariance(at, wanted)
    share = np.linalg.solve(known, across).T  # (found, posed)
    doubt[doubt > 0.0] = np.sqrt(np.maximum(1.0 - np.sum(share * across.T, axis=1), 0.05))  # never none
    step = np.where([[key in matched] for key in found], share @ difference, 0.0)
    changed = Posture.stack([key.posture for key in found]).plus(step)
    both = [*posed, *(replace(key, posture=changed[row]) for row, key in enumerate(found))]
    return tuple(sorted(both, key=lambda keyframe: keyframe.index)), doubt


def leave_one_out_residuals(keyframes: tuple[Keyframe, ...], fps: float) -> tuple[Array, Array]:
    """Leave-one-out residuals of posed keyframes, predicted from the library and the other posed ones.

    Rasmussen & Williams (2006), eq. 5.12.

    (P, D), and (P,) their weights: less, the farther one lies from matched keyframes.
    """
    posed = [keyframe for keyframe in keyframes if keyframe.matched is None]
    matched = [keyframe for keyframe in keyframes if keyframe.matched is not None]
    difference, beyond_s = _differences(posed, matched, fps)
    information = np.linalg.inv(_known(np.array([k.index for k in posed]) / fps, beyond_s))
    weight = 1.0 / (1.0 + (beyond_s / BEYOND_S) ** 2)
    return (information @ difference) / np.diag(information)[:, None], weight


def _known(at: Array, beyond_s: Array) -> Array:
    """(P, P) covariance of the observed offsets at posed keyframes' times [s], observation noise included."""
    noise = 0.1 + (beyond_s / BEYOND_S) ** 2
    return np.asarray(_covariance(at, at) + np.diag(noise))


def _differences(posed: list[Keyframe], matched: list[Keyframe], fps: float) -> tuple[Array, Array]:
    """Offset from the library to each posed keyframe (P, D), and its time outside the matched ones [s]."""
    first, last = matched[0].index, matched[-1].index
    if len(matched) > 1:
        predicted = interpolate(tuple(matched), max(last, posed[-1].index) + 1)
    else:
        predicted = Posture.stack([matched[0].posture] * (max(last, posed[-1].index) + 1))
    index = np.array([keyframe.index for keyframe in posed])
    beyond = np.maximum(np.maximum(first - index, index - last), 0)
    return Posture.stack([keyframe.posture for keyframe in posed]).minus(predicted[index]), beyond / fps


def _covariance(one: Array, other: Array) -> Array:
    alike = np.exp(-np.abs(one[:, None] - other) / 0.5)  # the rest is correlated over this time [s]
    return np.asarray(CONSTANT_SHARE + (1.0 - CONSTANT_SHARE) * alike)
