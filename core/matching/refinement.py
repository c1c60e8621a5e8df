"""Refinement of a state path to continuous values: time within the motion, heading and place of every frame.

Gauss-Newton over all sampled frames at once. The footage's residuals are weighed against a motion that goes
on, turns and travels evenly; outlying markers count less (Student's t), as performers hold limbs differently.
"""

from collections.abc import Generator
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from scipy.linalg import solveh_banded

from ..arrays import Array, BoolArray, IndexArray
from ..body.heading import yaw_rotation
from ..numerics.robust import multivariate_weight
from .frame_likelihood import FrameLikelihood, square_root, unstretched
from .match_evidence import INDEPENDENT_POINTS
from .noise_scales import DEGREES_OF_FREEDOM, NoiseScales, student_scales
from .posed_constraints import PosedConstraints
from .sequence_table import SequenceTable

UNKNOWNS = 5
"""Time within the sequence [s], heading [rad], place of the hips [m]."""
ITERATIONS = 10
PROBE = 5e-3
"""Step of numerical derivatives [s, rad, m]."""
LARGEST_STEP = np.array([0.06, 0.2, 0.2, 0.2, 0.2])
"""Largest change of an unknown in one iteration."""
RATE_STD = np.array([0.4, 0.8, 0.35, 0.35, 1.5])
"""Standard deviation of the rates: speed as a share of the usual one, turning [rad/s] and going [m/s] besides
the motion's own. Upwards it is large: the floor tells the height, and a jump or crouch of another kind is
fast."""
RATE_CHANGE_STD = np.array([1.0, 2.0, 0.5, 0.5, 6.0])
"""Standard deviation of the rates' change in a second; it grows with the square root of time."""
JUMP_STD = np.array([np.inf, np.inf, 0.7, 0.7, 1.5])
"""The same as `RATE_STD` at a jump to another movement: its time and axes are its own, the place stays."""
LARGEST_SIZE = 1.5
"""Largest ratio of a marker's size to an average body's, either way."""
LEAST_INFORMATION = 1e-2
"""Added to each unknown's information, so that undetermined ones stay."""

Residuals = tuple[Array, Array, Array, Array]
"""In standard deviations, of places, extents, guessed depths and the floor."""


@dataclass(frozen=True, eq=False)
class ContinuousPath:
    """Sequence, time, heading and place at T frames."""

    sequence: IndexArray
    """(T,) index of the sequence."""
    continues: BoolArray
    """(T - 1,) whether the motion goes on from each frame to the next without a jump."""
    values: Array
    """(T, 5) time from the sequence's time 0 [s], counted on over cycles; heading of the motion's axes at
    that time 0 [rad]; place of the hips [m]."""


