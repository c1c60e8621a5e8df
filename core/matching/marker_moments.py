"""The markers as clouds: middle and spread of the volume that each covers, relative to the hips.

A limb's image has nearly the moments that the projection of this spread has; that it is linear in the spread
makes every heading cheap.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..body.body_volume import PieceStack
from ..body.kinematics import Body
from ..body.posture import Posture
from ..observation.regions import MarkerPlacement

ACROSS = 1.0 / 3.0
"""A cylinder's silhouette is flat across: its spread there is a third of the squared radius."""
ALONG = 1.0 / 12.0


@dataclass(frozen=True, eq=False)
class Solids:
    """M markers of N postures in the world's axes."""

    middle: Array
    """(N, M, 3) relative to the hips' midpoint [m]."""
    spread: Array
    """(N, M, 3, 3) second central moments [m²]."""
    height: Array
    """(N,) of the hips' midpoint above the floor [m]."""
    points: Array
    """(N, P, 3) the body's points relative to the hips' midpoint [m]."""


def marker_solids(body: Body, segments: tuple[str, ...], posture: Posture) -> Solids:
    """The solids of markers that are bound to some segments.

    Args:
        body: The take's body.
        segments: The segment of each of the M markers.
        posture: (N,) postures.
    """
    pose = body.pose(posture)
    middle = np.empty((len(posture.translation), len(segments), 3))
    spread = np.empty((*middle.shape, 3))
    for marker, segment in enumerate(segments):
        pieces = PieceStack.of(MarkerPlacement.usual(segment).pieces(body))
        start, end = pieces.place(pose, pieces.start), pieces.place(pose, pieces.end)  # (N, Q, 3)
        axis = end - start
        width = pieces.half_widths.mean(axis=1)  # (Q, 2)
        share = np.linalg.norm(axis, axis=-1) * width.mean(axis=1)
        share = share / share.sum(axis=1, keepdims=True)
        center = 0.5 * (start + end)
        middle[:, marker] = np.einsum("nq,nqi->ni", share, center)
        own = ALONG * _outer(axis)
        for side, direction in enumerate((pieces.lateral, pieces.sagittal)):
            own += ACROSS * width[:, side, None, None] ** 2 * _outer(pieces.turn(pose, direction))
        own += _outer(center - middle[:, marker, None])
        spread[:, marker] = np.einsum("nq,nqij->nij", share, own)
    middle -= posture.translation[:, None]
    points = np.asarray(body.points(pose) - posture.translation[:, None])
    return Solids(middle, spread, np.asarray(posture.translation[:, 2]), points)


def _outer(vector: Array) -> Array:
    return np.asarray(vector[..., :, None] * vector[..., None, :])
