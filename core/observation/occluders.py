"""Static occluders: what stands before the performer and hides it, whatever it does (a table, a pillar).

A map on the grid of the album's pictures says from which depth on a body is hidden there. Its edge is soft,
so that the prediction changes smoothly with the posture.
"""

from dataclasses import dataclass
from functools import cached_property

import cv2
import numpy as np

from ..arrays import Array, BoolArray, IndexArray, SingleArray

EDGE_SOFTNESS_PX = 0.7
"""Standard deviation of the map's edge in its own pixels."""
DEPTH_SOFTNESS_M = 0.05
"""Width of the logistic in depth: of furniture, only bounds of its depth are known."""


@dataclass(frozen=True, eq=False)
class StaticOccluders:
    """Where a static camera sees something before the performer."""

    hidden_from: SingleArray
    """(rows, columns) camera depth from which on a body is hidden [m]; infinite where nothing hides it."""
    factor: int
    """Pixels of the camera to one of the map, along either axis."""

    @property
    def covered(self) -> BoolArray:
        """(rows, columns) whether anything is hidden there."""
        return np.isfinite(self.hidden_from)

    @cached_property
    def _soft(self) -> tuple[SingleArray, SingleArray]:
        """The map with a border of one pixel, flat: the share covered, and the depth, also just outside."""
        inverse = np.where(self.covered, 1.0 / np.maximum(self.hidden_from, 1e-3), 0.0)
        share, mean = (
            np.pad(cv2.GaussianBlur(one.astype(np.float32), (0, 0), EDGE_SOFTNESS_PX), 1).ravel()
            for one in (self.covered, inverse)
        )
        return np.asarray(share), np.asarray(share / np.maximum(mean, 1e-6), dtype=np.float32)

    def visible_share(self, pixels: Array, depth: Array) -> Array:
        """Visible share (...) of image points (..., 2) [px] at camera depths (...) [m], 0 to 1."""
        cell = self._cells(pixels)
        share, nearest = self._soft
        hidden = share[cell].astype(np.float64)
        at = np.nonzero(hidden)
        behind = (depth[at] - nearest[cell[at]]) / (2.0 * DEPTH_SOFTNESS_M)
        hidden[at] *= 0.5 + 0.5 * np.tanh(behind)
        return 1.0 - hidden

    def _cells(self, pixels: Array) -> IndexArray:
        """Flat index of the bordered map's pixel in which points (..., 2) lie; NaN lies in its border."""
        rows, columns = self.hidden_from.shape
        largest = np.array([columns, rows]) + 1.0
        place = np.clip(np.nan_to_num(pixels / self.factor, nan=-1.0) + 1.0, 0.0, largest).astype(np.intp)
        return np.asarray(place[..., 1] * (columns + 2) + place[..., 0])
