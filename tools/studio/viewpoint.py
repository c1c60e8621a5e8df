"""Camera poses by viewpoint and target."""

import numpy as np
from keymark.core.camera.camera import Camera


def look_at(
    place: tuple[float, float, float],
    target: tuple[float, float, float],
    lens_mm: float,
    size: tuple[int, int],
    tilt_deg: float = 0.0,
) -> Camera:
    """A camera that looks from `place` at `target` [m], its horizon tilted by `tilt_deg`."""
    backwards = np.array(place) - np.array(target)
    backwards /= np.linalg.norm(backwards)
    right = np.cross([0.0, 0.0, 1.0], backwards)
    right /= np.linalg.norm(right)
    upwards = np.cross(backwards, right)
    cosine, sine = np.cos(np.radians(tilt_deg)), np.sin(np.radians(tilt_deg))
    matrix = np.eye(4)
    matrix[:3, :3] = np.stack(
        [cosine * right + sine * upwards, cosine * upwards - sine * right, backwards], axis=-1
    )
    matrix[:3, 3] = place
    return Camera(lens_mm, 36.0, size, np.round(matrix, 9))


def look_from(
    azimuth_deg: float,
    distance_m: float,
    height_m: float,
    target: tuple[float, float, float],
    lens_mm: float,
    size: tuple[int, int],
    tilt_deg: float = 0.0,
) -> Camera:
    """A camera at a height and a distance from its target, turned about it from -Y toward +X."""
    azimuth = np.radians(azimuth_deg)
    x, y = target[0] + distance_m * np.sin(azimuth), target[1] - distance_m * np.cos(azimuth)
    return look_at((float(x), float(y), height_m), target, lens_mm, size, tilt_deg)
