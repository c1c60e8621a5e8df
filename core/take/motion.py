"""A motion: posture, thirteen points and their covariance for every frame of the clip."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

import numpy as np

from ..arrays import Array
from ..body.kinematics import Body
from ..body.posture import Posture


@dataclass(frozen=True, eq=False)
class Motion:
    """A reconstructed motion of F frames."""

    body: Body
    fps: float
    frame_start: int
    time_s: Array
    """(F,) time stamp of each frame from the first [s]; uneven for variable frame rate."""
    posture: Posture
    """A batch of F postures."""
    points: Array
    """(F, 13, 3) principal points in the world [m]."""
    point_covariance: Array
    """(F, 13, 3, 3) estimated covariance of each point [m²]."""
    keyframe_indices: tuple[int, ...]
    """Frame indices of the keyframes."""
    method: str
    """Method of the estimate: `map`, `ekf` or `interpolation`."""
    diagnostics: Mapping[str, Array] = field(default_factory=lambda: MappingProxyType({}))
    """Diagnostics of the estimate by name, (F, ...) each."""

    @property
    def scene_frames(self) -> Array:
        """(F,) Blender scene frame of each clip frame; fractional for variable frame rate."""
        return np.asarray(self.frame_start + self.time_s * self.fps)

    @property
    def sigma_m(self) -> Array:
        """(F, 13) square root of the trace of each point's covariance [m]."""
        return np.sqrt(np.trace(self.point_covariance, axis1=-2, axis2=-1))
