"""What posed keyframes say of matched ones: the performer differs from the library's, and goes on differing.

A library's postures are another performer's. Where a person has posed a keyframe too, the difference between
both is known, and most of it is style, which holds all along the clip; the rest holds for a while. Both
together are a Gaussian process over time, the same for every degree of freedom, and the matched keyframes
take the mean that the posed ones leave of it (Rasmussen & Williams 2006, *Gaussian Processes for Machine
Learning*, eq. 2.23).
"""

from dataclasses import replace

import numpy as np

from ..arrays import Array
from ..body.posture import Posture
from .interpolation import interpolate
from .keyframes import Keyframe

LASTING_SHARE = 0.5
"""Of the difference's variance, what holds all along the clip."""
FORGETTING_S = 0.5
"""Time in which the rest of it is forgotten."""
POSED_VARIANCE = 0.1
"""Of a person's own error, beside the difference's."""
LEAST_VARIANCE = 0.05
"""Of the difference's variance, what no posed keyframe takes away."""
BEYOND_S = 0.1
"""So far outside the matched keyframes, the nearest of them is not what the library would have there."""


def with_offset(keyframes: tuple[Keyframe, ...], fps: float) -> tuple[tuple[Keyframe, ...], Array]:
    """The keyframes, the matched ones changed the way the posed ones differ from the library.

    Args:
        keyframes: Posed and matched ones, in order of frame.
        fps: Frames per second.

    Returns:
        The keyframes, and (K,) what is left of the usual difference between a performer and a library: 1
        where nothing was posed, less near posed ones, and 0 at these.
    """
    posed = [keyframe for keyframe in keyframes if keyframe.matched is None]
    matched = [keyframe for keyframe in keyframes if keyframe.matched is not None]
    doubt = np.array([0.0 if keyframe.matched is None else 1.0 for keyframe in keyframes])
    if not posed or not matched:
        return keyframes, doubt
    difference, beyond_s = _differences(posed, matched, fps)
    at, wanted = (np.array([k.index for k in some]) / fps for some in (posed, matched))
    known = _known(at, beyond_s)
    across = _covariance(at, wanted)
    share = np.linalg.solve(known, across).T  # (matched, posed)
    doubt[doubt > 0.0] = np.sqrt(np.maximum(1.0 - np.sum(share * across.T, axis=1), LEAST_VARIANCE))
    changed = Posture.stack([k.posture for k in matched]).plus(share @ difference)
    both = [*posed, *(replace(k, posture=changed[row]) for row, k in enumerate(matched))]
    return tuple(sorted(both, key=lambda keyframe: keyframe.index)), doubt


def leave_one_out_residuals(keyframes: tuple[Keyframe, ...], fps: float) -> tuple[Array, Array]:
    """How posed keyframes differ from what the library and the other posed ones say of them.

    Args:
        keyframes: Posed and matched ones, some of either.
        fps: Frames per second.

    Returns:
        (P, D) the differences, and (P,) what each counts: less, the farther it lies from matched keyframes.
    """
    posed = [keyframe for keyframe in keyframes if keyframe.matched is None]
    matched = [keyframe for keyframe in keyframes if keyframe.matched is not None]
    difference, beyond_s = _differences(posed, matched, fps)
    information = np.linalg.inv(_known(np.array([k.index for k in posed]) / fps, beyond_s))
    weight = 1.0 / (1.0 + (beyond_s / BEYOND_S) ** 2)
    return (information @ difference) / np.diag(information)[:, None], weight


def _known(at: Array, beyond_s: Array) -> Array:
    """(P, P) covariance of the differences at posed keyframes at times [s], a person's errors included."""
    return np.asarray(_covariance(at, at) + np.diag(POSED_VARIANCE + (beyond_s / BEYOND_S) ** 2))


def _differences(posed: list[Keyframe], matched: list[Keyframe], fps: float) -> tuple[Array, Array]:
    """From the library to each posed keyframe, (P, D), and how far that lies outside the matched ones [s]."""
    first, last = matched[0].index, matched[-1].index
    if len(matched) > 1:
        course = interpolate(tuple(matched), max(last, posed[-1].index) + 1)
    else:
        course = Posture.stack([matched[0].posture] * (max(last, posed[-1].index) + 1))
    index = np.array([keyframe.index for keyframe in posed])
    beyond = np.maximum(np.maximum(first - index, index - last), 0)
    return Posture.stack([keyframe.posture for keyframe in posed]).minus(course[index]), beyond / fps


def _covariance(one: Array, other: Array) -> Array:
    apart = np.abs(one[:, None] - other)
    return np.asarray(LASTING_SHARE + (1.0 - LASTING_SHARE) * np.exp(-apart / FORGETTING_S))
