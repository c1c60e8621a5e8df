"""Inverse kinematics from thirteen points: Levenberg-Marquardt on the manifold from a geometric guess.

Thirteen points leave some degrees of freedom free (forearm pronation, axial rotations, the share of
pelvis and waist in a bend). Weak priors hold those near neutral, and a step is accepted only if it
lowers the cost: plain Gauss-Newton diverges by decimeters here.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array, BoolArray
from ..numerics.least_squares import levenberg_marquardt
from .kinematics import Body
from .posture import Posture
from .posture_guess import guess_posture

POINT_STD_M = 0.003
NEUTRAL_STD_RAD = {
    "waist": 0.8,
    "neck": 0.8,
    "girdle": 0.25,
    "shoulder": 3.0,
    "elbow": 3.0,
    "forearm": 0.5,
    "hip": 3.0,
    "knee": 3.0,
    "shin": 0.2,
}
"""Prior standard deviation of each joint from rest: weak wherever the points determine it."""
LIMIT_STD_RAD = 0.02
"""Standard deviation of a hinge's excess over its joint limits."""
ITERATIONS = 60
CONVERGED = 1e-9


@dataclass(frozen=True, eq=False)
class PostureFit:
    """Postures fitted to points."""

    posture: Posture
    residual_m: Array
    """(N, 13) distance between each given and fitted point [m]; NaN where none was given."""


def _neutral_weights(body: Body) -> Array:
    weights = np.zeros(body.skeleton.dof_count)
    for i, name in enumerate(body.skeleton.dof_names):
        weights[i] = NEUTRAL_STD_RAD.get(name.split(".")[0], np.inf) ** -2
    return weights


def _residuals(body: Body, posture: Posture, targets: Array, weights: Array) -> tuple[Array, Array, Array]:
    """Cost (N,), normal matrix (N, D, D) and gradient (N, D) at a batch of postures."""
    pose = body.pose(posture)
    error = (body.points(pose) - targets) / POINT_STD_M  # (N, P, 3)
    jacobian = body.points_jacobian(pose) / POINT_STD_M  # (N, P, 3, D)
    seen = np.isfinite(error)
    error = np.where(seen, error, 0.0).reshape(len(targets), -1)
    jacobian = np.where(seen[..., None], jacobian, 0.0).reshape(*error.shape, -1)
    vector = posture.to_vector()
    hinges = body.skeleton.hinge_dofs
    lower, upper = body.skeleton.limits[hinges].T
    excess = np.zeros_like(vector)
    excess[:, hinges] = vector[:, hinges] - np.clip(vector[:, hinges], lower, upper)
    limit = (excess != 0.0) / LIMIT_STD_RAD**2
    cost = np.sum(error**2, -1) + np.sum(weights * vector**2 + limit * excess**2, -1)
    # The rotation vector is taken as its own tangent in these weak terms: exact at rest, near enough beyond.
    normal = np.einsum("nrd,nre->nde", jacobian, jacobian)
    diagonal = np.arange(vector.shape[-1])
    normal[:, diagonal, diagonal] += weights + limit
    gradient = np.einsum("nrd,nr->nd", jacobian, error) + weights * vector + limit * excess
    return cost, normal, gradient


def fit_posture(body: Body, points: Array, start: Posture | None = None) -> PostureFit:
    """Fit postures of an actor to given points, as closely as its segment lengths allow.

    Args:
        body: The actor's body.
        points: (N, 13, 3) principal points in the world [m]; NaN for an unknown point (then `start` is
            required).
        start: A batch of N postures to start from; by default a geometric guess.

    Returns:
        The fitted postures and the residual distance of each point.
    """
    targets = np.asarray(points, dtype=np.float64)
    posture = guess_posture(body, targets) if start is None else start
    weights = _neutral_weights(body)
    posture = levenberg_marquardt(
        lambda batch: _residuals(body, batch, targets, weights),
        posture,
        Posture.plus,
        _choose,
        ITERATIONS,
        CONVERGED,
    )
    residual = np.linalg.norm(body.points(body.pose(posture)) - targets, axis=-1)
    return PostureFit(posture, residual)


def _choose(mask: BoolArray, first: Posture, second: Posture) -> Posture:
    return Posture(
        first.skeleton,
        np.where(mask[:, None], first.translation, second.translation),
        np.where(mask[:, None, None, None], first.rotations, second.rotations),
        np.where(mask[:, None], first.angles, second.angles),
    )
