"""The way over the ground: taken off the whole motion, or onto a root bone."""

import numpy as np

from ...arrays import Array
from ...body.heading import yaw_rotation
from .smoothing import smoothed

WAY_S = 0.4
"""Standard deviation in time of what counts as the way and heading; faster changes are sway."""


def smooth_way(hips: Array, time_s: Array) -> Array:
    """(F, 3) the smoothed way of the hips over the ground from where they begin [m]; heights are 0."""
    way = smoothed(hips - hips[0], time_s, WAY_S) * [1.0, 1.0, 0.0]
    return way - way[0]


def smooth_headings_rad(headings_rad: Array, time_s: Array) -> Array:
    """(F,) smoothed headings from the first one."""
    return smoothed(np.unwrap(headings_rad) - headings_rad[0], time_s, WAY_S)


def root_poses(rest: Array, stand: Array, way: Array, heading_rad: Array) -> Array:
    """(F, 4, 4) poses of a root bone that goes along a way and turns, canonical [m].

    Args:
        rest: (4, 4) the bone at rest, canonical [m].
        stand: (3,) the point that goes along the way, at rest [m].
        way: (F, 3) [m].
        heading_rad: (F,).
    """
    turn = yaw_rotation(heading_rad)
    poses = np.broadcast_to(np.eye(4), (len(way), 4, 4)).copy()
    poses[:, :3, :3] = turn @ rest[:3, :3]
    poses[:, :3, 3] = stand + way + turn @ (rest[:3, 3] - stand)
    return poses
