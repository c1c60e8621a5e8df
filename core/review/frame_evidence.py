"""Evidence of each frame of any kind together: what is hidden, what contradicts the motion.

A marker or a contour covers a segment, keypoints show its ends: what one of them sees is not hidden because
another misses it.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from ..arrays import Array
from .compared_keypoints import ComparedKeypoints
from .contour_sight import ContourSight
from .weak_frames import FrameEvidence

LIMBS: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {
        "upper_arm": ("shoulder", "elbow"),
        "forearm": ("elbow", "wrist"),
        "hand": ("wrist",),
        "thigh": ("hip", "knee"),
        "shin": ("knee", "ankle"),
        "foot": ("ankle",),
    }
)
ENDS: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {
        **{
            f"{part}.{side}": tuple(f"{end}.{side}" for end in LIMBS[part]) for part in LIMBS for side in "LR"
        },
        "trunk": ("shoulder.L", "shoulder.R", "hip.L", "hip.R"),
        "chest": ("shoulder.L", "shoulder.R"),
        "pelvis": ("hip.L", "hip.R"),
        "head": ("head",),
    }
)
"""Body points that lie at the ends of a segment."""


@dataclass(frozen=True, eq=False)
class MarkerSight:
    """M markers in F frames."""

    segments: tuple[str, ...]
    """(M,) the segment of each."""
    quality: Array
    """(F, M) of its regions, 0 where hidden."""
    misfit: Array
    """(F, M) as in `confidence`; NaN where not compared."""


def believed_misfits(markers: Array, contours: ContourSight, keypoints: ComparedKeypoints) -> Array:
    """Misfits (F, M + O + K) of markers, contours, and the body points whose keypoints are believed.

    Args:
        markers: (F, M) misfits; NaN where not compared.
        contours: Those of O parts.
        keypoints: Those of K body points.
    """
    believed = np.where(keypoints.thrown_out, np.nan, keypoints.misfit)
    return np.concatenate([markers, contours.misfit, keypoints.by_part(believed)], axis=1)


def frame_evidence(
    squared_error: Array,
    confidence: Array,
    speed: Array,
    markers: MarkerSight,
    contours: ContourSight,
    keypoints: ComparedKeypoints,
) -> FrameEvidence:
    """Evidence of F frames.

    Args:
        squared_error: (F,) as in `FrameEvidence`, like the next two.
        confidence: (F,).
        speed: (F,).
        markers: Those of M markers.
        contours: Those of O parts.
        keypoints: Those of K body points.
    """
    segments = (*markers.segments, *contours.parts)
    covered = np.concatenate([markers.quality, contours.quality], axis=1)
    points, by_point = keypoints.parts(), keypoints.quality()
    shown, seen = covered.copy(), by_point.copy()
    for column, segment in enumerate(segments):
        ends = ENDS.get(segment, ())
        if ends and set(ends) <= set(points):
            both = by_point[:, [points.index(end) for end in ends]].min(axis=1)
            shown[:, column] = np.maximum(shown[:, column], both)
    for column, point in enumerate(points):
        covering = [index for index, segment in enumerate(segments) if point in ENDS.get(segment, ())]
        if covering:
            seen[:, column] = np.maximum(seen[:, column], covered[:, covering].max(axis=1))
    return FrameEvidence(
        squared_error,
        confidence,
        np.concatenate([shown, seen], axis=1),
        np.concatenate([markers.misfit, contours.misfit, keypoints.by_part(keypoints.misfit)], axis=1),
        speed,
        (*contours.parts, *points),
    )
