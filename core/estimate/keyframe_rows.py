"""Posing error of keyframes: the shape of its covariance; its size is found from the footage.

A person who poses a skeleton over footage puts every joint a little off, and the whole figure too; an
error upstream is made good downstream, so joints' places err independently, not their angles. And the
posture may be that of a moment before or after the frame it was set at. These shapes are assumed, their
sizes are not.
"""

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np
from scipy.linalg import block_diag

from ..arrays import Array, BoolArray, IndexArray
from ..body.kinematics import Body, Pose
from ..body.posture import Posture
from ..evidence.regions import MarkerPlacement, RegionModel
from ..footage.camera import Camera
from .terms.regions import ObservedRegions, feature_rows

POINT_STD_M = 0.014  # error of each point along each axis [m]
PLACE_STD_M = 0.009  # error that all points share along each axis [m]
FREE_STD_RAD = 0.5  # error of rotations that no point determines, about a limb's own axis [rad]


def posing_covariance(body: Body, pose: Pose) -> Array:
    """A person's usual posing error at given poses, as covariance (K, D, D) of the posture's tangent."""
    count = body.skeleton.dof_count
    jacobian = body.points_jacobian(pose).reshape(*pose.posture.batch, -1, count) / POINT_STD_M
    information = np.swapaxes(jacobian, -1, -2) @ jacobian + np.eye(count) * FREE_STD_RAD**-2
    covariance = np.linalg.solve(information, np.broadcast_to(np.eye(count), information.shape))
    place = np.arange(3)
    covariance[..., place, place] += PLACE_STD_M**2
    return np.asarray(0.5 * (covariance + np.swapaxes(covariance, -1, -2)))


def velocities(keyframes: Posture, frame: IndexArray) -> Array:
    """Velocities of K keyframes' postures, (K, D) of the tangent per frame: of the parabola through three."""
    if len(frame) < 2:
        return np.zeros((len(frame), keyframes.skeleton.dof_count))
    gap = np.diff(frame)[:, None].astype(np.float64)
    after = keyframes[1:].minus(keyframes[:-1]) / gap
    velocity = np.concatenate([after, -keyframes[-2:-1].minus(keyframes[-1:]) / gap[-1:]])
    before = -keyframes[:-2].minus(keyframes[1:-1]) / gap[:-1]
    velocity[1:-1] = (gap[1:] * before + gap[:-1] * after[1:]) / (gap[1:] + gap[:-1])
    return velocity


# --- Parameters of the markers' placement and the limbs' girth, as they are fitted


PARAMETERS = tuple(field.name for field in fields(MarkerPlacement) if field.name != "segment")
PRIOR_STD = np.array([0.08, 0.08, 0.012, 0.012, 0.20])
"""First and last share of the segment, lateral and sagittal displacement [m], girth."""
DIFFERENCE = np.array([1e-3, 1e-3, 1e-4, 1e-4, 1e-3])
SMALLEST = np.array([-0.3, 0.3, -0.06, -0.06, 0.5])
LARGEST = np.array([0.7, 1.3, 0.06, 0.06, 2.0])


@dataclass(frozen=True, eq=False)
class KnownFrames:
    """Frames whose posture is known, and the regions seen there."""

    pose: Pose  # forward kinematics of K postures
    frame: IndexArray  # (K,) their indices in the clip
    observed: ObservedRegions  # regions of those K frames


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


# --- Rows at keyframes


UNUSED = 1e6  # variance of a row that does not count [px²]
LENS_STD = 0.03  # standard deviation of a stated focal length, as a share


@dataclass(frozen=True, eq=False)
class EvidenceRows:
    """The rows R of one kind of evidence at J judged keyframes, with X parameters of its own."""

    residual: Array  # (J, R) predicted minus observed, at average parameters [px]
    by_parameters: Array  # (J, R, X)
    by_lens: Array  # (J, R) by the logarithm of the focal length
    by_posture: Array  # (J, R, D) by the posture's tangent
    variance: Array  # (J, R) at a perfectly posed keyframe [px²]; `UNUSED` for rows that do not count
    prior: Array  # (X, X) information of the parameters' prior


