"""The postures of one frame alone, with what keyframes nearby tell of it, and what contradicts them."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Array, BoolArray
from ..body.human import TRUNK, limb_of
from ..body.posture import Posture
from ..errors import InputError
from ..estimate.single_frame import FrameFit, fit_frame, frame_residuals
from ..prior.frame_prior import FramePrior, unrelated_std
from ..prior.library import Library
from ..terms.keypoints import JOINT_ERROR_STD_M, USUAL_PLACES
from .candidates import ABOUT_RIGHT_M, DISTINCT_M, PROBABILITY_BOUNDS, Candidate, by_confidence, distinct_rows
from .frame_search import FrameShown, Hypotheses, Knowledge, knowledge, points_from_hips, refined, search
from .plausibility import PARTS, part_shapes


def belief_costs(belief: FramePrior, posture: Posture) -> Array:
    """(S,) cost of postures beside keyframes: Gaussian near them, bounded by what tells them from others.

    Far from all keyframes their belief is as wide as that of unrelated postures, and the cost vanishes.
    """
    deviation = posture.minus(Posture.stack([belief.posture])) / belief.std
    told = np.log(np.maximum(unrelated_std(posture.skeleton) / belief.std, 1.0)).sum()
    # Share of the degrees of freedom that vary on their own: a body's change together.
    return np.asarray(0.5 * np.minimum(0.5 * (deviation**2).sum(axis=-1), told))


def believed_fit(
    known: Knowledge, shown: FrameShown, belief: FramePrior, floor_m: float | None
) -> tuple[FrameFit, float]:
    """The posture nearest to what keyframes tell that explains the frame, and its cost among hypotheses."""
    points = shown.points_of(False)
    fit = fit_frame(shown.evidence, shown.regions, belief, shown.frame, points=points)
    sides = np.array([False] if points is None else [False, True])
    postures = Posture.stack([fit.posture] * len(sides))
    cost = refined(known, shown, Hypotheses.given(postures, sides), floor_m).cost.min()
    return fit, float(cost + belief_costs(belief, postures[:1])[0])


# --- What contradicts a frame's plausible postures


UNWORN_COST = 12.0  # one marker in twenty is worn by nobody, at one of ten thousand places and sizes


@dataclass(frozen=True, eq=False)
class Unworn:
    """A region that nobody wears."""

    name: str  # Its marker
    shown: FrameShown  # the frame without it


def unworn_marker(
    known: Knowledge, shown: FrameShown, found: Hypotheses, floor_m: float | None
) -> Unworn | None:
    """The marker without which the rest of the frame is explained far better; None where there is none."""
    least = float(found.cost.min())
    visible = np.flatnonzero(shown.tracks.visible[0])
    # Nothing is left to gain where all is well explained.
    alone = len(visible) + int(shown.points.seen.sum()) < 2
    # What a keypoint costs where the posture is right, its guessed depth included: no gain of leaving a
    # marker out.
    if least < UNWORN_COST + 0.5 * shown.points.seen.sum() or alone or not len(visible):
        return None
    rest = {int(marker): shown.without(int(marker)) for marker in visible}
    gains = {
        # Starts of a search without a marker, which only asks how well the rest can be explained.
        marker: least - float(search(known, one, floor_m, 24).cost.min())
        for marker, one in rest.items()
    }
    best = max(gains, key=lambda marker: gains[marker])
    if gains[best] < UNWORN_COST:
        return None
    return Unworn(shown.tracks.names[best], rest[best])


def unexplained(known: Knowledge, shown: FrameShown, posture: Posture) -> tuple[str, ...]:
    """Names of what a posture does not explain, and of what is seen on limbs that it contorts."""
    points = shown.points_of(False)
    off = frame_residuals(shown.evidence, shown.regions, points, posture, shown.frame)
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


NO_TORSO = -1  # stands for the torso of a hypothesis from keyframes
INTERCEPT, SHARE_COEFFICIENT, COST_COEFFICIENT = 0.6, 0.45, -0.055
"""Logistic regression, rounded, of being about right, on 184 candidates of 64 frames of four takes with
truth: of those up to 20, 40, 60, 80 and 100 % sure, 13, 26, 42, 69 and 100 % were."""


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
    """Find the postures that a frame may show.

    Args:
        shown: The frame.
        libraries: What is known of postures.
        floor_m: Height of the floor in the world [m]; None where it is not known.
        belief: What keyframes nearby tell of the frame; None without any.

    Raises:
        InputError: No library has a posture, or nothing is seen in the frame.
    """
    if shown.is_empty:
        raise InputError("neither a marker nor a keypoint is seen in the frame, so no posture can be found")
    known = knowledge(shown.body, libraries)
    found = _hypotheses(known, shown, floor_m, belief)
    unworn = unworn_marker(known, shown, found, floor_m)
    left_out: tuple[str, ...] = ()
    if unworn is not None:
        shown, left_out = unworn.shown, (unworn.name,)
        found = _hypotheses(known, shown, floor_m, belief)
    candidates = _candidates(known, shown, found, floor_m)
    named = (*left_out, *unexplained(known, shown, candidates[0].posture))
    return FramePoses(candidates, tuple(dict.fromkeys(named)))


def near_pose(shown: FrameShown, belief: FramePrior) -> FramePoses:
    """The posture that explains a frame nearest to a pose that somebody has set for it.

    `belief` is about that pose, which is not doubted as a whole: no library is asked.
    """
    fit = fit_frame(shown.evidence, shown.regions, belief, shown.frame, points=shown.points_of(False))
    names = [shown.tracks.names[marker] for marker in fit.misplaced]
    only = Candidate(fit.posture, "", False, 1.0)
    return FramePoses((only,), (*names, *fit.misplaced_points), fit.cost)


def _hypotheses(
    known: Knowledge, shown: FrameShown, floor_m: float | None, belief: FramePrior | None
) -> Hypotheses:
    """Those of a search; what keyframes tell comes first."""
    found = search(known, shown, floor_m)
    if belief is None:
        return found
    fit, cost = believed_fit(known, shown, belief, floor_m)
    first = Hypotheses.given(Posture.stack([fit.posture]), np.array([False]))
    first = replace(first, cost=np.array([cost]), torso=np.array([NO_TORSO]))
    rest = replace(found, cost=found.cost + belief_costs(belief, found.posture))
    return Hypotheses.concatenate([first, rest])


def _candidates(
    known: Knowledge, shown: FrameShown, found: Hypotheses, floor_m: float | None
) -> tuple[Candidate, ...]:
    """Distinct candidates, each the mean of the hypotheses near it; what keyframes tell stays if it leads."""
    body = known.pools.body
    points = points_from_hips(body, found.posture)
    weight, near = _agreeing(points, found.cost)
    share = near @ weight
    leading = int(found.cost.argmin())
    kept = found.torso[leading] == NO_TORSO
    order = np.argsort(-share, kind="stable")
    if kept:
        order = np.concatenate([[leading], order])
    # Means that are brought to the evidence, where some may end alike.
    # Hypotheses that lead to different means are farther apart than this on average, hips aligned.
    chosen = distinct_rows(points, order, 0.13, 8)
    means = Posture.concatenate([_mean(found.posture, row, near[row] * weight) for row in chosen])
    start = replace(found.chosen(chosen), posture=means)
    final = refined(known, shown, start, floor_m)
    if kept:
        rest = final.posture[np.arange(1, len(chosen))]
        final = replace(final, posture=Posture.concatenate([found.posture[chosen[:1]], rest]))
    made = []
    ended = points_from_hips(body, final.posture)
    for rank in distinct_rows(ended, np.arange(len(chosen)), DISTINCT_M, 4):
        posture = final.posture[int(rank)]
        name, flipped = _nearest(known, posture)
        sure = _confidence(float(share[chosen[rank]]), float(final.cost[rank]))
        made.append(Candidate(posture, name, flipped, sure))
    return by_confidence(made)


def likeliest_mean(known: Knowledge, shown: FrameShown, found: Hypotheses, floor_m: float | None) -> Posture:
    """The mean of the hypotheses around the one that most agree with, brought to what is seen."""
    weight, near = _agreeing(points_from_hips(known.pools.body, found.posture), found.cost)
    row = int((near @ weight).argmax())
    mean = _mean(found.posture, row, near[row] * weight)
    start = replace(found.chosen(np.array([row])), posture=mean)
    return refined(known, shown, start, floor_m).posture[0]


ALIKE = 3.0  # costs count for so many times less: what is seen of one body errs together, and so do its parts


def _agreeing(points: Array, cost: Array) -> tuple[Array, BoolArray]:
    """Probabilities (S,) of hypotheses, and (S, S) which of them are about the same.

    `points` (S, P, 3) relative to the hips [m], `cost` (S,).
    """
    weight = np.exp(-(cost - cost.min()) / ALIKE)
    near = np.linalg.norm(points[:, None] - points, axis=-1).mean(axis=-1) < ABOUT_RIGHT_M
    return weight / weight.sum(), near


def _confidence(share: float, cost: float) -> float:
    """Probability that a candidate is about right, to 10 cm, the hips aligned.

    `share` is the probability of it and of those near it among all hypotheses of the frame, `cost` its own: a
    posture that beats all others may still explain the frame badly.
    """
    bounded = float(np.clip(share, *PROBABILITY_BOUNDS))
    odds = INTERCEPT + SHARE_COEFFICIENT * np.log(bounded / (1.0 - bounded)) + COST_COEFFICIENT * cost
    return float(1.0 / (1.0 + np.exp(-odds)))


def _nearest(known: Knowledge, posture: Posture) -> tuple[str, bool]:
    """Name of the known posture whose trunk is nearest, and whether it is mirrored."""
    own = known.postures
    shape = part_shapes(own.body, own.body.pose(Posture.stack([posture])))[TRUNK]
    row = int(np.linalg.norm(own.parts[TRUNK] - shape, axis=-1).argmin())
    return own.names[row], own.mirrored[row]


def _mean(postures: Posture, row: int, weight: Array) -> Posture:
    """The mean (1,) of postures in the tangent space of one of them, by weights (S,)."""
    own = np.flatnonzero(weight)
    step = postures[own].minus(postures[np.full(len(own), row)])
    return postures[np.array([row])].plus((weight[own] @ step / weight[own].sum())[None])
