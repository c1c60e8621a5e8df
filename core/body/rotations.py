"""Rotations on SO(3), over any leading batch axes.

Tangent steps act from the right, `R Exp(step)`: the step is expressed in the rotated (child) frame.
References: Solà, Deray, Atchuthan (2018), *A micro Lie theory for state estimation in robotics*.
SciPy is imported where it is used: what a body is, Blender's panels know without it.
"""

import numpy as np

from ..arrays import Array, BoolArray
from ..numerics.vectors import unit


def exponential(rotation_vector: Array) -> Array:
    """Rotation matrices (..., 3, 3) of rotation vectors (..., 3) [rad]: Solà (2018), eq. 132."""
    from scipy.spatial.transform import Rotation

    vectors = np.asarray(rotation_vector, dtype=np.float64)
    matrices: Array = Rotation.from_rotvec(vectors.reshape(-1, 3)).as_matrix()
    return matrices.reshape(*vectors.shape[:-1], 3, 3)


def logarithm(rotation: Array) -> Array:
    """Rotation vectors (..., 3) of matrices (..., 3, 3), of angle at most π: Solà (2018), eq. 133."""
    from scipy.spatial.transform import Rotation

    matrices = np.asarray(rotation, dtype=np.float64)
    vectors: Array = Rotation.from_matrix(matrices.reshape(-1, 3, 3)).as_rotvec()
    return vectors.reshape(*matrices.shape[:-2], 3)


def cross(a: Array, b: Array) -> Array:
    """Cross product over the last axis; `numpy.cross` spends most of its time on generality."""
    x, y, z = a[..., 0], a[..., 1], a[..., 2]
    u, v, w = b[..., 0], b[..., 1], b[..., 2]
    return np.stack([y * w - z * v, z * u - x * w, x * v - y * u], axis=-1)


def cross_matrix(vector: Array) -> Array:
    """The matrix [v]x with [v]x w = v × w, for (..., 3) vectors, as (..., 3, 3)."""
    v = np.asarray(vector, dtype=np.float64)
    matrix = np.zeros((*v.shape, 3))
    matrix[..., 2, 1], matrix[..., 0, 2], matrix[..., 1, 0] = v[..., 0], v[..., 1], v[..., 2]
    matrix[..., 1, 2], matrix[..., 2, 0], matrix[..., 0, 1] = -v[..., 0], -v[..., 1], -v[..., 2]
    return matrix


def _tangent(rotation_vector: Array) -> tuple[Array, Array, BoolArray, Array]:
    """[v]x, the angle, whether it is too small for the closed forms, and an angle safe to divide by."""
    v = np.asarray(rotation_vector, dtype=np.float64)
    angle = np.linalg.norm(v, axis=-1)[..., None, None]
    small = angle < 1e-4  # angle [rad] below which series replace the closed forms, which lose digits there
    return cross_matrix(v), angle, small, np.where(small, 1.0, angle)


def right_jacobian(rotation_vector: Array) -> Array:
    """J_r (..., 3, 3) with Exp(v + dv) ≈ Exp(v) Exp(J_r dv): Solà (2018), eq. 143."""
    K, angle, small, safe = _tangent(rotation_vector)
    first = np.where(small, 0.5 - angle**2 / 24.0, (1.0 - np.cos(safe)) / safe**2)
    second = np.where(small, 1.0 / 6.0 - angle**2 / 120.0, (safe - np.sin(safe)) / safe**3)
    return np.asarray(np.eye(3) - first * K + second * (K @ K))


def right_jacobian_inverse(rotation_vector: Array) -> Array:
    """The inverse of `right_jacobian`, for angles below 2π: Solà (2018), eq. 144."""
    K, angle, small, safe = _tangent(rotation_vector)
    # (1 + cos) / (2 angle sin), written with the half angle so that it stays finite at π.
    closed = 1.0 / safe**2 - 1.0 / (2.0 * safe * np.tan(safe / 2.0))
    factor = np.where(small, 1.0 / 12.0 + angle**2 / 720.0, closed)
    return np.asarray(np.eye(3) + 0.5 * K + factor * (K @ K))


def hinge(axis: Array, angle: Array) -> Array:
    """Rotations by `angle` (...,) [rad] about a fixed unit `axis` (3,), as (..., 3, 3)."""
    return exponential(np.asarray(angle)[..., None] * np.asarray(axis))


def smallest(source: Array, target: Array) -> Array:
    """(..., 3, 3) the smallest rotations of unit vectors to others, about any axis for opposite ones."""
    axis = cross(source, target)
    cos = np.sum(source * target, axis=-1)[..., None, None]
    K = cross_matrix(axis)
    smallest = np.eye(3) + K + K @ K / np.maximum(1.0 + cos, 1e-9)
    if np.all(cos > -1.0 + 1e-9):
        return np.asarray(smallest)
    across = np.where(np.abs(source[..., :1]) < 0.7, [1.0, 0.0, 0.0], [0.0, 1.0, 0.0])
    half = unit(cross(source, across))
    about = 2.0 * half[..., :, None] * half[..., None, :] - np.eye(3)
    return np.asarray(np.where(cos > -1.0 + 1e-9, smallest, about))


def to_quaternions(rotation: Array) -> Array:
    """Unit quaternions (..., 4) in the order w, x, y, z, with w ≥ 0."""
    from scipy.spatial.transform import Rotation

    matrices = np.asarray(rotation, dtype=np.float64)
    xyzw: Array = Rotation.from_matrix(matrices.reshape(-1, 3, 3)).as_quat(canonical=True)
    return xyzw[:, [3, 0, 1, 2]].reshape(*matrices.shape[:-2], 4)


def continuous_quaternions(quaternions: Array) -> Array:
    """Quaternions (F, ..., 4) with signs flipped so that each lies nearest the one before.

    Interpolating components, as F-curves do, is right only between quaternions of one sign.
    """
    q = np.asarray(quaternions, dtype=np.float64)
    if len(q) < 2:
        return q.copy()
    turned = np.sum(q[1:] * q[:-1], axis=-1) < 0.0
    # Whether a frame's sign is flipped is the parity of the flips up to it.
    parity = np.concatenate([np.zeros((1, *turned.shape[1:]), int), np.cumsum(turned, axis=0)]) % 2
    return np.asarray(q * (1 - 2 * parity)[..., None])
