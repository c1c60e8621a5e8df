"""Postures within their joint limits, cameras around them, and what is asked of a corrected pose."""

import numpy as np
from keymark.core.arrays import Array
from keymark.core.body.actor import Actor
from keymark.core.body.human import HUMAN
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture
from keymark.core.camera.camera import Camera

BODY = Body(Actor.from_stature(1.75))
COLUMN = {name: i for i, name in enumerate(HUMAN.dof_names)}
POINT = {name: i for i, name in enumerate(HUMAN.point_names)}


def natural_posture(seed: int, share: float = 0.7) -> Posture:
    """A posture anywhere in the inner share of its joint limits, near the origin and facing anywhere."""
    rng = np.random.default_rng(seed)
    lower, upper = HUMAN.limits.T
    vector = np.zeros(HUMAN.dof_count)
    bounded = np.isfinite(lower)
    lower, upper = lower[bounded], upper[bounded]
    middle, half = 0.5 * (lower + upper), 0.5 * (upper - lower)
    vector[bounded] = middle + share * half * rng.uniform(-1.0, 1.0, int(bounded.sum()))
    vector[:6] = [*rng.normal(0.0, 0.2, 2), 1.0, 0.0, 0.0, rng.uniform(-np.pi, np.pi)]
    return Posture.from_vector(HUMAN, vector)


def camera_around(seed: int) -> Camera:
    """A camera at 3 to 6 m in any direction, from knee height to above the head, which looks at the body."""
    rng = np.random.default_rng(seed)
    angle, away, height = rng.uniform(0.0, 2.0 * np.pi), rng.uniform(3.0, 6.0), rng.uniform(0.5, 2.5)
    return camera_at(np.array([away * np.sin(angle), -away * np.cos(angle), height]))


def camera_at(eye: Array) -> Camera:
    """A camera at a place (3,) that looks at the body's middle."""
    back = eye - np.array([0.0, 0.0, 1.0])
    back /= np.linalg.norm(back)
    right = np.cross([0.0, 0.0, 1.0], back)
    right /= np.linalg.norm(right)
    matrix = np.eye(4)
    matrix[:3] = np.column_stack([right, np.cross(back, right), back, eye])
    return Camera(35.0, 36.0, (1280, 720), matrix)


def points(posture: Posture) -> Array:
    """(13, 3) the principal points [m]."""
    return BODY.points(BODY.pose(posture))


def pixels(posture: Posture, camera: Camera) -> Array:
    """(13, 2) their images [px]."""
    return camera.project(points(posture))[0]


def segment_lengths(posture: Posture) -> Array:
    """Length of every segment of a posture [m]."""
    pose = BODY.pose(posture)
    ends = [BODY.segment_ends(pose, segment.name) for segment in HUMAN.segments]
    return np.array([np.linalg.norm(end - start) for start, end in ends])


def beyond_limits_rad(posture: Posture) -> Array:
    """(D,) how far each degree of freedom is beyond its limits [m, rad]."""
    values = posture.to_vector()
    lower, upper = HUMAN.limits.T
    return np.abs(values - np.clip(values, lower, upper))
