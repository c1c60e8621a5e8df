"""What a person looks at to judge a motion: outlines, points, confidence, and frames worth another keyframe."""

from dataclasses import dataclass, fields
from enum import StrEnum
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

COMPACT = ("observed", "predicted")
"""Large rows that are only looked at: kept as single precision."""


class Reason(StrEnum):
    """Why a frame is worth another keyframe."""

    HIDDEN = "hidden"
    """A marker is hidden there."""
    FAST = "fast"
    """The performer moves fast there."""
    FAR = "far"
    """The next keyframe is far."""
    FOOTAGE = "footage"
    """The markers are not where the motion puts them."""


@dataclass(frozen=True)
class WeakFrame:
    """A frame worth another keyframe."""

    index: int
    """Place in the clip, from 0."""
    reason: Reason
    strength: float
    """How much it is worth, 0 to 1."""
    marker: int | None = None
    """The marker that is hidden or misplaced, where one is the reason."""


@dataclass(frozen=True, eq=False)
class Review:
    """What there is to see of a motion of F frames, M markers and 13 points; NaN where there is nothing."""

    frames: Array
    """(F,) scene frames, fractional for variable frame rate."""
    size: tuple[int, int]
    """Width and height of the picture [px]."""
    marker_names: tuple[str, ...]
    point_names: tuple[str, ...]
    observed: Array
    """(F, M, K, 2) closed outline of each region seen [px]: the even ellipse of equal moments."""
    predicted: Array
    """(F, M, K', 2) closed outline of each marker as the motion predicts it [px]."""
    points: Array
    """(F, 13, 3) principal points in the world [m]."""
    image_points: Array
    """(F, 13, 2) the same in the picture [px]."""
    sigma_m: Array
    """(F, 13) square root of the trace of each point's covariance [m]; NaN for a method without."""
    reprojection_px: Array
    """(F, M) distance between the predicted and observed centroids [px]; NaN where not compared."""
    nearness: Array
    """(F,) degree to which a keyframe is near, 0 to 1."""
    speed: Array
    """(F,) V_sum [px per frame]."""
    confidence: Array
    """(F,) from 0 to 1; NaN for a method without uncertainty."""
    keyframe_indices: NDArray[np.intp]
    """(K,) places in the clip that were given as keyframes."""
    weak_frames: tuple[WeakFrame, ...]
    """Frames worth another keyframe, the worst first."""

    def to_arrays(self) -> dict[str, NDArray[Any]]:
        """Everything as plain arrays, which `from_arrays` reads back; none needs pickling."""
        arrays: dict[str, NDArray[Any]] = {}
        for field in fields(self):
            if field.name == "weak_frames":
                continue
            kind = np.float32 if field.name in COMPACT else None
            arrays[field.name] = np.asarray(getattr(self, field.name), dtype=kind)
        weak = self.weak_frames
        arrays["weak_index"] = np.array([frame.index for frame in weak], dtype=np.int64)
        arrays["weak_reason"] = np.array([str(frame.reason) for frame in weak], dtype=np.str_)
        arrays["weak_strength"] = np.array([frame.strength for frame in weak], dtype=np.float64)
        markers = [-1 if frame.marker is None else frame.marker for frame in weak]
        arrays["weak_marker"] = np.array(markers, dtype=np.int64)
        return arrays

    @classmethod
    def from_arrays(cls, arrays: dict[str, NDArray[Any]]) -> "Review":
        """Read what `to_arrays` gave.

        Raises:
            KeyError: An array is missing.
            ValueError: A reason is unknown.
        """
        columns = zip(
            arrays["weak_index"].tolist(),
            arrays["weak_reason"].tolist(),
            arrays["weak_strength"].tolist(),
            arrays["weak_marker"].tolist(),
            strict=True,
        )
        weak = tuple(
            WeakFrame(index, Reason(reason), strength, None if marker < 0 else marker)
            for index, reason, strength, marker in columns
        )
        names = ("marker_names", "point_names")
        plain = {
            field.name: np.asarray(arrays[field.name], dtype=np.float64)
            for field in fields(cls)
            if field.name not in (*names, "size", "keyframe_indices", "weak_frames")
        }
        width, height = arrays["size"].tolist()
        return cls(
            size=(int(width), int(height)),
            marker_names=tuple(arrays["marker_names"].tolist()),
            point_names=tuple(arrays["point_names"].tolist()),
            keyframe_indices=np.asarray(arrays["keyframe_indices"], dtype=np.intp),
            weak_frames=weak,
            **plain,
        )
