"""What else a frame may show, and how probable each is."""

import numpy as np
from numpy.typing import NDArray

from ...body.posture import Posture
from .candidate import Candidate, MatchedFrame
from .path import Path

Array = NDArray[np.float64]
Single = NDArray[np.float32]

MOST = 6
LOOKED_AT = 150
"""The most probable states among which distinct ones are sought."""
DISTINCT_M = 0.08
"""Postures whose points differ by less, the hips aligned, are the same to whoever looks."""
ABOUT_RIGHT_M = 0.10


def alternatives(path: Path, share: Single, row: int, frame: int, chosen: Posture) -> MatchedFrame:
    """The chosen posture of a frame and distinct ones beside it, the likelier first.

    Args:
        path: The way that was found.
        share: (N H,) probability of every state.
        row: Which of the path's frames.
        frame: Its position in the clip.
        chosen: The posture that was chosen there.
    """
    best = int(path.best[row])
    count = min(LOOKED_AT, len(share))
    likely = np.argpartition(-share, count - 1)[:count]
    likely = likely[np.argsort(-share[likely], kind="stable")]
    likely = np.concatenate([[best], likely[likely != best]]).astype(np.intp)
    postures = path.postures(row, likely)
    shape = _shape(path, postures)
    shape[0] = _shape(path, Posture.stack([chosen]))[0]
    weight = share[likely] / max(float(share[likely].sum()), 1e-12)
    kept: list[int] = []
    for index in range(len(likely)):
        if all(_apart(shape[index], shape[other]) > DISTINCT_M for other in kept):
            kept.append(index)
        if len(kept) == MOST:
            break
    headings = len(path.states.heading_rad)
    found = []
    for index in kept:
        near = np.linalg.norm(shape - shape[index], axis=-1).mean(axis=-1) < ABOUT_RIGHT_M
        posture = int(likely[index]) // headings
        found.append(
            Candidate(
                chosen if index == 0 else postures[index],
                path.chains.name(posture),
                path.chains.is_mirrored(posture),
                float(np.clip(weight[near].sum(), 0.0, 1.0)),
            )
        )
    return MatchedFrame(frame, tuple(found))


def _shape(path: Path, postures: Posture) -> Array:
    """(N, P, 3) points relative to the hips [m]."""
    body = path.chains.body
    return np.asarray(body.points(body.pose(postures)) - postures.translation[:, None])


def _apart(first: Array, second: Array) -> float:
    return float(np.linalg.norm(first - second, axis=-1).mean())
