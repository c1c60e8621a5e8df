"""What is known at the keyframes of a clip: posed ones calibrate markers and lens, matched ones do not.

How markers sit, the lens and the posing error are read from keyframes that a person has posed. Matched ones
are off by more than any of these, and all in the same direction: calibrated on them, sleeves would make up
for another performer's gait.
"""

from collections.abc import Generator
from dataclasses import replace

import numpy as np

from ..arrays import Array, IndexArray
from ..body.posture import Posture
from ..observation.regions import RegionModel
from .keyframe_evidence import KeyframeEvidence, read_keyframes, uncalibrated
from .match_error import match_covariance
from .posing_error import posing_covariance
from .terms.regions import ObservedRegions, RegionNoise

FEWEST_POSED = 2
"""Fewer posed keyframes than these calibrate nothing."""


def read_trust(
    model: RegionModel,
    noise: RegionNoise,
    observed: ObservedRegions,
    width_px: Array,
    posture: Posture,
    frame: IndexArray,
    doubt: Array,
) -> Generator[None, None, KeyframeEvidence]:
    """The evidence of keyframes of which some may be matched; arguments as `read_keyframes`.

    Args:
        model: The region model with average placements.
        noise: Noise of the regions' features.
        observed: Regions seen at the K keyframes.
        width_px: (K, M) half-width of each marker's limb there [px].
        posture: The K postures.
        frame: (K,) their places in the clip.
        doubt: (K,) how far matched ones are off, in usual differences between performers; 0 for posed ones.
    """
    if not doubt.any():
        return (yield from read_keyframes(model, noise, observed, width_px, posture, frame))
    posed = np.flatnonzero(doubt == 0.0)
    information = np.linalg.inv(match_covariance(posture, model.camera, frame))
    information /= np.where(doubt > 0.0, doubt, 1.0)[:, None, None] ** 2
    if len(posed) >= FEWEST_POSED:
        reading = read_keyframes(model, noise, observed[posed], width_px[posed], posture[posed], frame[posed])
        evidence = yield from reading
        information[posed] = evidence.information
        return replace(evidence, information=information)
    if len(posed):
        information[posed] = np.linalg.inv(posing_covariance(model.body, model.body.pose(posture[posed])))
    return replace(uncalibrated(model), information=information)
