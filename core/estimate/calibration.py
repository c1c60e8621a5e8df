"""Where the markers sit and how thick the limbs are, found on frames whose posture is known.

A sleeve may begin anywhere along its segment, and no performer is average. The placement of each marker
is fitted so that the keyframes' postures predict the regions seen there, with average proportions as a
prior, so that few or badly posed keyframes change little.
"""

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from ..body.kinematics import Body, Pose
from ..footage.camera import Camera
from ..observation.regions import MarkerPlacement, RegionModel
from .terms.regions import ObservedRegions, feature_rows
from .terms.term import student_weight

Array = NDArray[np.float64]

PARAMETERS = tuple(field.name for field in fields(MarkerPlacement) if field.name != "segment")
PRIOR_STD = np.array([0.08, 0.08, 0.012, 0.012, 0.20])
"""First and last share of the segment, lateral and sagittal displacement [m], girth."""
DIFFERENCE = np.array([1e-3, 1e-3, 1e-4, 1e-4, 1e-3])
SMALLEST = np.array([-0.3, 0.3, -0.06, -0.06, 0.5])
LARGEST = np.array([0.7, 1.3, 0.06, 0.06, 2.0])
ITERATIONS = 5
DEGREES = 4.0


@dataclass(frozen=True, eq=False)
class KnownFrames:
    """Frames whose posture is known, and the regions seen there."""

    pose: Pose
    """Forward kinematics of K postures."""
    frame: NDArray[np.intp]
    """(K,) their indices in the clip."""
    observed: ObservedRegions
    """Regions of those K frames."""
    std_px: Array
    """(K, M, 5) noise of each feature at a known posture [px]."""


def calibrate(
    body: Body, camera: Camera, start: tuple[MarkerPlacement, ...], known: KnownFrames
) -> tuple[MarkerPlacement, ...]:
    """Placements that best explain the regions seen at known postures.

    Args:
        body: The actor's body.
        camera: The camera.
        start: Placements to start from; also the centre of the prior.
        known: At least one frame.

    Returns:
        One placement a marker, in the order of `start`.
    """
    prior = np.array([_values(placement) for placement in start])
    values = prior.copy()
    for _ in range(ITERATIONS):
        residual, visible, slopes = _features(body, camera, start, values, known)
        usable = (
            np.isfinite(residual) & (visible > 0.3)[..., None] & (known.observed.quality > 0.3)[..., None]
        )
        for marker in range(len(start)):
            rows = usable[:, marker]
            r = residual[:, marker][rows] / known.std_px[:, marker][rows]
            J = slopes[:, marker][rows] / known.std_px[:, marker][rows][:, None]
            w = student_weight(r**2, DEGREES, 1)
            normal = J.T @ (w[:, None] * J) + np.diag(PRIOR_STD**-2)
            gradient = J.T @ (w * r) + (values[marker] - prior[marker]) / PRIOR_STD**2
            values[marker] -= np.linalg.solve(normal, gradient)
        values = np.clip(values, SMALLEST, LARGEST)
    return _placements(start, values)


def _values(placement: MarkerPlacement) -> list[float]:
    return [getattr(placement, name) for name in PARAMETERS]


def _placements(start: tuple[MarkerPlacement, ...], values: Array) -> tuple[MarkerPlacement, ...]:
    return tuple(
        MarkerPlacement(placement.segment, *(float(v) for v in row))
        for placement, row in zip(start, values, strict=True)
    )


def _features(
    body: Body, camera: Camera, start: tuple[MarkerPlacement, ...], values: Array, known: KnownFrames
) -> tuple[Array, Array, Array]:
    """Residuals (K, M, 5), visible shares (K, M) and the residuals' slopes (K, M, 5, parameters).

    All the differences are taken in one go, as if each marker were worn several times.
    """
    variants = np.concatenate([values[None], values + np.diag(DIFFERENCE)[:, None]])  # (1 + P, M, P)
    worn = tuple(placement for row in variants for placement in _placements(start, row))
    predicted = RegionModel(body, camera, worn).evaluate(known.pose, known.frame)
    again = np.tile(np.arange(len(start)), len(variants))
    rows, _ = feature_rows(known.observed[:, again], predicted)
    rows = rows.reshape(len(rows), len(variants), len(start), -1)
    slopes = (np.moveaxis(rows[:, 1:], 1, -1) - rows[:, 0, ..., None]) / DIFFERENCE
    return rows[:, 0], predicted.visible[:, : len(start)], slopes
