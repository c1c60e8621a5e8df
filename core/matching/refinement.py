"""From the best states to values between them: time within the motion, heading and place of every frame.

Gauss-Newton over all frames looked at, at once. What the footage says is weighed against a motion that goes
on, turns and travels evenly; markers that are far off count less, as performers hold a limb otherwise.
"""

from collections.abc import Generator
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from scipy.linalg import solveh_banded

from ..arrays import Array, BoolArray, IndexArray
from ..body.heading import yaw_rotation
from .frame_likelihood import Sight, square_root
from .noise_scales import DEGREES, Habits, scale
from .posed_constraints import POINTS_COUNT, Anchors
from .sequence_table import CourseTable, Reading

UNKNOWNS = 5
"""Time within the chain [s], heading [rad], place [m]."""
ITERATIONS = 10
PROBE = 5e-3
"""By which derivatives are taken [s, rad, m]."""
LARGEST = np.array([0.06, 0.2, 0.2, 0.2, 0.2])
"""No unknown moves farther at once."""
EVEN_STD = np.array([0.4, 0.8, 0.35, 0.35, 1.5])
"""Of the speed as a share of the usual one, of turning [rad/s] and of going [m/s] besides the motion's:
upwards the floor tells it, and who jumps or crouches otherwise is fast."""
CHANGE_STD = np.array([1.0, 2.0, 0.5, 0.5, 6.0])
"""Of what these change by in a second, as the square root of time."""
LEAP_STD = np.array([np.inf, np.inf, 0.7, 0.7, 1.5])
"""The same where another movement begins, whose time and axes are its own: nobody leaves the spot by that."""
MOST_SIZE = 1.5
"""No marker is larger or smaller than on an average body by more."""
HELD = 1e-2
"""Least information on each unknown, so that all stay where nothing is known of them."""


@dataclass(frozen=True, eq=False)
class Course:
    """Where a performer is in a library at T frames."""

    chain: IndexArray
    """(T,)."""
    joined: BoolArray
    """(T - 1,) whether the motion goes on from each frame to the next, and no other begins."""
    values: Array
    """(T, 5) time from the chain's time 0 [s], going on over cycles; heading of the motion's axes then [rad];
    place of the hips [m]."""


