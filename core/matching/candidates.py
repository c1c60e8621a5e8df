"""Candidate postures of a frame, and the confidence in each."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array, IndexArray, SingleArray
from ..body.posture import Posture
from .state_path import StatePath

MOST_CANDIDATES = 6
MOST_STATES = 150
"""Candidates are chosen among this many of the most probable states."""
DISTINCT_M = 0.08
"""Postures whose points differ by less on average, the hips aligned, look the same."""
ABOUT_RIGHT_M = 0.10
"""Mean distance of the points, the hips aligned, within which a match is about right."""
PROBABILITY_BOUNDS = 0.02, 0.98
"""Probabilities are clipped to these before their odds are taken."""
MATCHED = -3.3, 1.0 / 3.0, 1.0
"""Logistic regression, rounded, of being about right, on 23 matches of 15 takes with truth, with right and
wrong libraries: of 393 postures said to be up to 30, 50, 70 and 85 % sure, 13, 40, 73 and 93 % were."""


@dataclass(frozen=True, eq=False)
class Candidate:
    """A posture that a frame may show, of a library or put together from parts."""

    posture: Posture
    """Of the take's body, in the world."""
    name: str
    """Name of the libraries' posture nearest to it, or to its trunk where it was put together; empty where
    no library was asked."""
    mirrored: bool
    """Whether it is nearest to the mirror image of that."""
    confidence: float
    """Probability that it is about right, 0 to 1."""


@dataclass(frozen=True, eq=False)
class MatchedFrame:
    """The candidates of one frame."""

    index: int
    """Index in the clip."""
    candidates: tuple[Candidate, ...]
    """The chosen one first, then the alternatives, the likelier first."""


def frame_candidates(
    path: StatePath,
    share: SingleArray,
    frame: int,
    index: int,
    chosen: Posture,
    nearest: int,
    explained: float,
) -> MatchedFrame:
    """The chosen posture of a frame and distinct ones beside it, the likelier first.

    Args:
        path: The Viterbi path.
        share: (K,) probability of each of the frame's states.
        frame: Which of the path's frames.
        index: Its index in the clip.
        chosen: The refined posture.
        nearest: Which of the sequences' postures that is nearest to.
        explained: Share of the frame that it explains, 0 to 1.
    """
    emission = path.emissions[frame]
    best = emission.index_of(int(path.best[frame]))
    count = min(MOST_STATES, len(share))
    likely = np.argpartition(-share, count - 1)[:count]
    likely = likely[np.argsort(-share[likely], kind="stable")]
    likely = np.concatenate([[best], likely[likely != best]]).astype(np.intp)
    postures = path.postures(frame, likely)
    shape = _shape(path, postures)
    shape[0] = _shape(path, Posture.stack([chosen]))[0]
    weight = share[likely] / max(float(share[likely].sum()), 1e-12)
    found = []
    for rank in map(int, distinct_rows(shape, np.arange(len(likely)), DISTINCT_M, MOST_CANDIDATES)):
        near = np.linalg.norm(shape - shape[rank], axis=-1).mean(axis=-1) < ABOUT_RIGHT_M
        state = int(emission.states[likely[rank]])
        posture = state // len(path.features.heading_rad) if rank else nearest
        found.append(
            Candidate(
                chosen if rank == 0 else postures[rank],
                path.sequences.name(posture),
                path.sequences.is_mirrored(posture),
                confidence(float(weight[near].sum()), explained),
            )
        )
    return MatchedFrame(index, tuple(found))


def confidence(share: float, explained: float, coefficients: tuple[float, float, float] = MATCHED) -> float:
    """Probability that a posture is about right.

    A posture that beats all others of the library may still be wrong: the library may hold no right one,
    which shows in how badly the markers fit.

    Args:
        share: Posterior probability of the posture and of those near it, among all that are known.
        explained: Share of the frame that the posture explains, 0 to 1.
        coefficients: Of a logistic regression: the constant, and those of both logarithms of odds.
    """
    odds = [np.log(value / (1.0 - value)) for value in np.clip([share, explained], *PROBABILITY_BOUNDS)]
    return float(1.0 / (1.0 + np.exp(-(np.array(coefficients) @ (1.0, *odds)))))


def _shape(path: StatePath, postures: Posture) -> Array:
    """(N, P, 3) points relative to the hips [m]."""
    body = path.sequences.body
    return np.asarray(body.points(body.pose(postures)) - postures.translation[:, None])


def distinct_rows(points: Array, order: IndexArray, apart_m: float, most: int) -> IndexArray:
    """Rows of postures' points that are apart from each other, the first in order.

    Args:
        points: (S, P, 3) points of S postures relative to the hips [m].
        order: Rows, those that are preferred first.
        apart_m: Mean distance of the points beyond which two postures are apart [m].
        most: Number of rows at most.
    """
    kept: list[int] = []
    for row in map(int, order):
        if not kept or np.linalg.norm(points[kept] - points[row], axis=-1).mean(axis=-1).min() > apart_m:
            kept.append(row)
        if len(kept) == most:
            break
    return np.array(kept, dtype=np.intp)
