"""Inverse kinematics by pulls on points, and lines of sight on which a point that is dragged may lie.

A point keeps its image exactly as long as it stays on the line from the camera through it, whatever the lens.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..body import rotations
from ..body.kinematics import Body
from ..body.posture import Posture
from ..camera.camera import Camera
from ..numerics.robust import Equations, levenberg_marquardt


@dataclass(frozen=True, eq=False)
class SightLine:
    """A line along which a view looks."""

    origin: Array  # (3,) a place on it [m]: the camera's, where it is a camera's
    direction: Array  # (3,) unit vector, in which depth increases

    @classmethod
    def to(cls, camera: Camera, place: Array, frame: int | None = None) -> "SightLine":
        """The line of sight of a camera to a place (3,) [m]; only one that stands still needs no frame."""
        _, eye = camera.pose(frame)
        return cls(np.asarray(eye), np.asarray(camera.sight(place, frame)))

    def along_m(self, place: Array) -> float:
        """How far along the line a place (3,) lies from its origin [m]."""
        return float((place - self.origin) @ self.direction)

    def nearest(self, place: Array) -> Array:
        """The place on the line (3,) that is nearest to another (3,) [m]."""
        return np.asarray(self.origin + self.along_m(place) * self.direction)

    def off_m(self, place: Array) -> float:
        """Distance of a place (3,) from the line [m]."""
        return float(np.linalg.norm(place - self.nearest(place)))

    def at_distance(self, center: Array, radius_m: float) -> Array:
        """(2, 3) the places on the line at exactly a distance from a center, in order of depth.

        Where the line passes the center farther away, both are the place at that distance which is nearest to
        the line.
        """
        foot = self.nearest(center)
        off = foot - center
        aside = float(np.linalg.norm(off))
        if aside >= radius_m:
            nearest = center + off * (radius_m / aside)
            return np.stack([nearest, nearest])
        half = float(np.sqrt(radius_m**2 - aside**2))
        return np.stack([foot - half * self.direction, foot + half * self.direction])

    def within(self, place: Array, center: Array, radii_m: tuple[float, float]) -> Array:
        """The place (3,) near the line whose distance from a center (3,) lies between two radii [m].

        It is the place on the line nearest to another (3,), or else the nearest to that at such a distance.
        """
        on_line = self.nearest(place)
        least, most = radii_m
        away = float(np.linalg.norm(on_line - center))
        if least <= away <= most:
            return on_line
        choices = self.at_distance(center, most if away > most else least)
        return np.asarray(min(choices, key=lambda choice: float(np.linalg.norm(choice - on_line))))


# --- Inverse kinematics


LIMIT_STD_RAD = 0.02  # standard deviation of what is beyond a joint's limits, as in `body/posture_fit`


@dataclass(frozen=True, eq=False)
class Pull:
    """A place that a point of the body should come to."""

    point: str  # name of a principal point
    place: Array  # (3,) in the world [m]
    std_m: float  # standard deviation of its distance from there [m], or of that ...
    sight: Array | None = None  # ... across this unit direction (3,), where given, ...
    depth_std_m: float = 0.0  # ... and of that along it [m]

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
        40,
        1e-7,  # share by which a step must lower the cost for another to be worth it
    )
    return problem.moved(step)


class _Problem:
    """Cost of a step of the free joints, with its derivatives."""

    def __init__(
        self, body: Body, posture: Posture, pulls: Sequence[Pull], free: Mapping[str, float], allowed: Posture
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
