"""Candidates of a frame among its composed states, and the confidence in each."""

import numpy as np

from ..arrays import Array, SingleArray
from ..body.kinematics import Body
from ..body.posture import Posture
from ..matching.candidates import (
    ABOUT_RIGHT_M,
    DISTINCT_M,
    MOST_CANDIDATES,
    Candidate,
    MatchedFrame,
    confidence,
    distinct_rows,
)
from .composed_states import FrameStates
from .part_features import HEADINGS, StanceFeatures, composed_postures
from .part_pools import PartPools

MOST_STATES = 60
"""Candidates are chosen among this many of the most probable states."""
CHOSEN, OTHER = (-0.1, 0.5, 1.0 / 3.0), (-2.0, 2.0 / 3.0, 1.0 / 3.0)
"""Logistic regressions, rounded, of being about right, of the chosen posture, which the whole clip led to,
and of the others, on 25 recordings with truth: of 237 chosen ones said to be up to 40, 60, 80 and 100 % sure,
39, 45, 68 and 90 % were; of 1185 others up to 20, 40, 60 and 80 %, 14, 27, 53 and 63 %."""


def composed_candidates(
    pools: PartPools,
    stances: StanceFeatures,
    states: FrameStates,
    posterior: SingleArray,
    index: int,
    chosen: Posture,
    torso: int,
    explained: float,
) -> MatchedFrame:
    """The chosen posture of a frame and distinct ones beside it, the likelier first.

    Args:
        pools: All parts.
        stances: Their stances.
        states: The frame's states.
        posterior: (K,) their probabilities given the whole clip.
        index: The frame's index in the clip.
        chosen: The posture as fitted to the footage.
        torso: Its torso in the pool.
        explained: Share of the frame that it explains, 0 to 1.
    """
    likely = np.argsort(-posterior, kind="stable")[:MOST_STATES]
    some = states.chosen(likely)
    postures = composed_postures(pools, stances, some.stance, some.limbs, some.hips)
    everyone = Posture.concatenate([Posture.stack([chosen]), postures])
    shape = _shape(pools.body, everyone)
    weight = np.concatenate([[0.0], posterior[likely] / max(float(posterior[likely].sum()), 1e-12)])
    kept = distinct_rows(shape, np.arange(len(shape)), DISTINCT_M, MOST_CANDIDATES)
    found = []
    for rank in map(int, kept):
        near = np.linalg.norm(shape - shape[rank], axis=-1).mean(axis=-1) < ABOUT_RIGHT_M
        own = torso if rank == 0 else int(some.stance[rank - 1]) // HEADINGS
        name, flipped = pools.motions.names[pools.torsos.source[own]]
        share = float(weight[near].sum())
        found.append(
            Candidate(everyone[rank], name, flipped, confidence(share, explained, OTHER if rank else CHOSEN))
        )
    return MatchedFrame(index, tuple(found))


def _shape(body: Body, postures: Posture) -> Array:
    """(N, P, 3) points relative to the hips [m]."""
    return np.asarray(body.points(body.pose(postures)) - postures.translation[:, None])
