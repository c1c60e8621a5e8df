"""How one bone follows another: the offset between them over several poses."""

import numpy as np

from ...arrays import Array
from .control_spaces import constant_turn, unscaled


def rigid_offset(leading: Array, following: Array) -> tuple[Array, float, float]:
    """The pose of a bone in another one's axes, as it is on average.

    Args:
        leading: (S, 4, 4) poses of the bone that leads.
        following: (S, 4, 4) poses of the bone that follows.

    Returns:
        The offset (4, 4) with `following = leading @ offset`, without scale; by how much turn [rad] and place
        [the poses' unit] differ from it at most.
    """
    axes = np.swapaxes(unscaled(leading[:, :3, :3]), -1, -2)
    turn, turn_rad = constant_turn(axes @ unscaled(following[:, :3, :3]))
    places = (axes @ (following[:, :3, 3] - leading[:, :3, 3])[..., None])[..., 0]
    offset = np.eye(4)
    offset[:3, :3], offset[:3, 3] = turn, places.mean(axis=0)
    return offset, turn_rad, float(np.linalg.norm(places - offset[:3, 3], axis=-1).max())
