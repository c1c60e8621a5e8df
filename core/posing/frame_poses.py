"""The postures of one frame, with no keyframe at all: a few distinct candidates, each with a confidence.

What is seen of a frame does not tell a posture: several explain it alike. So the hypotheses of a search
(`frame_search`) are gathered around the likeliest ones; each candidate is the mean of those near it, weighed by
their probability and brought to the evidence again, which is nearer to the truth than the best single one.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..body.posture import Posture
from ..errors import InputError
from ..library.library import Library
from ..matching.candidates import ABOUT_RIGHT_M, Candidate
from .frame_search import Hypotheses, Knowledge, distinct, knowledge, points_from_hips, refined, search
from .frame_shown import FrameShown

MOST_CANDIDATES = 4
APART_M = 0.13
"""Candidates' points, hips aligned, are farther apart than this on average: someone sees the difference."""
TEMPERATURE = 3.0
"""Costs count for so many times less: what is seen of one body errs together, and so do its parts."""


@dataclass(frozen=True, eq=False)
class FramePoses:
    """What a frame may show."""

    candidates: tuple[Candidate, ...]
    """The likeliest first; at least one."""
    contradictions: tuple[str, ...] = ()
    """Names of the markers and keypoints that no plausible posture explains."""


def find_frame_poses(
    shown: FrameShown, libraries: Sequence[Library], floor_m: float | None = None
) -> FramePoses:
    """Find the postures that a frame may show.

    Args:
        shown: The frame.
        libraries: What is known of postures.
        floor_m: Height of the floor in the world [m]; None where it is not known.

    Raises:
        InputError: No library has a posture, or nothing is seen in the frame.
    """
    if shown.is_empty:
        raise InputError("neither a marker nor a keypoint is seen in the frame, so no posture can be found")
    known = knowledge(shown.body, libraries)
    found = search(known, shown, floor_m)
    return FramePoses(_candidates(known, shown, found, floor_m))


def _candidates(
    known: Knowledge, shown: FrameShown, found: Hypotheses, floor_m: float | None
) -> tuple[Candidate, ...]:
    body = known.pools.body
    points = points_from_hips(body, found.posture)
    weight = np.exp(-(found.cost - found.cost.min()) / TEMPERATURE)
    weight /= weight.sum()
    near = np.linalg.norm(points[:, None] - points, axis=-1).mean(axis=-1) < ABOUT_RIGHT_M
    share = near @ weight
    chosen = distinct(points, np.argsort(-share, kind="stable"), APART_M, MOST_CANDIDATES)
    means = Posture.concatenate([_mean(found.posture, row, near[row] * weight) for row in chosen])
    start = Hypotheses(means, found.cost[chosen], found.torso[chosen], found.exchanged[chosen])
    final = refined(known, shown, start, floor_m)
    made = []
    for rank, row in enumerate(chosen):
        name, flipped = known.pools.names[known.pools.torsos.source[found.torso[row]]]
        made.append(Candidate(final.posture[rank], name, flipped, float(share[row])))
    return tuple(made)


def _mean(postures: Posture, row: int, weight: Array) -> Posture:
    """The mean (1,) of postures in the tangent space of one of them, by weights (S,)."""
    own = np.flatnonzero(weight)
    step = postures[own].minus(postures[np.full(len(own), row)])
    return postures[np.array([row])].plus((weight[own] @ step / weight[own].sum())[None])
