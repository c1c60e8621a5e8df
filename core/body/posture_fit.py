"""Inverse kinematics from thirteen points: a first posture by geometry alone, then a local fit."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..numerics.robust import levenberg_marquardt
from ..numerics.vectors import unit
from . import rotations
from .kinematics import Body
from .posture import Posture
from .skeleton import SIDES


def _frame(x: Array, y: Array, z: Array) -> Array:
    return np.stack([x, y, z], axis=-1)


def _limb(start: Array, upper: Array, lower: Array, bend: float) -> tuple[Array, Array]:
    """Rotation (N, 3, 3) and flexion (N,) of a two-part limb that rests along `start`.

    `upper` and `lower` are unit directions (N, 3) in the limb's parent frame; when flexed the lower
    part moves towards `bend` times the limb's own y axis.
    """
    default = rotations.smallest(start, upper)
    across = lower - np.sum(lower * upper, axis=-1, keepdims=True) * upper
    # Sine of a limb's bend below which its plane is that of the rest pose rather than of the bend.
    y = bend * across + 0.15 * default[..., :, 1]
    y = unit(y - np.sum(y * upper, axis=-1, keepdims=True) * upper)
    flexion = np.arccos(np.clip(np.sum(upper * lower, axis=-1), -1.0, 1.0))
    if abs(start[0]) > 0.5:
        x = np.sign(start[0]) * upper
        return _frame(x, y, np.cross(x, y)), flexion
    z = np.sign(start[2]) * upper
    return _frame(np.cross(y, z), y, z), flexion


def guess_posture(body: Body, points: Array) -> Posture:
    """N postures of the default skeleton whose joints roughly reach the points (N, 13, 3) [m]."""
    skeleton = body.skeleton
    point = {name: points[:, i] for i, name in enumerate(skeleton.point_names)}
    hips = 0.5 * (point["hip.L"] + point["hip.R"])
    shoulders = 0.5 * (point["shoulder.L"] + point["shoulder.R"])
    trunk = unit(shoulders - hips)
    across = unit(point["hip.L"] - point["hip.R"])
    back = unit(np.cross(trunk, across))
    pelvis = _frame(across, back, np.cross(across, back))
    level = point["shoulder.L"] - point["shoulder.R"]
    level = unit(level - np.sum(level * trunk, axis=-1, keepdims=True) * trunk)
    chest = _frame(level, np.cross(trunk, level), trunk)
    turns = {"pelvis": pelvis, "waist": np.swapaxes(pelvis, -1, -2) @ chest}
    turns["neck"] = rotations.smallest(
        np.array([0.0, 0.0, 1.0]), _in_frame(chest, unit(point["head"] - shoulders))
    )
    angles: dict[str, Array] = {}
    for side, out in zip(SIDES, (1.0, -1.0), strict=True):
        for ball, middle, end, above, start, bend in (
            ("shoulder", "elbow", "wrist", chest, np.array([out, 0.0, 0.0]), -1.0),
            ("hip", "knee", "ankle", pelvis, np.array([0.0, 0.0, -1.0]), 1.0),
        ):
            upper = unit(point[f"{middle}.{side}"] - point[f"{ball}.{side}"])
            lower = unit(point[f"{end}.{side}"] - point[f"{middle}.{side}"])
            turn, flexion = _limb(start, _in_frame(above, upper), _in_frame(above, lower), bend)
            turns[f"{ball}.{side}"], angles[f"{middle}.{side}"] = turn, flexion
    rest = Posture.rest(skeleton, (len(hips),))
    matrices, hinges = np.array(rest.rotations), np.array(rest.angles)
    for column, joint in enumerate(skeleton.ball_joints):
        matrices[:, column] = nearest_rotation(turns[skeleton.joints[joint].name])
    for column, joint in enumerate(skeleton.hinge_joints):
        hinges[:, column] = angles.get(skeleton.joints[joint].name, 0.0)
    return Posture(skeleton, hips, matrices, hinges)


def _in_frame(frame: Array, direction: Array) -> Array:
    return np.einsum("nji,nj->ni", frame, direction)


def nearest_rotation(matrix: Array) -> Array:
    """The nearest rotation to each matrix (N, 3, 3); an arbitrary one where points coincide."""
    left, _, right = np.linalg.svd(matrix)
    left[..., 2] *= np.linalg.det(left @ right)[..., None]
    return np.asarray(left @ right)


# --- Inverse kinematics from thirteen points


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
LIMIT_STD_RAD = 0.02  # standard deviation of a hinge's excess over its joint limits


@dataclass(frozen=True, eq=False)
class PostureFit:
    """Postures fitted to points."""

    posture: Posture
    residual_m: Array  # (N, 13) distance between each given and fitted point [m]; NaN where none was given


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


def fit_posture(body: Body, points: Array, start: Posture | None = None, iterations: int = 60) -> PostureFit:
    """Fit postures of an actor to given points, as closely as its segment lengths allow.

    `points` (N, 13, 3) are the principal points in the world [m]; with NaN for an unknown one `start` is
    required, N postures in place of a geometric guess. The points are reached long before what they hardly
    show comes to rest, after most `iterations`.
    """
    targets = np.asarray(points, dtype=np.float64)
    posture = guess_posture(body, targets) if start is None else start
    stems = [name.split(".")[0] for name in body.skeleton.dof_names]
    weights = np.array([NEUTRAL_STD_RAD.get(stem, np.inf) ** -2 for stem in stems])
    posture = levenberg_marquardt(
        lambda batch: _residuals(body, batch, targets, weights),
        posture,
        Posture.plus,
        Posture.where,
        iterations,
        1e-9,
    )
    residual = np.linalg.norm(body.points(body.pose(posture)) - targets, axis=-1)
    return PostureFit(posture, residual)
