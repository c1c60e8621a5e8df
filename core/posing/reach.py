"""Inverse kinematics: a posture whose points come near given places, changed as little as that takes.

Levenberg-Marquardt on the posture's manifold. Every point may be pulled harder across a direction of sight
than along it, joints are free or stiff by their standard deviations, and joint limits are springs: what a
person has set beyond them is not taken back.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..body import rotations
from ..body.kinematics import Body
from ..body.posture import Posture
from ..numerics.least_squares import Equations, levenberg_marquardt

LIMIT_STD_RAD = 0.02
"""Standard deviation of what is beyond a joint's limits, as in `body/posture_fit`."""
STEPS = 40
CONVERGED = 1e-7
"""Share by which a step must lower the cost for another to be worth it."""


@dataclass(frozen=True, eq=False)
class Pull:
    """A place that a point of the body should come to."""

    point: str
    """Name of a principal point."""
    place: Array
    """(3,) in the world [m]."""
    std_m: float
    """Standard deviation of its distance from there [m], ..."""
    sight: Array | None = None
    """... across this unit direction (3,), if given, ..."""
    depth_std_m: float = 0.0
    """... and along it [m]."""

    @property
    def weights(self) -> Array:
        """(3, 3) matrix that takes a distance [m] to standard deviations."""
        if self.sight is None:
            return np.eye(3) / self.std_m
        along = np.outer(self.sight, self.sight)
        return (np.eye(3) - along) / self.std_m + along / self.depth_std_m


def pulled(
    body: Body,
    posture: Posture,
    pulls: Sequence[Pull],
    free: Mapping[str, float],
    allowed: Posture | None = None,
) -> Posture:
    """A single posture whose points come as near to their places as its joints allow; lengths are exact.

    Args:
        body: The actor's body.
        posture: The posture to start from.
        pulls: Where points should come to.
        free: Standard deviation of each joint that may move, in the tangent space about `posture` [rad]; of
            the hips' place as `place` [m]. All others stay.
        allowed: A posture that is allowed whatever the joint limits; by default the one to start from.
    """
    problem = _Problem(body, posture, pulls, free, posture if allowed is None else allowed)
    (step,) = levenberg_marquardt(
        problem.equations,
        np.zeros((1, len(problem.dofs))),
        np.add,
        lambda better, trial, last: np.where(better[:, None], trial, last),
        STEPS,
        CONVERGED,
    )
    return problem.moved(step)


class _Problem:
    """Cost of a step of the free joints, with its derivatives."""

    def __init__(
        self,
        body: Body,
        posture: Posture,
        pulls: Sequence[Pull],
        free: Mapping[str, float],
        allowed: Posture,
    ) -> None:
        skeleton = body.skeleton
        std = {i: free[joint] for i, joint in enumerate(map(_owner, skeleton.dof_names)) if joint in free}
        self.body, self.start = body, posture
        self.dofs = np.array(sorted(std), dtype=np.intp)
        self.stiffness = np.array([std[dof] for dof in self.dofs]) ** -2.0
        self.columns = [skeleton.point_names.index(pull.point) for pull in pulls]
        self.places = np.array([pull.place for pull in pulls]).reshape(-1, 3)
        self.weights = np.array([pull.weights for pull in pulls]).reshape(-1, 3, 3)
        values = allowed.to_vector()
        lower, upper = skeleton.limits.T
        self.lower, self.upper = np.minimum(lower, values), np.maximum(upper, values)

    def moved(self, step: Array) -> Posture:
        return self.start.plus(self._full(step))

    def equations(self, steps: Array) -> Equations:
        """Cost, normal matrix (1, N, N) and gradient (1, N) at a step (1, N)."""
        (step,) = steps
        posture = self.moved(step)
        pose = self.body.pose(posture)
        about = self.start.plus_jacobian(self._full(step))
        off = self.body.points(pose)[self.columns] - self.places
        error = (self.weights @ off[..., None]).ravel()
        slopes = self.weights @ self.body.points_jacobian(pose)[self.columns]
        jacobian = (slopes.reshape(-1, about.shape[0]) @ about)[:, self.dofs]
        values = posture.to_vector()
        beyond = (values - np.clip(values, self.lower, self.upper)) / LIMIT_STD_RAD
        limits = _vector_slopes(posture, values) @ about / LIMIT_STD_RAD
        rows = np.concatenate([jacobian, limits[beyond != 0.0][:, self.dofs]])
        errors = np.concatenate([error, beyond[beyond != 0.0]])
        cost = errors @ errors + self.stiffness @ step**2
        normal = rows.T @ rows + np.diag(self.stiffness)
        return np.array([cost]), normal[None], (rows.T @ errors + self.stiffness * step)[None]

    def _full(self, step: Array) -> Array:
        full = np.zeros(self.body.skeleton.dof_count)
        full[self.dofs] = step
        return full


def _owner(dof: str) -> str:
    """The joint that a degree of freedom belongs to, its side included; `place` for the hips' location."""
    joint, _, component = dof.rpartition(".")
    return "place" if component.startswith("location") else joint


def _vector_slopes(posture: Posture, values: Array) -> Array:
    """(D, D) d posture vector / d tangent: 1 but for balls, whose components are of rotation vectors."""
    slopes = np.eye(len(values))
    dofs = posture.skeleton.ball_dofs
    slopes[dofs[:, :, None], dofs[:, None, :]] = rotations.right_jacobian_inverse(values[dofs])
    return slopes