@dataclass(frozen=True, eq=False)
class Refinement:
    """What all iterations share."""

    table: CourseTable
    sights: list[Sight]
    clock_s: Array
    """(T,) times of the frames."""
    tempering: float
    floor_m: float | None
    floor_std_m: float
    anchors: Anchors | None = None
    """What is posed; each of its frames is one of the T."""
    anchored: IndexArray = field(default_factory=lambda: np.zeros(0, dtype=np.intp))
    """(K,) which of the T frames those are."""

    def refined(self, course: Course) -> Generator[None, None, Course]:
        """The course that explains the footage best, nearby; yields now and then."""
        values = np.array(course.values)
        for _ in range(ITERATIONS):
            yield
            size = self._sizes(course.chain, values)
            matrix, gradient = self._footage(course.chain, values, size)
            self._posed(course.chain, values, matrix, gradient)
            self._evenness(course, values, matrix, gradient)
            step = solveh_banded(_banded(matrix), -gradient.ravel()).reshape(values.shape)
            values = values + np.clip(step, -LARGEST, LARGEST)
        return Course(course.chain, course.joined, values)

    @cached_property
    def _seen(self) -> tuple[Array, ...]:
        names = ("weight", "axes", "root", "whole", "location", "backward", "pixel", "root_std_m")
        return tuple(np.array([getattr(sight, name) for sight in self.sights]) for name in names)

    def _sizes(self, chain: IndexArray, values: Array) -> Array:
        """(M,) how much larger each marker is than on an average body, over the clip.

        Clothes and where a color ends are the same in all frames: taken as news in each they would say more
        of the distance than the floor does.
        """
        _, _, root, whole, *_ = self._seen
        shown, depth = self._shown(chain, values)
        seen = root * depth[..., None]
        known = whole & (np.abs(seen).sum(axis=-1) > 0.0)
        ratio = np.sum(seen * shown, axis=-1) / np.maximum(np.sum(shown * shown, axis=-1), 1e-12)
        sizes = np.ones(whole.shape[1])
        for marker in range(len(sizes)):
            if known[:, marker].any():
                sizes[marker] = np.exp(np.median(np.log(np.maximum(ratio[known[:, marker], marker], 0.1))))
        return np.clip(sizes, 1.0 / MOST_SIZE, MOST_SIZE)

    def _shown(self, chain: IndexArray, values: Array) -> tuple[Array, Array]:
        """Predicted extents (T, M, 3) [m] of an average body's markers, and their depths (T, M) [m]."""
        _, axes, _, _, location, backward, *_ = self._seen
        read: Reading = self.table.read(chain, values[:, 0])
        turn = yaw_rotation(values[:, 1])
        middle = read.middle @ np.swapaxes(turn, -1, -2) + (values[:, 2:] - location)[:, None]
        depth = np.maximum(-np.einsum("tmi,ti->tm", middle, backward), 0.1)
        spread = turn[:, None] @ read.spread @ np.swapaxes(turn, -1, -2)[:, None]
        image = np.einsum("tmki,tmij,tmlj->tmkl", axes, spread, axes, optimize=True)
        return np.stack(square_root(image[..., 0, 0], image[..., 0, 1], image[..., 1, 1]), axis=-1), depth

    def habits(self, course: Course) -> Habits:
        """What the whole clip says of the performer."""
        weight, _, _, whole, *_ = self._seen
        size = self._sizes(course.chain, course.values)
        off, extent, _ = self.residuals(course.chain, course.values, size)
        return Habits(
            scale(off, weight > 0.0, self.tempering), scale(extent, whole > 0.0, self.tempering), size
        )

    def residuals(self, chain: IndexArray, values: Array, size: Array) -> tuple[Array, Array, Array]:
        """In standard deviations: (T, M, 2) of middles, (T, M, 3) of extents, (T, 1) of the floor."""
        weight, axes, root, whole, location, _, pixel, root_std = self._seen
        read: Reading = self.table.read(chain, values[:, 0])
        turn = yaw_rotation(values[:, 1])
        middle = read.middle @ np.swapaxes(turn, -1, -2) + (values[:, 2:] - location)[:, None]
        off = np.einsum("tmki,tmi->tmk", axes, middle) * weight[..., None]
        shown, depth = self._shown(chain, values)
        shown = shown * size[:, None]
        deviation = np.hypot(root_std, pixel[:, None] * depth)
        extent = (shown - root * depth[..., None]) / deviation[..., None] * np.array([1.0, np.sqrt(2.0), 1.0])
        extent = np.where(whole[..., None], extent, 0.0)
        if self.floor_m is None:
            return off, extent, np.zeros((len(values), 1))
        over = values[:, 4] - read.height - self.floor_m
        return off, extent, over[:, None] / self.floor_std_m

    def _footage(self, chain: IndexArray, values: Array, size: Array) -> tuple[Array, Array]:
        """Normal equations: (3, T, 5, 5) blocks on and above the diagonal, (T, 5) gradient."""
        now = self.residuals(chain, values, size)
        rows = self._weighted(now, now)
        jacobian = np.empty((*rows.shape, UNKNOWNS))
        for unknown in range(UNKNOWNS):
            probe = np.array(values)
            probe[:, unknown] += PROBE
            jacobian[..., unknown] = (self._weighted(self.residuals(chain, probe, size), now) - rows) / PROBE
        matrix = np.zeros((3, len(values), UNKNOWNS, UNKNOWNS))
        matrix[0] = np.swapaxes(jacobian, -1, -2) @ jacobian + HELD * np.eye(UNKNOWNS)
        return matrix, np.einsum("tri,tr->ti", jacobian, rows)

    def _posed(self, chain: IndexArray, values: Array, matrix: Array, gradient: Array) -> None:
        """Add what posed keyframes say; not tempered, as nothing else says the same again."""
        if self.anchors is None or not len(self.anchored):
            return
        rows, own = self.anchored, chain[self.anchored]

        def left(at: Array) -> tuple[Array, Array]:
            points = self.table.points(own, at[:, 0]) @ np.swapaxes(yaw_rotation(at[:, 1]), -1, -2)
            return self.anchors.residuals(points, at[:, 2:]) if self.anchors else (at, at)

        now = left(values[rows])
        trust = np.ones((len(rows), now[0].shape[1] + now[1].shape[1]))
        # A posture that the library does not hold says little of the time; the place holds all the same.
        spread = (now[1] ** 2).sum(axis=1, keepdims=True)
        trust[:, 3:] = np.sqrt((DEGREES + POINTS_COUNT * 3.0) / (DEGREES + spread))
        residual = np.concatenate(now, axis=1) * trust
        jacobian = np.empty((*residual.shape, UNKNOWNS))
        for unknown in range(UNKNOWNS):
            probe = values[rows].copy()
            probe[:, unknown] += PROBE
            jacobian[..., unknown] = (np.concatenate(left(probe), axis=1) * trust - residual) / PROBE
        np.add.at(matrix[0], rows, np.swapaxes(jacobian, -1, -2) @ jacobian)
        np.add.at(gradient, rows, np.einsum("tri,tr->ti", jacobian, residual))

    def _weighted(self, values: tuple[Array, Array, Array], at: tuple[Array, Array, Array]) -> Array:
        """(T, R) residuals, weighted as Student's t has it with what they are at some place."""
        rows = []
        for value, now in zip(values, at, strict=True):
            squared = (now**2).sum(axis=-1)
            trust = np.sqrt((DEGREES + now.shape[-1]) / (DEGREES + squared))
            rows.append((value * trust[..., None]).reshape(len(value), -1))
        return np.asarray(np.sqrt(self.tempering) * np.concatenate(rows, axis=1))

    def _evenness(self, course: Course, values: Array, matrix: Array, gradient: Array) -> None:
        """Add that motions go on at a usual speed and change it little."""
        duration = np.diff(self.clock_s)[:, None]
        rate, by_first, by_second = self._rates(course.chain, values, duration, course.joined)
        joined = course.joined.astype(float)[:, None]
        even = np.where(joined > 0.0, 1.0 / EVEN_STD, 1.0 / LEAP_STD)
        scale = even * np.sqrt(self.tempering)
        usual = np.array([1.0, 0.0, 0.0, 0.0, 0.0])
        _add(
            matrix,
            gradient,
            (rate - usual) * scale,
            [by_first * scale[..., None], by_second * scale[..., None]],
        )
        if len(rate) < 2:
            return
        lasting = np.sqrt(0.5 * (duration[1:] + duration[:-1]))
        scale = joined[1:] * joined[:-1] / (CHANGE_STD * lasting)
        blocks = [-by_first[:-1], by_first[1:] - by_second[:-1], by_second[1:]]
        _add(matrix, gradient, (rate[1:] - rate[:-1]) * scale, [block * scale[..., None] for block in blocks])

    def _rates(
        self, chain: IndexArray, values: Array, duration: Array, joined: BoolArray
    ) -> tuple[Array, Array, Array]:
        """(T - 1, 5) speed, turning and going besides the motion's, and their derivatives by both frames."""
        way = self.table.read(chain, values[:, 0]).way
        further = self.table.read(chain, values[:, 0] + PROBE).way
        velocity = (further - way) / PROBE
        turn = yaw_rotation(0.5 * (values[1:, 1] + values[:-1, 1]))
        gone = np.where(joined[:, None], np.diff(way, axis=0), 0.0)
        earlier, later = velocity[:-1] * joined[:, None], velocity[1:] * joined[:, None]
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


def _add(matrix: Array, gradient: Array, rows: Array, blocks: list[Array]) -> None:
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