@dataclass(frozen=True, eq=False)
class Refinement:
    """Gauss-Newton refinement of a path, and its residuals."""

    table: SequenceTable
    likelihoods: list[FrameLikelihood]
    time_s: Array
    """(T,) times of the frames."""
    tempering: float
    floor_m: float | None
    floor_std_m: float
    constraints: PosedConstraints | None = None
    """Of the posed keyframes, each of whose frames is one of the T."""
    constraint_rows: IndexArray = field(default_factory=lambda: np.zeros(0, dtype=np.intp))
    """(K,) which of the T frames are posed."""

    def refine(self, path: ContinuousPath) -> Generator[None, None, ContinuousPath]:
        """The nearby path that explains the footage best; yields once an iteration."""
        values = np.array(path.values)
        for _ in range(ITERATIONS):
            yield
            size = self._sizes(path.sequence, values)
            matrix, gradient = self._footage(path.sequence, values, size)
            self._add_posed(path.sequence, values, matrix, gradient)
            self._add_smoothness(path, values, matrix, gradient)
            step = solveh_banded(_banded(matrix), -gradient.ravel()).reshape(values.shape)
            values = values + np.clip(step, -LARGEST_STEP, LARGEST_STEP)
        return ContinuousPath(path.sequence, path.continues, values)

    @cached_property
    def _observations(self) -> tuple[Array, ...]:
        names = (
            "weight",
            "image_axes",
            "extent",
            "unclipped",
            "location",
            "backward",
            "pixel_size",
            "extent_std_m",
            "sight",
            "depth_m",
            "depth_weight",
            "stretch",
        )
        return tuple(
            np.array([getattr(likelihood, name) for likelihood in self.likelihoods]) for name in names
        )

    def _sizes(self, sequence: IndexArray, values: Array) -> Array:
        """(M,) size of each marker over the clip, relative to an average body's.

        Clothes and the color's ends are the same in all frames: as independent errors of each they would tell
        more of the distance than the floor does.
        """
        _, _, extent, unclipped, *_ = self._observations
        predicted, depth = self._predicted_extents(sequence, values)
        seen = extent * depth[..., None]
        known = unclipped & (np.abs(seen).sum(axis=-1) > 0.0)
        ratio = np.sum(seen * predicted, axis=-1) / np.maximum(np.sum(predicted * predicted, axis=-1), 1e-12)
        sizes = np.ones(unclipped.shape[1])
        for marker in range(len(sizes)):
            if known[:, marker].any():
                sizes[marker] = np.exp(np.median(np.log(np.maximum(ratio[known[:, marker], marker], 0.1))))
        return np.clip(sizes, 1.0 / LARGEST_SIZE, LARGEST_SIZE)

    def _predicted_extents(self, sequence: IndexArray, values: Array) -> tuple[Array, Array]:
        """Predicted extents (T, M, 3) [m] of an average body's markers, and their depths (T, M) [m]."""
        _, image_axes, _, unclipped, location, backward, *_ = self._observations
        samples = self.table.sample(sequence, values[:, 0])
        turn = yaw_rotation(values[:, 1])
        markers = unclipped.shape[1]
        image_axes = image_axes[:, :markers]
        centroid = (
            samples.centroid[:, :markers] @ np.swapaxes(turn, -1, -2) + (values[:, 2:] - location)[:, None]
        )
        depth = np.maximum(-np.einsum("tmi,ti->tm", centroid, backward), 0.1)
        second_moment = turn[:, None] @ samples.second_moment @ np.swapaxes(turn, -1, -2)[:, None]
        image = np.einsum("tmki,tmij,tmlj->tmkl", image_axes, second_moment, image_axes, optimize=True)
        return np.stack(square_root(image[..., 0, 0], image[..., 0, 1], image[..., 1, 1]), axis=-1), depth

    def noise_scales(self, path: ContinuousPath) -> NoiseScales:
        """The performer's noise scales over the whole clip."""
        weight, _, _, unclipped, *_, depth_weight, _ = self._observations
        size = self._sizes(path.sequence, path.values)
        centroid_residual, extent_residual, depth_residual, _ = self.residuals(
            path.sequence, path.values, size
        )
        keypoints = weight.shape[1] - unclipped.shape[1]
        return NoiseScales(
            student_scales(centroid_residual, weight > 0.0, self.tempering),
            student_scales(extent_residual, unclipped > 0.0, self.tempering),
            size,
            student_scales(depth_residual, depth_weight > 0.0, self.tempering)
            if depth_weight.shape[1]
            else np.ones(keypoints),
        )

    def residuals(self, sequence: IndexArray, values: Array, size: Array) -> Residuals:
        """Places (T, A, 2), extents (T, M, 3), depths (T, G, 1) and floor (T, 1), in standard deviations."""
        weight, image_axes, extent, unclipped, location, _, pixel_size, extent_std, *guessed = (
            self._observations
        )
        samples = self.table.sample(sequence, values[:, 0])
        turn = yaw_rotation(values[:, 1])
        from_hips = samples.centroid @ np.swapaxes(turn, -1, -2)
        centroid = from_hips + (values[:, 2:] - location)[:, None]
        centroid_residual = np.einsum("tmki,tmi->tmk", image_axes, centroid) * weight[..., None]
        centroid_residual = unstretched(centroid_residual, guessed[-1])
        predicted, depth = self._predicted_extents(sequence, values)
        predicted = predicted * size[:, None]
        deviation = np.hypot(extent_std, pixel_size[:, None] * depth)
        extent_residual = (
            (predicted - extent * depth[..., None])
            / deviation[..., None]
            * np.array([1.0, np.sqrt(2.0), 1.0])
        )
        extent_residual = np.where(unclipped[..., None], extent_residual, 0.0)
        sight, depth_m, depth_weight, _ = guessed
        behind = np.einsum("tki,ti->tk", from_hips[:, from_hips.shape[1] - depth_m.shape[1] :], sight)
        depth_residual = ((behind - depth_m) * depth_weight)[..., None]
        if self.floor_m is None:
            return centroid_residual, extent_residual, depth_residual, np.zeros((len(values), 1))
        over = values[:, 4] - samples.hip_height_m - self.floor_m
        return centroid_residual, extent_residual, depth_residual, over[:, None] / self.floor_std_m

    def _footage(self, sequence: IndexArray, values: Array, size: Array) -> tuple[Array, Array]:
        """Normal equations of the footage: (3, T, 5, 5) blocks on and above the diagonal, (T, 5) gradient."""
        now = self.residuals(sequence, values, size)
        rows = self._robust_rows(now, now)
        jacobian = np.empty((*rows.shape, UNKNOWNS))
        for unknown in range(UNKNOWNS):
            probe = np.array(values)
            probe[:, unknown] += PROBE
            jacobian[..., unknown] = (
                self._robust_rows(self.residuals(sequence, probe, size), now) - rows
            ) / PROBE
        matrix = np.zeros((3, len(values), UNKNOWNS, UNKNOWNS))
        matrix[0] = np.swapaxes(jacobian, -1, -2) @ jacobian + LEAST_INFORMATION * np.eye(UNKNOWNS)
        return matrix, np.einsum("tri,tr->ti", jacobian, rows)

    def _add_posed(self, sequence: IndexArray, values: Array, matrix: Array, gradient: Array) -> None:
        """Add the posed keyframes; not tempered, as no other frame says the same."""
        if self.constraints is None or not len(self.constraint_rows):
            return
        rows, own = self.constraint_rows, sequence[self.constraint_rows]

        def residuals(at: Array) -> tuple[Array, Array]:
            points = self.table.points(own, at[:, 0]) @ np.swapaxes(yaw_rotation(at[:, 1]), -1, -2)
            return self.constraints.residuals(points, at[:, 2:]) if self.constraints else (at, at)

        now = residuals(values[rows])
        trust = np.ones((len(rows), now[0].shape[1] + now[1].shape[1]))
        # A posture missing in the library tells little of the time; its place counts in full.
        squared = (now[1] ** 2).sum(axis=1, keepdims=True)
        trust[:, 3:] = np.sqrt(multivariate_weight(squared, DEGREES_OF_FREEDOM, INDEPENDENT_POINTS * 3.0))
        residual = np.concatenate(now, axis=1) * trust
        jacobian = np.empty((*residual.shape, UNKNOWNS))
        for unknown in range(UNKNOWNS):
            probe = values[rows].copy()
            probe[:, unknown] += PROBE
            jacobian[..., unknown] = (np.concatenate(residuals(probe), axis=1) * trust - residual) / PROBE
        np.add.at(matrix[0], rows, np.swapaxes(jacobian, -1, -2) @ jacobian)
        np.add.at(gradient, rows, np.einsum("tri,tr->ti", jacobian, residual))

    def _robust_rows(self, values: Residuals, at: Residuals) -> Array:
        """(T, R) residuals, weighted by Student's t with their values at `at`."""
        rows = []
        share = self.likelihoods[0].share
        for value, now, weight in zip(values, at, (share, 1.0, share, 1.0), strict=True):
            squared = (now**2).sum(axis=-1)
            trust = np.sqrt(weight * multivariate_weight(squared, DEGREES_OF_FREEDOM, now.shape[-1]))
            rows.append((value * trust[..., None]).reshape(len(value), -1))
        return np.asarray(np.sqrt(self.tempering) * np.concatenate(rows, axis=1))

    def _add_smoothness(self, path: ContinuousPath, values: Array, matrix: Array, gradient: Array) -> None:
        """Add the prior of an even motion: usual rates, slowly changing."""
        duration = np.diff(self.time_s)[:, None]
        rate, by_first, by_second = self._rates(path.sequence, values, duration, path.continues)
        continues = path.continues.astype(float)[:, None]
        even = np.where(continues > 0.0, 1.0 / RATE_STD, 1.0 / JUMP_STD)
        scale = even * np.sqrt(self.tempering)
        usual = np.array([1.0, 0.0, 0.0, 0.0, 0.0])
        _add_rows(
            matrix,
            gradient,
            (rate - usual) * scale,
            [by_first * scale[..., None], by_second * scale[..., None]],
        )
        if len(rate) < 2:
            return
        lasting = np.sqrt(0.5 * (duration[1:] + duration[:-1]))
        scale = continues[1:] * continues[:-1] / (RATE_CHANGE_STD * lasting)
        blocks = [-by_first[:-1], by_first[1:] - by_second[:-1], by_second[1:]]
        _add_rows(
            matrix, gradient, (rate[1:] - rate[:-1]) * scale, [block * scale[..., None] for block in blocks]
        )

    def _rates(
        self, sequence: IndexArray, values: Array, duration: Array, continues: BoolArray
    ) -> tuple[Array, Array, Array]:
        """(T - 1, 5) rates of time, heading and place besides the motion's; derivatives by both frames."""
        travel = self.table.sample(sequence, values[:, 0]).travel
        further = self.table.sample(sequence, values[:, 0] + PROBE).travel
        velocity = (further - travel) / PROBE
        turn = yaw_rotation(0.5 * (values[1:, 1] + values[:-1, 1]))
        gone = np.where(continues[:, None], np.diff(travel, axis=0), 0.0)
        earlier, later = velocity[:-1] * continues[:, None], velocity[1:] * continues[:, None]
        change = np.diff(values, axis=0)
        change[:, 2:] -= (turn @ gone[..., None])[..., 0]
        unit = np.broadcast_to(np.eye(UNKNOWNS), (len(gone), UNKNOWNS, UNKNOWNS))
        by_first, by_second = -np.array(unit), np.array(unit)
        by_first[:, 2:, 0] += (turn @ earlier[..., None])[..., 0]
        by_second[:, 2:, 0] -= (turn @ later[..., None])[..., 0]
        x, y, _ = np.moveaxis((turn @ gone[..., None])[..., 0], -1, 0)
        sideways = -0.5 * np.stack([-y, x, np.zeros_like(x)], axis=-1)
        by_first[:, 2:, 1] += sideways
        by_second[:, 2:, 1] += sideways
        over = 1.0 / duration
        return change * over, by_first * over[..., None], by_second * over[..., None]


def _add_rows(matrix: Array, gradient: Array, rows: Array, blocks: list[Array]) -> None:
    """Add rows (N, R) that depend on consecutive frames through blocks (N, R, 5)."""
    count = len(rows)
    for first, left in enumerate(blocks):
        gradient[first : first + count] += np.einsum("nri,nr->ni", left, rows)
        for second in range(first, len(blocks)):
            matrix[second - first, first : first + count] += np.swapaxes(left, -1, -2) @ blocks[second]


def _banded(matrix: Array) -> Array:
    """Blocks (3, T, 5, 5) as the upper band that `solveh_banded` takes."""
    frames = matrix.shape[1]
    width = 3 * UNKNOWNS
    band = np.zeros((width, frames * UNKNOWNS))
    for ahead in range(3):
        count = frames - ahead
        for row in range(UNKNOWNS):
            for column in range(UNKNOWNS):
                over = ahead * UNKNOWNS + column - row
                if over < 0:
                    continue
                first = ahead * UNKNOWNS + column
                band[width - 1 - over, first::UNKNOWNS][:count] = matrix[ahead, :count, row, column]
    return band
