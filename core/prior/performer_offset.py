"""Performer offset: the performer's difference from a library, a Gaussian process learned at posed keyframes.

A library's postures are another performer's. At a posed keyframe the difference to the library is known; most
of it is the performer's style, which is constant over the clip, and the rest decays with time. The sum is a
Gaussian process over time, the same for every degree of freedom, and the matched keyframes are moved by its
posterior mean given the posed ones (Rasmussen & Williams 2006, *Gaussian Processes for Machine Learning*,
eq. 2.23). Postures that were composed for this performer in this footage stay where they are.
"""

from dataclasses import replace

import numpy as np

from ..arrays import Array
from ..body.posture import Posture
from .interpolation import interpolate
from .keyframes import Keyframe

CONSTANT_SHARE = 0.5
"""Share of the offset's variance that is constant over the clip."""
CORRELATION_TIME_S = 0.5
"""Correlation time of the rest."""
POSED_VARIANCE = 0.1
"""Variance of a person's own error, relative to the offset's."""
LEAST_VARIANCE = 0.05
"""Share of the offset's variance that remains beside any posed keyframe."""
BEYOND_S = 0.1
"""Time outside the matched keyframes over which the nearest of them ceases to stand for the library."""


def with_offset(keyframes: tuple[Keyframe, ...], fps: float) -> tuple[tuple[Keyframe, ...], Array]:
    """Move the keyframes matched with a library by the performer's offset, learned at the posed ones.

    Args:
        keyframes: Posed and matched ones, in order of frame.
        fps: Frames per second.

    Returns:
        The keyframes, and (K,) the offset's remaining standard deviation relative to its prior one: 1 where
        nothing was posed, less near posed keyframes, and 0 at these.
    """
    posed = [keyframe for keyframe in keyframes if keyframe.matched is None]
    found = [keyframe for keyframe in keyframes if keyframe.matched is not None]
    matched = [key for key in found if key.matched is not None and not key.matched.is_composed]
    doubt = np.array([0.0 if keyframe.matched is None else 1.0 for keyframe in keyframes])
    if not posed or not found:
        return keyframes, doubt
    difference, beyond_s = _differences(posed, matched or found, fps)
    at, wanted = (np.array([k.index for k in some]) / fps for some in (posed, found))
    known = _known(at, beyond_s)
    across = _covariance(at, wanted)
    share = np.linalg.solve(known, across).T  # (found, posed)
    doubt[doubt > 0.0] = np.sqrt(np.maximum(1.0 - np.sum(share * across.T, axis=1), LEAST_VARIANCE))
    step = np.where([[key in matched] for key in found], share @ difference, 0.0)
    changed = Posture.stack([key.posture for key in found]).plus(step)
    both = [*posed, *(replace(key, posture=changed[row]) for row, key in enumerate(found))]
    return tuple(sorted(both, key=lambda keyframe: keyframe.index)), doubt


def leave_one_out_residuals(keyframes: tuple[Keyframe, ...], fps: float) -> tuple[Array, Array]:
    """Leave-one-out residuals of posed keyframes, predicted from the library and the other posed ones.

    Rasmussen & Williams (2006), eq. 5.12.

    Args:
        keyframes: Posed and matched ones, at least one of either.
        fps: Frames per second.

    Returns:
        (P, D) the residuals, and (P,) their weights: less, the farther one lies from matched keyframes.
    """
    posed = [keyframe for keyframe in keyframes if keyframe.matched is None]
    matched = [keyframe for keyframe in keyframes if keyframe.matched is not None]
    difference, beyond_s = _differences(posed, matched, fps)
    information = np.linalg.inv(_known(np.array([k.index for k in posed]) / fps, beyond_s))
    weight = 1.0 / (1.0 + (beyond_s / BEYOND_S) ** 2)
    return (information @ difference) / np.diag(information)[:, None], weight


def _known(at: Array, beyond_s: Array) -> Array:
    """(P, P) covariance of the observed offsets at posed keyframes' times [s], observation noise included."""
    return np.asarray(_covariance(at, at) + np.diag(POSED_VARIANCE + (beyond_s / BEYOND_S) ** 2))


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
    apart = np.abs(one[:, None] - other)
    return np.asarray(CONSTANT_SHARE + (1.0 - CONSTANT_SHARE) * np.exp(-apart / CORRELATION_TIME_S))
