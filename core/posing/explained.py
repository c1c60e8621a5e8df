"""How much of a frame postures explain, and what they do not."""

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..body.posture import Posture
from ..matching.frame_likelihood import frame_likelihoods
from ..matching.marker_moments import marker_moments
from ..matching.match_input import MatchInput
from ..matching.noise_scales import DEGREES_OF_FREEDOM
from ..numerics.robust import student_weight

CONTRADICTING = 3.0
"""A marker or keypoint farther off than this many deviations between performers has not been explained."""


def explained_shares(given: MatchInput, frames: IndexArray, posture: Posture) -> tuple[Array, Array]:
    """How much postures explain.

    Args:
        given: The take.
        frames: (T,) indices of frames.
        posture: (T,) their postures.

    Returns:
        (T,) mean weight under Student's t of the places of markers and keypoints, 0 where none is seen, and
        (T, A) how far each is off in standard deviations of performers' differences; NaN where not seen.
    """
    places = marker_moments(given.body, given.evidence, posture).centroid + posture.translation[:, None]
    likelihoods = frame_likelihoods(given.camera, given.evidence, frames, None, 1.0)
    shares, off = np.zeros(len(frames)), np.full(places.shape[:2], np.nan)
    for row, likelihood in enumerate(likelihoods):
        if not likelihood.visible.any():
            continue
        residual = np.einsum("aki,ai->ak", likelihood.image_axes, places[row] - likelihood.location)
        distance = np.linalg.norm(residual * likelihood.weight[:, None], axis=-1)
        off[row, likelihood.visible] = distance[likelihood.visible]
        shares[row] = float(student_weight(off[row, likelihood.visible] ** 2, DEGREES_OF_FREEDOM, 1).mean())
    return shares, off


def contradicting(off: Array) -> BoolArray:
    """Which of (T, A) distances in standard deviations, NaN where not seen, are no performers' difference."""
    return np.asarray(np.nan_to_num(off) > CONTRADICTING)