@dataclass(frozen=True, eq=False)
class KeyframeRows:
    """The rows of all evidence, R of them, with all parameters: X, of which the last is the lens."""

    residual: Array  # (J, R)
    parameter_jacobian: Array  # (J, R, X)
    variance: Array  # (J, R)
    posing: Array  # (J, R, R) covariance that a person's usual posing error adds
    velocity: Array  # (J, R) change of the rows per frame
    prior: Array  # (X, X)

    @classmethod
    def stacked(cls, parts: Sequence[EvidenceRows], posing: Array, velocity: Array) -> "KeyframeRows":
        """The rows of several kinds of evidence, one after the other.

        `posing` (J, D, D) is the usual posing error, `velocity` (J, D) the change of the postures per frame.
        """
        judged = len(posing)
        rows = [part.residual.shape[1] for part in parts]
        own = [part.by_parameters.shape[2] for part in parts]
        parameters = np.zeros((judged, sum(rows), sum(own) + 1))
        row = column = 0
        for part, height, width in zip(parts, rows, own, strict=True):
            parameters[:, row : row + height, column : column + width] = part.by_parameters
            parameters[:, row : row + height, -1] = part.by_lens
            row, column = row + height, column + width
        jacobian = np.concatenate([part.by_posture for part in parts], axis=1)
        return cls(
            np.concatenate([part.residual for part in parts], axis=1),
            parameters,
            np.concatenate([part.variance for part in parts], axis=1),
            jacobian @ posing @ np.swapaxes(jacobian, -1, -2),
            (jacobian @ velocity[..., None])[..., 0],
            block_diag(*(part.prior for part in parts), LENS_STD**-2),
        )

    def part(self, rows: BoolArray, parameters: BoolArray) -> "KeyframeRows":
        """Some of the rows (R,), with the parameters (X,) that they depend on."""
        return KeyframeRows(
            self.residual[:, rows],
            self.parameter_jacobian[:, rows][:, :, parameters],
            self.variance[:, rows],
            self.posing[:, rows][:, :, rows],
            self.velocity[:, rows],
            self.prior[np.ix_(parameters, parameters)],
        )

    def gathered(self, noise: Array) -> tuple[Array, Array, Array]:
        """Inverse noise, information (X, X) of the parameters with their prior, right-hand side (X,)."""
        inverse = np.linalg.inv(noise)
        weighted = np.swapaxes(self.parameter_jacobian, -1, -2) @ inverse
        information = (weighted @ self.parameter_jacobian).sum(axis=0) + self.prior
        return inverse, information, (weighted @ self.residual[..., None]).sum(axis=0)[:, 0]

    def calibrated(self, weight: Array, scale: float, timing: float) -> tuple[Array, Array]:
        """Most probable change (X,) of the parameters, and the rows (J, R) that it leaves; as `noise`."""
        _, information, right = self.gathered(self.noise(weight, scale, timing))
        change = -np.linalg.solve(information, right)
        return change, self.residual + self.parameter_jacobian @ change

    def squared(self, left: Array, size: IndexArray, scale: float, timing: float) -> Array:
        """(J, G) squares, in standard deviations, of rows that are left: groups of `size` (G,) rows each."""
        expected = self.noise(np.ones_like(left), scale, timing)
        squared = np.empty((len(left), len(size)))
        first = np.cumsum(size) - size
        for count in np.unique(size):
            index = first[size == count][:, None] + np.arange(count)
            rows = left[:, index]
            own = expected[:, index[:, :, None], index[:, None, :]]
            solved = np.linalg.solve(own, rows[..., None])
            squared[:, size == count] = (rows[..., None, :] @ solved)[..., 0, 0]
        return squared

    def noise(self, weight: Array, scale: float, timing: float) -> Array:
        """(J, R, R) covariance of the rows without the parameters' own.

        `weight` (J, R) is 1 for a row that is no outlier, `scale` the posing error's size relative to a usual
        one, `timing` the timing error's standard deviation [frames].
        """
        total = scale**2 * self.posing + timing**2 * self.velocity[:, :, None] * self.velocity[:, None, :]
        rows = np.arange(total.shape[-1])
        total[:, rows, rows] += self.variance / weight
        return total
