"""The postures of one frame alone, with what keyframes nearby tell of it, and what contradicts them."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..body.posture import Posture
from ..errors import InputError
from ..estimate.single_frame import fit_frame, frame_residuals
from ..prior.frame_prior import FramePrior, unrelated_std
from ..prior.library import Library
from ..terms.keypoints import JOINT_ERROR_STD_M, USUAL_PLACES
from .found_poses import DISTINCT_M, Candidate, by_confidence, confidence, distinct_rows, log_odds
from .frame_search import (
    FrameSearch,
    FrameShown,
    Hypotheses,
    agreeing,
    mean_posture,
    points_from_hips,
)
from .part_pools import part_pools, usable_libraries

# --- What contradicts a frame's plausible postures


# --- The postures of one frame, with no keyframe at all


RIGHT = (0.6, 0.45, -0.055)
"""Logistic regression, rounded, of being about right by the share's odds and the cost, on 184 candidates of
64 frames of four takes with truth: of those up to 20, 40, 60, 80 and 100 % sure, 13, 26, 42, 69 and 100 %
were."""


@dataclass(frozen=True, eq=False)
class FramePoses:
    """What a frame may show."""

    candidates: tuple[Candidate, ...]  # the likeliest first; at least one
    contradictions: tuple[str, ...] = ()  # markers and keypoints that the first candidate does not explain
    cost: float = 0.0  # near a pose, -log of the posture's probability, up to a constant of the frame


def find_frame_poses(
    shown: FrameShown,
    libraries: Sequence[Library],
    floor_m: float | None = None,
    belief: FramePrior | None = None,
) -> FramePoses:
    """Find the postures that a frame may show, by libraries, a known floor and what keyframes nearby tell.

    Raises:
        InputError: No library has a posture, or nothing is seen in the frame.
    """
    if shown.is_empty:
        raise InputError("neither a marker nor a keypoint is seen in the frame, so no posture can be found")
    search = FrameSearch(part_pools(usable_libraries(libraries), shown.body), shown, floor_m)
    candidates = _candidates(search, _hypotheses(search, belief), has_believed=belief is not None)
    off = frame_residuals(shown.evidence, shown.regions, shown.points, candidates[0].posture, shown.frame)
    unexplained = [shown.tracks.names[marker] for marker in off.markers]
    # Hands and feet turn about wrists and ankles, of which a posture knows nothing.
    unexplained += [name for name in off.points if USUAL_PLACES[name].error_std_m <= JOINT_ERROR_STD_M]
    return FramePoses(candidates, tuple(dict.fromkeys(unexplained)))


def near_pose(shown: FrameShown, belief: FramePrior) -> FramePoses:
    """The posture that explains a frame nearest to a pose that somebody has set for it.

    `belief` is about that pose, which is not doubted as a whole: no library is asked.
    """
    fit = fit_frame(shown.evidence, shown.regions, belief, shown.frame, shown.points)
    names = [shown.tracks.names[marker] for marker in fit.off.markers]
    only = Candidate(fit.posture, "", False, 1.0)
    return FramePoses((only,), (*names, *fit.off.points), fit.cost)


def _hypotheses(search: FrameSearch, belief: FramePrior | None) -> Hypotheses:
    """Those of a search; the posture nearest to what keyframes tell that explains the frame comes first."""
    found, shown = search.hypotheses(), search.shown
    if belief is None:
        return found
    fit = fit_frame(shown.evidence, shown.regions, belief, shown.frame, shown.points)
    sides = np.array([False, True] if shown.evidence.keypoints.model.names else [False])
    own = Hypotheses(Posture.stack([fit.posture] * len(sides)), np.zeros(len(sides)), sides)
    least = search.descended(own).cost.min(keepdims=True)
    first = replace(own.chosen(np.zeros(1, dtype=np.intp)), cost=least)
    every = Hypotheses.concatenate([first, found])
    # Gaussian near what keyframes tell, bounded by what tells that from others: far from all keyframes their
    # belief is as wide as that of unrelated postures, and the cost vanishes.
    deviation = every.posture.minus(Posture.stack([belief.posture])) / belief.std
    most = np.log(np.maximum(unrelated_std(every.posture.skeleton) / belief.std, 1.0)).sum()
    # Share of the degrees of freedom that vary on their own: a body's change together.
    return replace(every, cost=every.cost + 0.5 * np.minimum(0.5 * (deviation**2).sum(axis=-1), most))


def _candidates(search: FrameSearch, found: Hypotheses, has_believed: bool) -> tuple[Candidate, ...]:
    """Distinct candidates, each the mean of the hypotheses near it; what keyframes tell stays if it leads."""
    body = search.pools.body
    points = points_from_hips(body, found.posture)
    weight, near = agreeing(points, found.cost)
    share = near @ weight
    kept = has_believed and int(found.cost.argmin()) == 0
    order = np.argsort(-share, kind="stable")
    if kept:
        order = np.append(0, order)
    # Means that are brought to the evidence, where some may end alike.
    # Hypotheses that lead to different means are farther apart than this on average, hips aligned.
    chosen = distinct_rows(points, order, 0.13, 8)
    means = Posture.concatenate([mean_posture(found.posture, row, near[row] * weight) for row in chosen])
    final = search.descended(replace(found.chosen(chosen), posture=means))
    if kept:
        rest = final.posture[np.arange(1, len(chosen))]
        final = replace(final, posture=Posture.concatenate([found.posture[chosen[:1]], rest]))
    made = []
    for rank in distinct_rows(points_from_hips(body, final.posture), np.arange(len(chosen)), DISTINCT_M, 4):
        posture = final.posture[int(rank)]
        sure = confidence(RIGHT, log_odds(float(share[chosen[rank]])), float(final.cost[rank]))
        made.append(Candidate(posture, *search.pools.nearest(posture), sure))
    return by_confidence(made)
