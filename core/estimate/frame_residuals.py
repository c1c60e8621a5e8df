"""How far what is seen of one frame lies from where a posture has it, and what it does not explain."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..body.posture import Posture
from .keyframe_evidence import KeyframeEvidence
from .terms.keypoints import ObservedKeypoints
from .terms.regions import ObservedRegions, limb_widths

MISPLACED_WIDTHS = 1.5
"""A marker farther off than this many of its limb's half-widths is misplaced ..."""
MISPLACED_PX = 4.0
"""... unless it is nearer than this [px]."""
MISPLACED_M = 0.12
"""A sure keypoint farther off than this is misplaced, too: a limb's width and a detector's error are less."""
SURE = 0.5
"""Least confidence of a keypoint that is called misplaced."""


@dataclass(frozen=True, eq=False)
class FrameResiduals:
    """Distances in the picture, and what is misplaced."""

    marker_px: Array
    """(M,) of the centroids [px]; NaN where a marker is hidden."""
    keypoint_px: Array
    """(N,) of the keypoints [px]; NaN where one is not seen."""
    markers: tuple[int, ...]
    """Indices of the markers that the posture does not explain."""
    points: tuple[str, ...]
    """Body points of the keypoints that it does not explain."""


def frame_residuals(
    evidence: KeyframeEvidence,
    observed: ObservedRegions,
    points: ObservedKeypoints | None,
    posture: Posture,
    frame: int,
) -> FrameResiduals:
    """Compare a posture with what is seen of one frame.

    Args:
        evidence: The models of markers and keypoints.
        observed: The regions of this one frame, (1, M).
        points: The keypoints of this one frame, (1, N); None for none.
        posture: A single posture.
        frame: The frame's index in the clip.
    """
    model, index = evidence.model, np.array([frame])
    pose = model.body.pose(Posture.stack([posture]))
    off = np.linalg.norm(model.evaluate(pose, index).centroid - observed.centroid, axis=-1)[0]
    width = limb_widths(model, posture.translation[None], index)[0]
    markers = np.flatnonzero(np.nan_to_num(off) > np.maximum(MISPLACED_WIDTHS * width, MISPLACED_PX))
    if points is None:
        return FrameResiduals(off, np.zeros(0), tuple(map(int, markers)), ())
    own = evidence.keypoints.model
    depth = own.camera.depth(own.world(pose), index[:, None])[0]
    far_px = MISPLACED_M * own.camera.focal_px / np.maximum(depth, 0.1)
    point_off = np.linalg.norm(own.pixels(pose, index) - points.pixel, axis=-1)[0]
    far = np.nan_to_num(point_off) > np.maximum(far_px, MISPLACED_PX)
    misplaced = np.flatnonzero(far & (points.confidence[0] >= SURE))
    names = tuple(dict.fromkeys(own.names[row] for row in misplaced))
    return FrameResiduals(off, point_off, tuple(map(int, markers)), names)
