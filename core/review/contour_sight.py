"""The contours of a motion in the pictures, part by part: which show, and which lie beside their edges.

They judge a motion where no marker does.
"""

from collections.abc import Generator
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..body.extremities import extremity_names
from ..estimate.reconstruct import Reconstruction
from ..estimate.terms.contours import SURFACE_SHARE
from ..observation.contours import SHARES, SIDES

SELDOM = 0.25
"""Share of a part's contour below which it seldom shows: the trunk's behind the arms."""


@dataclass(frozen=True, eq=False)
class ContourSight:
    """The O parts of the body in F frames, without hands and feet."""

    parts: tuple[str, ...]
    """(O,) their segments."""
    quality: Array
    """(F, O) share of a part's contour near which an edge was found, of what usually is."""
    misfit: Array
    """(F, O) reduced squared distance from these edges; NaN where none was found."""
    lines: Array
    """(F, L, S, 2) contour lines of all parts, hands and feet included, as the motion predicts them [px]."""

    @classmethod
    def none(cls, frames: int) -> "ContourSight":
        """No contour at all, O = 0."""
        return cls((), np.zeros((frames, 0)), np.zeros((frames, 0)), np.zeros((frames, 0, len(SHARES), 2)))


def contour_sight(reconstruction: Reconstruction) -> Generator[float, None, ContourSight]:
    """Look for the edges near a motion's contours; yields the fraction done.

    Args:
        reconstruction: The result of `reconstruct`.

    Returns:
        None of them where markers judge the motion, or where no contour was followed.
    """
    motion, solution = reconstruction.motion, reconstruction.solution
    frame = np.arange(len(motion.time_s))
    if reconstruction.tracks.names or solution is None or solution.contours is None:
        return ContourSight.none(len(frame))
    found = yield from solution.contours.measure(motion.posture, frame)
    model = found.model
    predicted = model.evaluate(motion.body.pose(motion.posture), frame)
    distance = np.sum(found.normal * (predicted.pixel - found.edge), axis=-1)
    squared = distance**2 / (found.variance + (SURFACE_SHARE * predicted.half_width) ** 2)
    loose = extremity_names(motion.body.skeleton)  # no posture turns hands and feet
    parts = [part for part in model.parts.segments if part not in loose]
    index = [model.parts.segments.index(part) for part in parts]
    own = (model.part_of[:, None] == np.array(index)).astype(np.float64)  # (N, O)
    seen = np.isfinite(squared)
    number = seen @ own
    misfit = np.where(seen, squared, 0.0) @ own / np.maximum(number, 1.0)
    quality = _relative(number / own.sum(axis=0))
    along = predicted.pixel.reshape(len(frame), -1, len(SHARES), len(SIDES), 2)
    lines = np.swapaxes(along, 2, 3).reshape(len(frame), -1, len(SHARES), 2)
    return ContourSight(tuple(parts), quality, np.where(number > 0.0, misfit, np.nan), lines)


def _relative(share: Array) -> Array:
    """Shares (F, O) of what usually shows of each part; 1 for one that seldom shows, as nobody misses it."""
    usual = np.median(share, axis=0)
    return np.asarray(np.where(usual < SELDOM, 1.0, np.clip(share / np.maximum(usual, SELDOM), 0.0, 1.0)))
