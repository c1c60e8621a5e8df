"""Feet that stand, stand still: a heavy-tailed prior on the lower ankle's velocity.

A foot that hardly moves in the image, and is not the higher one, stands: it is pulled to rest, along the line
of sight too, where the image sees no motion. One that moves in the image is left alone, and no floor is
assumed: a foot that slides (a treadmill, a dance) moves, and is released. Each row is multiplied by the
weight of Geman and McClure's (1987) kernel, (1 + v² / c²)⁻², which falls to nothing for speeds well past c;
once for the speed and once for the height.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from ..arrays import Array, IndexArray
from ..body.body_volume import sole_places
from ..body.human import mass_weights
from ..body.kinematics import Body
from ..body.skeleton import SIDES
from ..camera.camera import Camera
from ..numerics.robust import student_cost, student_weight
from .state import ClipState
from .term import NormalEquations


@dataclass(frozen=True, eq=False)
class StillnessTerm:
    """Slow named points stand still from frame to frame."""

    camera: Camera
    points: tuple[int, ...]  # indices of the principal points it is about
    step_s: Array  # (F - 1,) time between frames [s]
    rests: Array | None = None  # (F - 1, points) how far each is known to rest, whatever its speed and height
    release_speed_m_s: float = 0.2  # across the line of sight, c, at which rows count a quarter
    depth_share: float = 0.3  # how much motion along the line of sight counts to that speed
    release_height_m: float = 0.04  # above the lowest point, at which rows count a quarter
    std_m: float = 0.003  # how far a standing ankle wanders from frame to frame [m]
    robust: ClassVar[bool] = True

    def add_to(self, equations: NormalEquations, state: ClipState, temperature: float) -> None:
        """Add three rows for each point and pair of frames."""
        if state.frames < 2:
            return
        chosen = list(self.points)
        places = state.body.points(state.pose)[:, chosen]
        jacobian = state.body.points_jacobian(state.pose)[:, chosen] @ state.tangent_jacobian[:, None]
        travel = np.diff(places, axis=0)
        middle = 0.5 * (places[1:] + places[:-1])
        weight = self._standing(travel, middle, state.frame[1:])[..., None] / self.std_m
        rows = len(chosen) * 3
        shape = (state.frames - 1, rows, -1)
        equations.add_rows(
            (travel * weight).reshape(-1, rows),
            (-jacobian[:-1] * weight[..., None]).reshape(shape),
            (jacobian[1:] * weight[..., None]).reshape(shape),
        )

    def cost(self, state: ClipState) -> Array:
        """(F,) what it costs the points to move, which is bounded; that of the later frame of each pair."""
        cost = np.zeros(state.frames)
        if state.frames < 2:
            return cost
        places = state.body.points(state.pose)[:, list(self.points)]
        travel, middle = np.diff(places, axis=0), 0.5 * (places[1:] + places[:-1])
        speed, height = self._moving(travel, middle, state.frame[1:])
        farthest = self.release_speed_m_s * self.step_s[:, None] / self.std_m
        # The integral of a row times its weight, ∫ x (1 + x²)⁻⁴ dx.
        moved = farthest**2 * (1.0 - (1.0 + speed**2) ** -3.0) / 6.0
        cost[1:] = (moved * _kernel(height) ** 2).sum(-1)
        return cost

    def _standing(self, travel: Array, middle: Array, frame: IndexArray) -> Array:
        """(F - 1, points) how far each point is taken to stand, 0 to 1."""
        speed, height = self._moving(travel, middle, frame)
        standing = _kernel(speed) * _kernel(height)
        return np.asarray(standing if self.rests is None else np.maximum(standing, HELD * self.rests**4))

    def resting(self, state: ClipState) -> Array:
        """(F - 1, points) how far each point stays where it is in a state, at whatever height, 0 to 1.

        A foot that is held still in the air rests too, and a height is not known to a few centimeters.
        """
        places = state.body.points(state.pose)[:, list(self.points)]
        speed, _ = self._moving(np.diff(places, axis=0), 0.5 * (places[1:] + places[:-1]), state.frame[1:])
        return _kernel(speed)

    def _moving(self, travel: Array, middle: Array, frame: IndexArray) -> tuple[Array, Array]:
        """(F - 1, points) speed and height, in those at which rows count a quarter."""
        sight = self.camera.sight(middle, frame[:, None])
        along = np.sum(travel * sight, axis=-1, keepdims=True) * sight
        counted = travel - (1.0 - self.depth_share) * along
        speed = np.linalg.norm(counted, axis=-1) / self.step_s[:, None]
        height = middle[..., 2] - middle[..., 2].min(axis=1, keepdims=True)
        return speed / self.release_speed_m_s, height / self.release_height_m


HELD = 5.0
"""Weight of a foot that is known to rest: 3 mm from frame to frame add up over a rest in which a corrected
keyframe has it elsewhere. The fourth power leaves out feet of which that is not sure."""


def _kernel(x: Array) -> Array:
    """Weight of the Geman-McClure kernel, a quarter at 1."""
    return np.asarray((1.0 + x**2) ** -2.0)


@dataclass(frozen=True)
class FloorTerm:
    """A one-sided spring on every point below a height: nobody stands in the floor."""

    points: tuple[int, ...]  # which of the principal points: the ankles
    least_m: float  # how low they come [m]
    std_m: float = 0.01  # how exactly a floor is level
    robust: ClassVar[bool] = False

    def add_to(self, equations: NormalEquations, state: ClipState, temperature: float) -> None:
        """Add a row for each point, zero above the height."""
        below = self._below(state)
        jacobian = state.body.points_jacobian(state.pose)[:, list(self.points), 2] @ state.tangent_jacobian
        equations.add_rows(below, jacobian * ((below != 0.0) / self.std_m)[..., None])

    def cost(self, state: ClipState) -> Array:
        """(F,) half the sum of squares."""
        return np.asarray(0.5 * (self._below(state) ** 2).sum(-1))

    def _below(self, state: ClipState) -> Array:
        """(F, points) how far each is below [standard deviations], negative; 0 above."""
        heights = state.body.points(state.pose)[:, list(self.points), 2]
        return np.asarray(np.minimum(heights - self.least_m, 0.0) / self.std_m)


DEGREES = 3.0  # of Student's t: leaps and stairs are forgiven


@dataclass(frozen=True, eq=False)
class GroundTerm:
    """The height of the lower of some points."""

    points: tuple[int, ...]  # which of the principal points: the ankles
    height_m: float | Array  # how high the lower one is while its foot is on the ground; one height or (F,)
    std_m: float = 0.03
    robust: ClassVar[bool] = True

    def add_to(self, equations: NormalEquations, state: ClipState, temperature: float) -> None:
        """Add one row for each frame."""
        residual, lower = self._residual(state)
        jacobian = state.body.points_jacobian(state.pose)[np.arange(state.frames), lower, 2]  # (F, D)
        weight = np.sqrt(student_weight(residual**2, DEGREES, 1))[:, None]
        rows = (jacobian[:, None] @ state.tangent_jacobian) / self.std_m
        equations.add_rows(residual[:, None] * weight, rows * weight[..., None])

    def cost(self, state: ClipState) -> Array:
        """(F,) negative logarithm of Student's t, up to a constant."""
        residual, _ = self._residual(state)
        return student_cost(residual**2, DEGREES, 1)

    def _residual(self, state: ClipState) -> tuple[Array, IndexArray]:
        """(F,) in standard deviations, and which point it is."""
        heights = state.body.points(state.pose)[:, list(self.points), 2]
        lower = heights.argmin(axis=1)
        residual = (heights[np.arange(state.frames), lower] - self.height_m) / self.std_m
        return residual, np.array(self.points)[lower]


