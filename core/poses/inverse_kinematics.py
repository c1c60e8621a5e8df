"""Inverse kinematics by pulls on points, and lines of sight on which a point that is dragged may lie.

A point keeps its image exactly as long as it stays on the line from the camera through it, whatever the lens.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from scipy.optimize import least_squares

from ..arrays import Array
from ..body import rotations
from ..body.kinematics import Body
from ..body.posture import Posture
from ..body.posture_fit import LIMIT_STD_RAD
from ..camera.camera import Camera


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


# --- Inverse kinematics


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
    begin: Mapping[str, float] = MappingProxyType({}),
) -> Posture:
    """A single posture whose points come as near to their places as its joints allow; lengths are exact.

    `free` has the standard deviation of each joint that may move, in the tangent space about `posture` [rad],
    that of the hips' place as `place` [m]; all others stay. The search begins off `posture` by `begin`.
    """
    skeleton = body.skeleton
    names = [name.rpartition(".") for name in skeleton.dof_names]
    owners = ["place" if part.startswith("location") else joint for joint, _, part in names]
    dofs = np.array([row for row, owner in enumerate(owners) if owner in free], dtype=np.intp)
    scale = np.array([free[owners[dof]] for dof in dofs])
    columns = [skeleton.point_names.index(pull.point) for pull in pulls]
    places, weights = (np.array(each) for each in zip(*((p.place, p.weights) for p in pulls), strict=True))
    values = posture.to_vector()  # what is beyond joint limits already may stay there
    lower, upper = np.minimum(skeleton.limits[:, 0], values), np.maximum(skeleton.limits[:, 1], values)

    def full(step: Array) -> Array:
        every = np.zeros(skeleton.dof_count)
        every[dofs] = step * scale
        return every

    off_start = np.array([begin.get(owners[dof], 0.0) for dof in dofs]) / scale
    begun = posture.plus(full(off_start))

    def rows(step: Array) -> Array:
        moved = begun.plus(full(step))
        off = body.points(body.pose(moved))[columns] - places
        values = moved.to_vector()
        beyond = (values - np.clip(values, lower, upper)) / LIMIT_STD_RAD
        return np.concatenate([(weights @ off[..., None]).ravel(), beyond, step + off_start])

    def slopes(step: Array) -> Array:
        moved, about = begun.plus(full(step)), begun.plus_jacobian(full(step))
        values = moved.to_vector()
        # d posture vector / d tangent: 1 but for balls, whose components are of rotation vectors.
        vector, balls = np.eye(len(values)), skeleton.ball_dofs
        vector[balls[:, :, None], balls[:, None, :]] = rotations.right_jacobian_inverse(values[balls])
        vector[values == np.clip(values, lower, upper)] = 0.0
        points = (weights @ body.points_jacobian(body.pose(moved))[columns]).reshape(-1, len(about))
        jacobian = np.concatenate([points, vector / LIMIT_STD_RAD]) @ about
        return np.concatenate([jacobian[:, dofs] * scale, np.eye(len(dofs))])

    # Of 40 steps each lowers the cost by this share, or is the last.
    fitted = least_squares(rows, np.zeros(len(dofs)), slopes, method="lm", ftol=1e-7, max_nfev=40)
    return begun.plus(full(fitted.x))
