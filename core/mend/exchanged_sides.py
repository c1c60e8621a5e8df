"""Frames in which left and right have changed places, as a network sees them behind a body."""

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..body.human import HUMAN
from ..body.mirror import other_side
from ..numerics.markov_chain import exchanged_path
from ..numerics.vectors import unit

EXCHANGE_COST = 8.0  # of a change between two frames: about that of one limb that jumps by its usual error
STEP_M = 0.05  # usual distance that a point moves in a frame, with the network's own error
FORWARD = 2.0  # cost of a knee and elbows that bend the wrong way, once in each frame


def exchanged_frames(points: Array) -> BoolArray:
    """(F,) where the points (F, 13, 3) have their sides exchanged; frames with NaN are as their neighbors.

    A body that turns moves on from frame to frame, exchanged sides jump to each other's places; which of the
    two ways is right, knees and the longer time tell.
    """
    known = np.flatnonzero(np.isfinite(points).all(axis=(1, 2)))
    exchanged = np.zeros(len(points), dtype=bool)
    if len(known) < 2:
        return exchanged
    seen = points[known]
    swapped = seen[:, opposite_points()]
    own = FORWARD * _wrong_way(seen)
    stay, change = _distances(seen[1:], seen[:-1]), _distances(seen[1:], swapped[:-1])
    states = exchanged_path(np.stack([own, -own], axis=-1), stay, change + EXCHANGE_COST)
    if not states.any() or states.all():  # a body that is wrong from end to end is left as it is
        return exchanged
    halfway = 0.5 * (known[1:] + known[:-1])
    return np.asarray(states[np.searchsorted(halfway, np.arange(len(points)))])


def opposite_points() -> IndexArray:
    """(13,) index of each point's opposite."""
    names = HUMAN.point_names
    return np.array([names.index(other_side(name)) for name in names], dtype=np.intp)


def _distances(after: Array, before: Array) -> Array:
    """(F,) how far the points move about their middle, with heavy tails."""
    relative = [points - points.mean(axis=1, keepdims=True) for points in (after, before)]
    squared = ((relative[0] - relative[1]) ** 2).sum(axis=-1)
    return np.asarray(np.log1p(squared / STEP_M**2).sum(axis=1))


def _wrong_way(points: Array) -> Array:
    """(F,) from -1 to 1 how clearly the knees bend backward, seen from the hips; 0 for straight legs."""
    at = {name: points[:, index] for index, name in enumerate(HUMAN.point_names)}
    across = unit(at["hip.L"] - at["hip.R"])
    trunk = unit(at["shoulder.L"] + at["shoulder.R"] - at["hip.L"] - at["hip.R"])
    ahead = unit(np.cross(across, trunk))
    total = np.zeros(len(points))
    for side in ("L", "R"):
        leg = unit(at[f"ankle.{side}"] - at[f"hip.{side}"])
        out = at[f"knee.{side}"] - at[f"hip.{side}"]
        out = out - (out * leg).sum(axis=-1, keepdims=True) * leg
        total -= (out * ahead).sum(axis=-1)
    # Distance of a knee from the line of its leg that is clear: a bend of about 40 degrees.
    return np.asarray(np.clip(total / 0.15, -1.0, 1.0))
