"""Centroid and second moments in space of the volume that each marker covers, relative to the hips.

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

ACROSS = 1.0 / 3.0
"""Second moment across a cylinder's flat silhouette, in squared radii."""
ALONG = 1.0 / 12.0
"""Second moment along it, in squared lengths."""


@dataclass(frozen=True, eq=False)
class MarkerMoments:
    """Moments of M markers in N postures, in the world's axes."""

    centroid: Array
    """(N, M, 3) relative to the hips' midpoint [m]."""
    second_moment: Array
    """(N, M, 3, 3) second central moments [m²]."""
    hip_height_m: Array
    """(N,) height of the hips' midpoint above the floor [m]."""
    points: Array
    """(N, P, 3) the body's points relative to the hips' midpoint [m]."""


def marker_moments(body: Body, segments: tuple[str, ...], posture: Posture) -> MarkerMoments:
    """Moments of the markers bound to some segments.

    Args:
        body: The take's body.
        segments: The segment of each of the M markers.
        posture: (N,) postures.
    """
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
    return MarkerMoments(centroid, second_moment, np.asarray(posture.translation[:, 2]), points)


def _outer(vector: Array) -> Array:
    return np.asarray(vector[..., :, None] * vector[..., None, :])
