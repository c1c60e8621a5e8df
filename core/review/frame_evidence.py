"""Evidence of each frame from markers and keypoints together: what is hidden, what contradicts the motion.

A marker covers a segment, keypoints show its ends: what one of them sees is not hidden because the other
misses it.
"""

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np

from ..arrays import Array
from .compared_keypoints import ComparedKeypoints
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


def believed_misfits(markers: Array, keypoints: ComparedKeypoints) -> Array:
    """Misfits (F, M + K) of M markers and of the body points whose keypoints are believed.

    Args:
        markers: (F, M) misfits; NaN where not compared.
        keypoints: The keypoints.
    """
    believed = np.where(keypoints.thrown_out, np.nan, keypoints.misfit)
    return np.concatenate([markers, keypoints.by_part(believed)], axis=1)


def frame_evidence(
    squared_error: Array,
    confidence: Array,
    speed: Array,
    segments: tuple[str, ...],
    quality: Array,
    misfit: Array,
    keypoints: ComparedKeypoints,
) -> FrameEvidence:
    """Evidence of F frames from M markers and N keypoints.

    Args:
        squared_error: (F,) as in `FrameEvidence`, like the next two.
        confidence: (F,).
        speed: (F,).
        segments: (M,) the segment of each marker.
        quality: (F, M) of the markers' regions, 0 where hidden.
        misfit: (F, M) of the markers; NaN where not compared.
        keypoints: The keypoints.
    """
    points = keypoints.parts()
    by_point = keypoints.quality()
    marked = quality.copy()
    for marker, segment in enumerate(segments):
        ends = ENDS.get(segment, ())
        if ends and set(ends) <= set(points):
            shown = by_point[:, [points.index(end) for end in ends]].min(axis=1)
            marked[:, marker] = np.maximum(marked[:, marker], shown)
    seen = by_point.copy()
    for column, point in enumerate(points):
        covering = [m for m, segment in enumerate(segments) if point in ENDS.get(segment, ())]
        if covering:
            seen[:, column] = np.maximum(seen[:, column], quality[:, covering].max(axis=1))
    return FrameEvidence(
        squared_error,
        confidence,
        np.concatenate([marked, seen], axis=1),
        np.concatenate([misfit, keypoints.by_part(keypoints.misfit)], axis=1),
        speed,
        points,
    )
