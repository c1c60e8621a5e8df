"""Evidence of posed and matched keyframes together: only posed ones calibrate markers and lens.

Placements, lens and posing error are calibrated on keyframes that a person has posed. Matched ones err by
more than any of these, and all in the same direction: calibrated on them, sleeves would make up for another
performer's gait.
"""

from collections.abc import Generator
from dataclasses import replace

import numpy as np

from ..arrays import Array
from ..observation.regions import RegionModel
from .keyframe_evidence import KeyframeEvidence, SeenAtKeyframes, read_keyframes, uncalibrated
from .match_error import match_covariance
from .posing_error import posing_covariance
from .terms.regions import RegionNoise

FEWEST_POSED = 2
"""Fewer posed keyframes calibrate nothing."""


def read_mixed_keyframes(
    model: RegionModel, noise: RegionNoise, at: SeenAtKeyframes, match_scale: Array
) -> Generator[None, None, KeyframeEvidence]:
    """Evidence of keyframes of which some may be matched.

    Args:
        model: The region model with average placements.
        noise: Noise of the regions' features.
        at: The K keyframes.
        match_scale: (K,) size of the matched ones' error, relative to a usual difference between performers;
            0 for posed ones.
    """
    if not match_scale.any():
        return (yield from read_keyframes(model, noise, at))
    posed = np.flatnonzero(match_scale == 0.0)
    information = np.linalg.inv(match_covariance(at.posture, model.camera, at.frame))
    information /= np.where(match_scale > 0.0, match_scale, 1.0)[:, None, None] ** 2
    if len(posed) >= FEWEST_POSED:
        evidence = yield from read_keyframes(model, noise, at[posed])
        information[posed] = evidence.information
        return replace(evidence, information=information)
    if len(posed):
        information[posed] = np.linalg.inv(posing_covariance(model.body, model.body.pose(at.posture[posed])))
    evidence = replace(uncalibrated(model), information=information)
    return evidence if at.keypoints is None else replace(evidence, keypoints=at.keypoints)
