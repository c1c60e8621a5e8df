"""Parameters of the markers' placement and the limbs' girth, as they are fitted.

A sleeve may begin anywhere along its segment, and no performer is average. Average proportions are the
mean of the prior, so that few or badly posed keyframes change little.
"""

from dataclasses import dataclass, fields

import numpy as np

from ..arrays import Array, IndexArray
from ..body.kinematics import Body, Pose
from ..footage.camera import Camera
from ..observation.regions import MarkerPlacement, RegionModel
from .terms.regions import ObservedRegions, feature_rows

PARAMETERS = tuple(field.name for field in fields(MarkerPlacement) if field.name != "segment")
PRIOR_STD = np.array([0.08, 0.08, 0.012, 0.012, 0.20])
"""First and last share of the segment, lateral and sagittal displacement [m], girth."""
DIFFERENCE = np.array([1e-3, 1e-3, 1e-4, 1e-4, 1e-3])
SMALLEST = np.array([-0.3, 0.3, -0.06, -0.06, 0.5])
LARGEST = np.array([0.7, 1.3, 0.06, 0.06, 2.0])


@dataclass(frozen=True, eq=False)
class KnownFrames:
    """Frames whose posture is known, and the regions seen there."""

    pose: Pose
    """Forward kinematics of K postures."""
    frame: IndexArray
    """(K,) their indices in the clip."""
    observed: ObservedRegions
    """Regions of those K frames."""


def placement_values(placements: tuple[MarkerPlacement, ...]) -> Array:
    """The parameters (M, P) of M placements, in the order of `PARAMETERS`."""
    values = [[getattr(placement, name) for name in PARAMETERS] for placement in placements]
    return np.array(values).reshape(len(placements), len(PARAMETERS))


def placements_from(start: tuple[MarkerPlacement, ...], values: Array) -> tuple[MarkerPlacement, ...]:
    """Placements on the segments of `start` with other parameters (M, P)."""
    return tuple(
        MarkerPlacement(placement.segment, *(float(v) for v in row))
        for placement, row in zip(start, values, strict=True)
    )


def placement_jacobian(body: Body, camera: Camera, known: KnownFrames, model: RegionModel) -> Array:
    """Jacobian of the residuals of `feature_rows` by each marker's own parameters, (K, M, 5, P).

    All differences are evaluated at once, as if each marker were worn several times.
    """
    start, values = model.placements, placement_values(model.placements)
    variants = np.concatenate([values[None], values + np.diag(DIFFERENCE)[:, None]])  # (1 + P, M, P)
    worn = tuple(placement for row in variants for placement in placements_from(start, row))
    predicted = RegionModel(body, camera, worn).evaluate(known.pose, known.frame)
    again = np.tile(np.arange(len(start)), len(variants))
    rows, _ = feature_rows(known.observed[:, again], predicted)
    rows = rows.reshape(len(rows), len(variants), len(start), -1)
    return np.asarray((np.moveaxis(rows[:, 1:], 1, -1) - rows[:, 0, ..., None]) / DIFFERENCE)
