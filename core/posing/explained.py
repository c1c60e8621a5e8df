"""How much of a frame postures explain, and what they do not."""

import numpy as np

from ..arrays import Array, BoolArray
from ..body.posture import Posture
from .frame_likelihood import DEGREES_OF_FREEDOM, frame_likelihoods, marker_moments
from .posing_input import PosingInput

CONTRADICTING = 3.0
"""A marker or keypoint farther off than this many deviations between performers has not been explained."""


def explained_shares(given: PosingInput, posture: Posture) -> tuple[Array, Array]:
    """How much postures explain.

    Args:
        given: The take.
        posture: (T,) postures of the frames that are looked at.

    Returns:
        (T,) mean weight under Student's t of the places of markers and keypoints, 0 where none is seen, and
        (T, A) how far each is off in standard deviations of performers' differences; NaN where not seen.
    """
    places = marker_moments(given.body, given.evidence, posture).centroid + posture.translation[:, None]
    likelihoods = frame_likelihoods(given.camera, given.evidence, given.sampled)
    shares, off = np.zeros(len(given.sampled)), np.full(places.shape[:2], np.nan)
    for row, likelihood in enumerate(likelihoods):
        if not likelihood.visible.any():
            continue
        residual = np.einsum("aki,ai->ak", likelihood.image_axes, places[row] - likelihood.location)
        distance = np.linalg.norm(residual * likelihood.weight[:, None], axis=-1)
        off[row, likelihood.visible] = distance[likelihood.visible]
        shares[row] = float((1.0 / (1.0 + off[row, likelihood.visible] ** 2 / DEGREES_OF_FREEDOM)).mean())
    return shares, off


def contradicting(off: Array) -> BoolArray:
    """Which of (T, A) distances in standard deviations, NaN where not seen, are no performers' difference."""
    return np.asarray(np.nan_to_num(off) > CONTRADICTING)
