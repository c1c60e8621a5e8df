"""What the footage at the keyframes tells: where the markers sit, and how well the keyframes were posed."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..body.posture import Posture
from ..observation.regions import RegionModel
from .calibration import KnownFrames, calibrate
from .posing_error import KeyframeInnovation, estimate_posing_scale, posing_covariance
from .terms.regions import ObservedRegions, RegionNoise, feature_rows

Array = NDArray[np.float64]

LEAST_TRUSTED = 0.5
"""Regions hidden or doubted further than this do not judge a keyframe."""


@dataclass(frozen=True, eq=False)
class KeyframeEvidence:
    """The calibrated model and the trust that the K keyframes deserve."""

    model: RegionModel
    posing_scale: float
    """Size of the posing error relative to a person's usual one."""
    information: Array
    """(K, D, D) inverse covariance of each keyframe's posing error."""


def read_keyframes(
    model: RegionModel,
    noise: RegionNoise,
    observed: ObservedRegions,
    width_px: Array,
    posture: Posture,
    frame: NDArray[np.intp],
) -> KeyframeEvidence:
    """Calibrate the markers on the keyframes and judge the keyframes by the markers.

    Args:
        model: The region model with average placements.
        noise: Noise of the regions' features.
        observed: Regions seen at the K keyframes.
        width_px: (K, M) half-width of each marker's limb there [px].
        posture: The K posed postures.
        frame: (K,) their places in the clip.
    """
    spread = noise.surface_std(width_px) ** 2 + noise.bias_std(width_px) ** 2
    variance = noise.pixel_std_px**2 + spread  # (K, M, 5), slow biases included
    known = KnownFrames(model.body.pose(posture), frame, observed, np.sqrt(variance))
    placements = calibrate(model.body, model.camera, model.placements, known)
    calibrated = RegionModel(model.body, model.camera, placements)
    posing = posing_covariance(model.body, known.pose)
    scale = estimate_posing_scale(_innovations(calibrated, known, variance, posing))
    return KeyframeEvidence(calibrated, scale, np.linalg.inv(posing * scale**2))


def _innovations(
    model: RegionModel, known: KnownFrames, variance: Array, posing: Array
) -> list[KeyframeInnovation]:
    predicted = model.evaluate(known.pose, known.frame, jacobian=True)
    residual, jacobian = feature_rows(known.observed, predicted)
    assert jacobian is not None
    usable = (
        np.isfinite(residual).all(-1)
        & (predicted.visible > LEAST_TRUSTED)
        & (known.observed.quality > LEAST_TRUSTED)
    )
    return [
        KeyframeInnovation(
            residual[k][usable[k]].ravel(),
            jacobian[k][usable[k]].reshape(-1, jacobian.shape[-1]),
            variance[k][usable[k]].ravel(),
            posing[k],
        )
        for k in range(len(residual))
        if usable[k].any()
    ]
