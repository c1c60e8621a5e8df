"""Closed outlines of the markers as a posture shows them: for people to look at.

A tapered elliptical cylinder is the convex hull of its two elliptical ends, and so is its image (a lens bends
its sides too little to be seen). A marker on several parts is drawn as the hull of all of them.
"""

import numpy as np
from numpy.typing import NDArray

from ..body.kinematics import Pose
from ..body.shapes import PieceStack
from ..footage.camera import Camera
from .regions import RegionModel

Array = NDArray[np.float64]

CORNERS = 32
RIM = 24
"""Places around each end."""


def silhouettes(model: RegionModel, pose: Pose, frame: NDArray[np.intp]) -> Array:
    """Outline every marker.

    Args:
        model: The markers on the body, and the camera.
        pose: Forward kinematics of F postures.
        frame: (F,) index of each posture's frame in the clip, for a moving camera.

    Returns:
        (F, M, CORNERS, 2) [px], the last corner joins the first; NaN for a marker that reaches behind the
        camera.
    """
    pieces = [placement.pieces(model.body) for placement in model.placements]
    rims = _rims(PieceStack.of(piece for own in pieces for piece in own), pose, model.camera, frame)
    edges = np.concatenate([[0], np.cumsum([len(own) for own in pieces])])
    angle = np.linspace(0.0, 2.0 * np.pi, CORNERS, endpoint=False)
    outward = np.stack([np.cos(angle), np.sin(angle)])  # (2, CORNERS)
    outlines = np.empty((len(frame), len(pieces), CORNERS, 2))
    for marker in range(len(pieces)):
        places = rims[:, edges[marker] : edges[marker + 1]].reshape(len(frame), -1, 2)
        # The corner of a hull in a direction is the place that lies farthest that way.
        farthest = (places @ outward).argmax(axis=1)
        outlines[:, marker] = np.take_along_axis(places, farthest[..., None], axis=1)
        outlines[np.isnan(places).any((1, 2)), marker] = np.nan
    return outlines


def _rims(pieces: PieceStack, pose: Pose, camera: Camera, frame: NDArray[np.intp]) -> Array:
    """(F, Q, 2 * RIM, 2) image places around both ends of Q pieces [px]."""
    angle = np.linspace(0.0, 2.0 * np.pi, RIM, endpoint=False)
    circle = np.stack([np.cos(angle), np.sin(angle)], axis=-1)  # (RIM, 2)
    sides = np.stack([pieces.turn(pose, pieces.lateral), pieces.turn(pose, pieces.sagittal)], axis=-2)
    ends = [pieces.place(pose, pieces.start), pieces.place(pose, pieces.end)]
    rims = [
        centre[:, :, None] + (circle * pieces.half_widths[:, None, end]) @ sides
        for end, centre in enumerate(ends)
    ]
    pixels, _ = camera.project(np.concatenate(rims, axis=2), frame[:, None, None])
    return pixels
