"""The postures of one frame alone, with what keyframes nearby tell of it, and what contradicts them."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Array
from ..body.human import TRUNK, limb_of
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
    Knowledge,
    agreeing,
    knowledge,
    mean_posture,
    points_from_hips,
)
from .plausibility import PARTS, part_shapes


def belief_costs(belief: FramePrior, posture: Posture) -> Array:
    """(S,) cost of postures beside keyframes: Gaussian near them, bounded by what tells them from others.

    Far from all keyframes their belief is as wide as that of unrelated postures, and the cost vanishes.
    """
    deviation = posture.minus(Posture.stack([belief.posture])) / belief.std
    told = np.log(np.maximum(unrelated_std(posture.skeleton) / belief.std, 1.0)).sum()
    # Share of the degrees of freedom that vary on their own: a body's change together.
    return np.asarray(0.5 * np.minimum(0.5 * (deviation**2).sum(axis=-1), told))


# --- What contradicts a frame's plausible postures


UNWORN_COST = 12.0  # one marker in twenty is worn by nobody, at one of ten thousand places and sizes


def unworn_marker(search: FrameSearch, found: Hypotheses) -> int | None:
    """The marker without which the rest of the frame is explained far better; None where there is none."""
    shown, least = search.shown, float(found.cost.min())
    visible, points = np.flatnonzero(shown.tracks.visible[0]), int(shown.points.seen.sum())
    # Nothing is left to gain where all is well explained. What a keypoint costs where the posture is right,
    # its guessed depth included, is no gain of leaving a marker out.
    if least < UNWORN_COST + 0.5 * points or len(visible) + points < 2 or not len(visible):
        return None
    gains = {
        # Starts of a search without a marker, which only asks how well the rest can be explained.
        int(marker): least
        - float(replace(search, shown=shown.without(int(marker))).hypotheses(24).cost.min())
        for marker in visible
    }
    best = max(gains, key=lambda marker: gains[marker])
    return best if gains[best] >= UNWORN_COST else None


def unexplained(known: Knowledge, shown: FrameShown, posture: Posture) -> tuple[str, ...]:
    """Names of what a posture does not explain, and of what is seen on limbs that it contorts."""
    off = frame_residuals(shown.evidence, shown.regions, shown.points, posture, shown.frame)
    names = [shown.tracks.names[marker] for marker in off.markers]
    # Hands and feet turn about wrists and ankles, of which a posture knows nothing.
    names += [name for name in off.points if USUAL_PLACES[name].error_std_m <= JOINT_ERROR_STD_M]
    bent = known.postures.contorted(known.pools.body.pose(Posture.stack([posture])))[0]
    parts = [part for part, is_bent in zip(PARTS, bent, strict=True) if is_bent]
    worn = zip(shown.tracks.names, shown.segments, shown.tracks.visible[0], strict=True)
    names += [name for name, segment, seen in worn if seen and limb_of(segment) in parts]
    if not shown.segments:
        seen = zip(shown.keypoints.names, shown.points.seen[0], strict=True)
        names += [name for name, is_seen in seen if is_seen and limb_of(name) in parts]
    return tuple(dict.fromkeys(names))


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
    search = FrameSearch(knowledge(shown.body, libraries), shown, floor_m)
    found = _hypotheses(search, belief)
    unworn = unworn_marker(search, found)
    left_out: tuple[str, ...] = ()
    if unworn is not None:
        search, left_out = replace(search, shown=shown.without(unworn)), (shown.tracks.names[unworn],)
        found = _hypotheses(search, belief)
    candidates = _candidates(search, found, has_believed=belief is not None)
    named = (*left_out, *unexplained(search.known, search.shown, candidates[0].posture))
    return FramePoses(candidates, tuple(dict.fromkeys(named)))


def near_pose(shown: FrameShown, belief: FramePrior) -> FramePoses:
    """The posture that explains a frame nearest to a pose that somebody has set for it.

    `belief` is about that pose, which is not doubted as a whole: no library is asked.
    """
    fit = fit_frame(shown.evidence, shown.regions, belief, shown.frame, shown.points)
    names = [shown.tracks.names[marker] for marker in fit.misplaced]
    only = Candidate(fit.posture, "", False, 1.0)
    return FramePoses((only,), (*names, *fit.misplaced_points), fit.cost)


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
    return replace(every, cost=every.cost + belief_costs(belief, every.posture))


def _candidates(search: FrameSearch, found: Hypotheses, has_believed: bool) -> tuple[Candidate, ...]:
    """Distinct candidates, each the mean of the hypotheses near it; what keyframes tell stays if it leads."""
    body = search.known.pools.body
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
    own = search.known.postures
    for rank in distinct_rows(points_from_hips(body, final.posture), np.arange(len(chosen)), DISTINCT_M, 4):
        posture = final.posture[int(rank)]
        # The known posture whose trunk is nearest gives the name.
        shape = part_shapes(own.body, own.body.pose(Posture.stack([posture])))[TRUNK]
        nearest = int(np.linalg.norm(own.parts[TRUNK] - shape, axis=-1).argmin())
        sure = confidence(RIGHT, log_odds(float(share[chosen[rank]])), float(final.cost[rank]))
        made.append(Candidate(posture, own.names[nearest], own.mirrored[nearest], sure))
    return by_confidence(made)
