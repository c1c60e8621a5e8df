"""Comparison of a take's keypoints with the places where its motion puts them."""

import numpy as np

from ..estimate.keypoint_evidence import KeypointEvidence
from ..estimate.keypoint_fit import KeypointFit, keypoint_fit
from ..estimate.reconstruct import Reconstruction
from ..estimate.terms.keypoints import ObservedKeypoints
from .compared_keypoints import ComparedKeypoints


def compare_keypoints(reconstruction: Reconstruction) -> ComparedKeypoints:
    """The performer's keypoints beside the motion's, with what the estimate made of them.

    A method that does not follow keypoints is compared with them as if they were where they usually are.

    Args:
        reconstruction: The result of `reconstruct`.
    """
    if not reconstruction.keypoints.names:
        return ComparedKeypoints.none(len(reconstruction.motion.time_s))
    fit = reconstruction.keypoint_fit or _usual_fit(reconstruction)
    return ComparedKeypoints(
        names=fit.keypoints.names,
        sources=fit.keypoints.sources,
        seen=fit.keypoints.pixel,
        predicted=fit.predicted_px,
        confidence=ObservedKeypoints.of(fit.keypoints).confidence,
        distance_px=fit.residual_px,
        expected_px=fit.std_px,
        thrown_out=fit.thrown_out,
        swapped=fit.swapped,
    )


def _usual_fit(reconstruction: Reconstruction) -> KeypointFit:
    keypoints, motion = reconstruction.keypoints, reconstruction.motion
    camera = reconstruction.model.camera
    evidence = KeypointEvidence.usual(motion.body, camera, keypoints.names, keypoints.sources)
    none = np.zeros(keypoints.score.shape, dtype=bool)
    return keypoint_fit(evidence, keypoints, ObservedKeypoints.of(keypoints), none, motion.posture)