STEP_M = 0.1  # a foot that is higher above the other than this bears nothing


@dataclass(frozen=True, eq=False)
class BalanceTerm:
    """The horizontal way from the place between the feet that is nearest to the center of mass, to that."""

    body: Body
    std_m: float = 0.08  # half of what a foot is long, and what a step under way adds
    robust: ClassVar[bool] = True

    @cached_property
    def _weights(self) -> Array:
        return mass_weights(self.body.skeleton)

    def add_to(self, equations: NormalEquations, state: ClipState, temperature: float) -> None:
        """Add two rows for each frame."""
        residual, share, soles = self._residual(state)
        mass = np.einsum("p,fpid->fid", self._weights, self.body.points_jacobian(state.pose)[..., :2, :])
        feet = state.pose.places_jacobian(self._feet, soles)[..., :2, :]  # (F, 2, 2, D)
        jacobian = mass - (share[..., None, None] * feet).sum(axis=1)
        weight = np.sqrt(student_weight((residual**2).sum(-1), DEGREES, 2))[:, None]
        rows = (jacobian @ state.tangent_jacobian) / self.std_m
        equations.add_rows(residual * weight, rows * weight[..., None])

    def cost(self, state: ClipState) -> Array:
        """(F,) negative logarithm of Student's t, up to a constant."""
        residual, _, _ = self._residual(state)
        return student_cost((residual**2).sum(-1), DEGREES, 2)

    @cached_property
    def _feet(self) -> tuple[int, ...]:
        names = {segment.name: segment.joint for segment in self.body.skeleton.segments}
        return tuple(names[f"foot.{side}"] for side in SIDES)

    def _residual(self, state: ClipState) -> tuple[Array, Array, Array]:
        """(F, 2) in standard deviations, (F, 2) share of each foot in the place, (F, 2, 3) soles' middles."""
        points = self.body.points(state.pose)
        mass = np.einsum("p,fpi->fi", self._weights, points[..., :2])
        soles = sole_places(self.body, state.pose).mean(axis=-2)
        first, way = soles[:, 0, :2], soles[:, 1, :2] - soles[:, 0, :2]
        along = ((mass - first) * way).sum(-1) / np.maximum((way**2).sum(-1), 1e-9)
        higher = soles[:, 1, 2] - soles[:, 0, 2]
        along = np.where(higher > STEP_M, 0.0, np.where(higher < -STEP_M, 1.0, np.clip(along, 0.0, 1.0)))
        share = np.stack([1.0 - along, along], axis=-1)
        place = (share[..., None] * soles[..., :2]).sum(axis=1)
        return (mass - place) / self.std_m, share, soles
