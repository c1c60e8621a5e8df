"""Which keypoints are believed: those that agree with the keyframes that a person has posed.

A detector may follow another person, lag behind the clip, or see nothing at all. At posed keyframes it is
known where points should be. One that is usually off there by more than a limb's width tells nothing of the
rest either; and where most of a source's points are, or all fit much better some frames earlier or later, the
whole source is left out.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..body.human import HUMAN
from ..body.kinematics import Pose
from ..observation.keypoints import USUAL_PLACES, KeypointModel
from .terms.keypoints import ObservedKeypoints

LIMB_WIDTH_M = 0.07
"""About the half-width of a thigh and the width of an arm [m]."""
TURNED = 2.0
"""How many of a point's usual errors are added to it: hands and feet turn."""
USUAL_QUANTILE = 0.4
"""Of the distances at the keyframes: a few that are far off are outliers, of a point that is believed."""
FEWEST_BELIEVED = 0.5
"""A source of whose principal points a smaller share is believed is left out."""
LONGEST_LAG = 15
"""Largest number of frames by which a source is thought to be early or late."""
LEAST_LAG = 2
LAGGED_SHARE = 0.6
"""A source is early or late if its points' usual distance becomes this share of what it is, or less."""
LEAST_MISFIT_M = 0.03
"""Nearer points are right as they stand [m]."""


@dataclass(frozen=True, eq=False)
class KeypointTrust:
    """What the keyframes say of N keypoints of several sources."""

    trust: Array
    """(N,) 1 for points that are believed, 0 for others."""
    distance_m: Array
    """(N,) usual distance across the view from where keyframes have each [m]; NaN where not seen at any."""
    lag: Mapping[str, int]
    """By source: frames by which it is late, or early where negative; 0 for one that is neither."""


def keypoint_trust(
    model: KeypointModel, sources: tuple[str, ...], points: ObservedKeypoints, pose: Pose, frame: IndexArray
) -> KeypointTrust:
    """Compare keypoints with posed keyframes.

    Args:
        model: The points at their usual places.
        sources: (N,) what saw each.
        points: Those seen in all F frames.
        pose: Poses of the K posed keyframes.
        frame: (K,) their frames.
    """
    predicted, depth = model.camera.project(model.world(pose), frame[:, None])
    predicted *= np.maximum(depth, 0.1)[..., None] / model.camera.focal_px  # to meters across the view
    scale = np.maximum(depth, 0.1) / model.camera.focal_px
    at_keyframes = _distances(points, predicted, scale, frame)
    usual = np.array([USUAL_PLACES[name].error_std_m for name in model.names])
    trust = np.where(at_keyframes > LIMB_WIDTH_M + TURNED * usual, 0.0, 1.0)
    lags = {}
    for source in dict.fromkeys(sources):
        own = np.array([name == source for name in sources])
        principal = own & np.array([name in HUMAN.point_names for name in model.names])
        counted = (principal if principal.any() else own) & np.isfinite(at_keyframes)
        if not counted.any():
            continue
        lags[source] = _lag(points, predicted, scale, frame, counted)
        if lags[source] or trust[counted].mean() < FEWEST_BELIEVED:
            trust[own] = 0.0
    return KeypointTrust(trust, at_keyframes, lags)


def _distances(points: ObservedKeypoints, predicted: Array, scale: Array, frame: IndexArray) -> Array:
    """(N,) usual distance [m] of the points seen in given frames from what is predicted, (K, N, 2) [m]."""
    distance = np.linalg.norm(points.pixel[frame] * scale[..., None] - predicted, axis=-1)
    usual = np.full(distance.shape[1], np.nan)
    known = np.isfinite(distance).any(axis=0)
    usual[known] = np.nanquantile(distance[:, known], USUAL_QUANTILE, axis=0)
    return usual


def _lag(points: ObservedKeypoints, predicted: Array, scale: Array, frame: IndexArray, own: BoolArray) -> int:
    frames, misfit = len(points.pixel), {}
    for lag in range(-LONGEST_LAG, LONGEST_LAG + 1):
        inside = (frame + lag >= 0) & (frame + lag < frames)
        if 2 * inside.sum() >= len(frame):
            found = _distances(points, predicted[inside], scale[inside], frame[inside] + lag)[own]
            if np.isfinite(found).any():
                misfit[lag] = float(np.nanmean(found))
    if misfit.get(0, 0.0) < LEAST_MISFIT_M:
        return 0
    best = min(misfit, key=lambda lag: misfit[lag])
    return best if abs(best) >= LEAST_LAG and misfit[best] < LAGGED_SHARE * misfit[0] else 0
