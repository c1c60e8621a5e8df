"""Candidate postures of a frame, and the confidence in each."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import expit, logit

from ..arrays import Array, IndexArray, SingleArray
from ..body.posture import Posture
from .composed_states import FrameStates
from .part_features import HEADINGS, StanceFeatures

DISTINCT_M = 0.08  # postures whose points differ by less on average, the hips aligned, look the same
ABOUT_RIGHT_M = 0.10  # mean distance of the points, the hips aligned, within which a match is about right
PROBABILITY_BOUNDS = 0.02, 0.98  # probabilities are clipped to these before their odds are taken
CHOSEN, OTHER = (-0.1, 0.5, 1.0 / 3.0), (-2.0, 2.0 / 3.0, 1.0 / 3.0)
"""Logistic regressions, rounded, of being about right, of the chosen posture, which the whole clip led to,
and of the others, on 25 recordings with truth: of 237 chosen ones said to be up to 40, 60, 80 and 100 % sure,
39, 45, 68 and 90 % were; of 1185 others up to 20, 40, 60 and 80 %, 14, 27, 53 and 63 %."""


@dataclass(frozen=True, eq=False)
class Candidate:
    """A posture that a frame may show, of a library or put together from parts."""

    posture: Posture  # of the take's body, in the world
    name: str
    """Name of the libraries' posture nearest to it, or to its trunk where it was put together; empty where
    no library was asked."""
    mirrored: bool  # whether it is nearest to the mirror image of that
    confidence: float  # probability that it is about right, 0 to 1


@dataclass(frozen=True, eq=False)
class MatchedFrame:
    """The candidates of one frame."""

    index: int  # Index in the clip
    candidates: tuple[Candidate, ...]  # the chosen one first, then the alternatives, the likelier first


def composed_candidates(
    stances: StanceFeatures,
    states: FrameStates,
    posterior: SingleArray,
    chosen: Posture,
    torso: int,
    explained: float,
) -> tuple[Candidate, ...]:
    """The chosen posture of a frame and distinct ones beside it, the likelier first.

    Args:
        stances: All stances.
        states: The frame's states.
        posterior: (K,) their probabilities given the whole clip.
        chosen: The posture as fitted to the footage.
        torso: Its torso in the pool.
        explained: Share of the frame that it explains, 0 to 1.
    """
    likely = np.argsort(-posterior, kind="stable")[:60]
    some, pools = states.chosen(likely), stances.pools
    composed = stances.composed(some.stance, some.limbs, some.hips)
    everyone = Posture.concatenate([Posture.stack([chosen]), composed])
    shape = pools.body.points(pools.body.pose(everyone)) - everyone.translation[:, None]
    weight = np.concatenate([[0.0], posterior[likely] / max(float(posterior[likely].sum()), 1e-12)])
    kept = distinct_rows(shape, np.arange(len(shape)), DISTINCT_M, most=6)
    found = []
    for rank in map(int, kept):
        near = np.linalg.norm(shape - shape[rank], axis=-1).mean(axis=-1) < ABOUT_RIGHT_M
        own = torso if rank == 0 else int(some.stance[rank - 1]) // HEADINGS
        name, flipped = pools.names[pools.torsos.source[own]]
        shares = log_odds(float(weight[near].sum())), log_odds(explained)
        found.append(Candidate(everyone[rank], name, flipped, confidence(OTHER if rank else CHOSEN, *shares)))
    return by_confidence(found)


def by_confidence(found: Sequence[Candidate]) -> tuple[Candidate, ...]:
    """Candidates in the order of their confidence, but for the chosen one, which stays first."""
    return (*found[:1], *sorted(found[1:], key=lambda each: -each.confidence))


def log_odds(probability: float) -> float:
    """Logarithm of a probability's odds, within `PROBABILITY_BOUNDS`."""
    return float(logit(np.clip(probability, *PROBABILITY_BOUNDS)))


def confidence(coefficients: tuple[float, float, float], *tells: float) -> float:
    """Probability that a posture is about right, by a logistic regression: its constant comes first.

    What tells is the share of the probability that the posture and those near it have among all that are
    known, and how well it explains the frame: one that beats all others may still be wrong.
    """
    return float(expit(np.dot(coefficients, (1.0, *tells))))


def distinct_rows(points: Array, order: IndexArray, apart_m: float, most: int) -> IndexArray:
    """At most `most` rows, the first in `order`, of postures (S, P, 3) that are `apart_m` apart."""
    kept: list[int] = []
    for row in map(int, order):
        if not kept or np.linalg.norm(points[kept] - points[row], axis=-1).mean(axis=-1).min() > apart_m:
            kept.append(row)
        if len(kept) == most:
            break
    return np.array(kept, dtype=np.intp)
