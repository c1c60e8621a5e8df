"""Feet that stand, stand still: a heavy-tailed prior on the lower ankle's velocity.

A foot that hardly moves in the image, and is not the higher one, stands: it is pulled to rest, along the line
of sight too, where the image sees no motion. One that moves in the image is left alone, and no floor is
assumed: a foot that slides (a treadmill, a dance) moves, and is released. Each row is multiplied by the
weight of Geman and McClure's (1987) kernel, (1 + v² / c²)⁻², which falls to nothing for speeds well past c;
once for the speed and once for the height.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ..arrays import Array
from ..body.body_volume import sole_places
from ..body.human import mass_weights
from ..body.kinematics import Body
from ..body.skeleton import SIDES
from ..camera.camera import Camera
from .term import ClipState, NormalEquations, Rows, Term


@dataclass(frozen=True, eq=False)
class StillnessTerm(Term):
    """Slow named points stand still from frame to frame."""

    camera: Camera
    points: tuple[int, ...]  # indices of the principal points it is about
    step_s: Array  # (F - 1,) time between frames [s]
    rests: Array | None = None  # (F - 1, points) how far each is known to rest, whatever its speed and height
    release_speed_m_s: float = 0.2  # across the line of sight, c, at which rows count a quarter
    release_height_m: float = 0.04  # above the lowest point, at which rows count a quarter

    def add_to(self, equations: NormalEquations, state: ClipState, temperature: float) -> None:
        """Add three rows for each point and pair of frames."""
        if state.frames < 2:
            return
        chosen = list(self.points)
        jacobian = state.body.points_jacobian(state.pose)[:, chosen] @ state.tangent_jacobian[:, None]
        travel, speed, height = self._moving(state)
        standing = _kernel(speed) * _kernel(height)
        if self.rests is not None:
            # 5.0: Weight of a foot that is known to rest: 3 mm from frame to frame add up over a rest in
            # which a corrected keyframe has it elsewhere. The fourth power leaves out feet of which that is
            # not sure.
            standing = np.maximum(standing, 5.0 * self.rests**4)
        weight = standing[..., None] / WANDER_M
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
        if state.frames > 1:
            _, speed, height = self._moving(state)
            farthest = self.release_speed_m_s * self.step_s[:, None] / WANDER_M
            # The integral of a row times its weight, ∫ x (1 + x²)⁻⁴ dx.
            moved = farthest**2 * (1.0 - (1.0 + speed**2) ** -3.0) / 6.0
            cost[1:] = (moved * _kernel(height) ** 2).sum(-1)
        return cost

    def resting(self, state: ClipState) -> Array:
        """(F - 1, points) how far each point stays where it is in a state, at whatever height, 0 to 1.

        A foot that is held still in the air rests too, and a height is not known to a few centimeters.
        """
        return _kernel(self._moving(state)[1])

    def _moving(self, state: ClipState) -> tuple[Array, Array, Array]:
        """Steps (F - 1, points, 3) [m]; speed and height (F - 1, points), where rows count a quarter in 1."""
        places = state.body.points(state.pose)[:, list(self.points)]
        travel, middle = np.diff(places, axis=0), 0.5 * (places[1:] + places[:-1])
        sight = self.camera.sight(middle, state.frame[1:, None])
        along = np.sum(travel * sight, axis=-1, keepdims=True) * sight
        # Motion along the line of sight counts three tenths to a foot's speed.
        counted = travel - 0.7 * along
        speed = np.linalg.norm(counted, axis=-1) / self.step_s[:, None]
        height = middle[..., 2] - middle[..., 2].min(axis=1, keepdims=True)
        return travel, speed / self.release_speed_m_s, height / self.release_height_m


WANDER_M = 0.003  # how far a standing ankle wanders from frame to frame


def _kernel(x: Array) -> Array:
    """Weight of the Geman-McClure kernel, a quarter at 1."""
    return np.asarray((1.0 + x**2) ** -2.0)


@dataclass(frozen=True)
class FloorTerm(Term):
    """A one-sided spring on every point below a height: nobody stands in the floor."""

    points: tuple[int, ...]  # which of the principal points: the ankles
    least_m: float  # how low they come [m]
    degrees: ClassVar[float | None] = None

    def rows(self, state: ClipState, slopes: bool = True) -> Iterator[Rows]:
        """A row for each point below the height, within 1 cm, as exactly as a floor is level."""
        below = state.body.points(state.pose)[:, list(self.points), 2] - self.least_m
        by = state.body.points_jacobian(state.pose)[:, list(self.points), 2:] / 0.01 if slopes else None
        yield Rows(below[..., None] / 0.01, by, below < 0.0)


@dataclass(frozen=True, eq=False)
class GroundTerm(Term):
    """The height of the lower of some points."""

    points: tuple[int, ...]  # which of the principal points: the ankles
    height_m: float | Array  # how high the lower one is while its foot is on the ground; one height or (F,)
    std_m: float = 0.03
    degrees: ClassVar[float | None] = 3.0  # leaps and stairs are forgiven

    def rows(self, state: ClipState, slopes: bool = True) -> Iterator[Rows]:
        """One row for each frame."""
        heights = state.body.points(state.pose)[:, list(self.points), 2]
        frame, lower = np.arange(state.frames), np.array(self.points)[heights.argmin(axis=1)]
        by = state.body.points_jacobian(state.pose)[frame, lower, 2] / self.std_m if slopes else None
        error = (heights.min(axis=1) - self.height_m) / self.std_m
        by = None if by is None else by[:, None, None]
        yield Rows(error[:, None, None], by, np.ones((state.frames, 1), dtype=bool))


STEP_M = 0.1  # a foot that is higher above the other than this bears nothing
BALANCE_STD_M = 0.08  # half of what a foot is long, and what a step under way adds


@dataclass(frozen=True, eq=False)
class BalanceTerm(Term):
    """The horizontal way from the place between the feet that is nearest to the center of mass, to that."""

    body: Body
    degrees: ClassVar[float | None] = 3.0

    def rows(self, state: ClipState, slopes: bool = True) -> Iterator[Rows]:
        """Two rows for each frame."""
        weights = mass_weights(self.body.skeleton)
        mass = np.einsum("p,fpi->fi", weights, self.body.points(state.pose)[..., :2])
        soles = sole_places(self.body, state.pose).mean(axis=-2)  # (F, 2, 3)
        first, way = soles[:, 0, :2], soles[:, 1, :2] - soles[:, 0, :2]
        along = ((mass - first) * way).sum(-1) / np.maximum((way**2).sum(-1), 1e-9)
        higher = soles[:, 1, 2] - soles[:, 0, 2]
        along = np.where(higher > STEP_M, 0.0, np.where(higher < -STEP_M, 1.0, np.clip(along, 0.0, 1.0)))
        share = np.stack([1.0 - along, along], axis=-1)  # of each foot in the place
        error = mass - (share[..., None] * soles[..., :2]).sum(axis=1)
        by = None
        if slopes:
            joint = {segment.name: segment.joint for segment in self.body.skeleton.segments}
            joints = [joint[f"foot.{side}"] for side in SIDES]
            feet = state.pose.places_jacobian(joints, soles)[..., :2, :]
            by = np.einsum("p,fpid->fid", weights, self.body.points_jacobian(state.pose)[..., :2, :])
            by = (by - (share[..., None, None] * feet).sum(axis=1))[:, None] / BALANCE_STD_M
        yield Rows(error[:, None] / BALANCE_STD_M, by, np.ones((state.frames, 1), dtype=bool))
