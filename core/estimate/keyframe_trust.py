"""Evidence of posed and matched keyframes together: only posed ones calibrate markers and lens.

Placements, lens and posing error are calibrated on keyframes that a person has posed. Matched ones err by
more than any of these, and all in the same direction: calibrated on them, sleeves would make up for another
performer's gait.
"""

from collections.abc import Generator
from dataclasses import replace

import numpy as np

from ..arrays import Array, IndexArray
from ..body.posture import Posture
from ..observation.regions import RegionModel
from .keyframe_evidence import ContourReader, KeyframeEvidence, read_keyframes, uncalibrated
from .keypoint_evidence import KeypointEvidence
from .match_error import match_covariance
from .posing_error import posing_covariance
from .terms.keypoints import ObservedKeypoints
from .terms.regions import ObservedRegions, RegionNoise

FEWEST_POSED = 2
"""Fewer posed keyframes calibrate nothing."""


def read_mixed_keyframes(
    model: RegionModel,
    noise: RegionNoise,
    observed: ObservedRegions,
    width_px: Array,
    posture: Posture,
    frame: IndexArray,
    match_scale: Array,
    keypoints: KeypointEvidence | None = None,
    points: ObservedKeypoints | None = None,
    contours: ContourReader | None = None,
) -> Generator[None, None, KeyframeEvidence]:
    """Evidence of keyframes of which some may be matched.

    Args:
        model: The region model with average placements.
        noise: Noise of the regions' features.
        observed: Regions seen at the K keyframes.
        width_px: (K, M) half-width of each marker's limb there [px].
        posture: The K postures.
        frame: (K,) their places in the clip.
        match_scale: (K,) size of the matched ones' error, relative to a usual difference between performers;
            0 for posed ones.
        keypoints: Usual evidence of the N keypoints; None for none.
        points: Those seen at the K keyframes.
        contours: Reads the rows of contours at some of the keyframes; None where contours do not judge.
    """
    if not match_scale.any():
        reading = read_keyframes(
            model, noise, observed, width_px, posture, frame, keypoints, points, contours
        )
        return (yield from reading)
    posed = np.flatnonzero(match_scale == 0.0)
    information = np.linalg.inv(match_covariance(posture, model.camera, frame))
    information /= np.where(match_scale > 0.0, match_scale, 1.0)[:, None, None] ** 2
    if len(posed) >= FEWEST_POSED:
        reading = read_keyframes(
            model,
            noise,
            observed[posed],
            width_px[posed],
            posture[posed],
            frame[posed],
            keypoints,
            None if points is None else points[posed],
            contours,
        )
        evidence = yield from reading
        information[posed] = evidence.information
        return replace(evidence, information=information)
    if len(posed):
        information[posed] = np.linalg.inv(posing_covariance(model.body, model.body.pose(posture[posed])))
    evidence = replace(uncalibrated(model), information=information)
    return evidence if keypoints is None else replace(evidence, keypoints=keypoints)
