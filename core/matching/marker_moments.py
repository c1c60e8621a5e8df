"""Places in space of what is seen, relative to the hips: markers with their second moments, and keypoints.

A limb's image has nearly the moments of their projection, which is linear in them: that makes every heading
cheap.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..body.body_volume import PieceStack
from ..body.kinematics import Body
from ..body.posture import Posture
from ..observation.regions import MarkerPlacement
from .match_evidence import MatchEvidence

ACROSS = 1.0 / 3.0
"""Second moment across a cylinder's flat silhouette, in squared radii."""
ALONG = 1.0 / 12.0
"""Second moment along it, in squared lengths."""


@dataclass(frozen=True, eq=False)
class MarkerMoments:
    """Moments of M markers and places of K keypoints, A = M + K, in N postures, in the world's axes."""

    centroid: Array
    """(N, A, 3) of the markers' volumes, then the keypoints, relative to the hips' midpoint [m]."""
    second_moment: Array
    """(N, M, 3, 3) the markers' second central moments [m²]."""
    hip_height_m: Array
    """(N,) height of the hips' midpoint above the floor [m]."""
    points: Array
    """(N, P, 3) the body's points relative to the hips' midpoint [m]."""


def marker_moments(body: Body, evidence: MatchEvidence, posture: Posture) -> MarkerMoments:
    """Moments of the markers and places of the keypoints of some evidence.

    Args:
        body: The take's body.
        evidence: Which markers and keypoints there are.
        posture: (N,) postures.
    """
    segments = evidence.segments
    pose = body.pose(posture)
    centroid = np.empty((len(posture.translation), len(segments), 3))
    second_moment = np.empty((*centroid.shape, 3))
    for marker, segment in enumerate(segments):
        pieces = PieceStack.of(MarkerPlacement.usual(segment).pieces(body))
        start, end = pieces.place(pose, pieces.start), pieces.place(pose, pieces.end)  # (N, Q, 3)
        axis = end - start
        width = pieces.half_widths.mean(axis=1)  # (Q, 2)
        share = np.linalg.norm(axis, axis=-1) * width.mean(axis=1)
        share = share / share.sum(axis=1, keepdims=True)
        center = 0.5 * (start + end)
        centroid[:, marker] = np.einsum("nq,nqi->ni", share, center)
        own = ALONG * _outer(axis)
        for side, direction in enumerate((pieces.lateral, pieces.sagittal)):
            own += ACROSS * width[:, side, None, None] ** 2 * _outer(pieces.turn(pose, direction))
        own += _outer(center - centroid[:, marker, None])
        second_moment[:, marker] = np.einsum("nq,nqij->nij", share, own)
    centroid -= posture.translation[:, None]
    points = np.asarray(body.points(pose) - posture.translation[:, None])
    places = np.concatenate([centroid, points[:, evidence.points]], axis=1)
    return MarkerMoments(places, second_moment, np.asarray(posture.translation[:, 2]), points)


def _outer(vector: Array) -> Array:
    return np.asarray(vector[..., :, None] * vector[..., None, :])
