"""How the motion departs from the prior, learned from the estimate by the markers: turns, and how far.

Keyframes tell only roughly how much happens between them: swings that all of them show at the same phase, or
a gap as long as the swing, leave them alike. Once the markers are followed the footage itself tells, for each
limb how fast it departs from the prior, and for each point and gap how far the prior misses it across the
line of sight. It misses as much along it, where nothing is seen.

The sizes are estimated from the solution and then believed (empirical Bayes: Robbins 1956; in state space
models Shumway & Stoffer 1982, *An approach to time series smoothing and forecasting using the EM algorithm*).
"""

from collections.abc import Generator
from dataclasses import dataclass, replace
from itertools import compress

import numpy as np

from ..arrays import Array
from ..numerics.vectors import runs
from ..prior.frame_prior import REFERENCE_STEP_S
from ..prior.keyframes import FULL_TURN, heading_steps_rad
from ..progress import Part, scaled
from ..terms.depths import DEPTH_STD_M
from ..terms.term import ClipState
from .assembly import stillness_term
from .belief import found_covariance
from .clip_problem import ClipData, ClipProblem
from .contour_evidence import ContourEvidence, learn_contours
from .contour_search import all_located, contour_schedule, points_locate
from .sigma import GRACE_S
from .window_problem import WindowProblem, image_cost
from .windows import Window, spliced

# --- Which way round the body turns between two keyframes


BEGUN = (8.0, 4.0, 2.0, 1.0, 1.0)  # image variance in an alternative's first steps, which tell a hopeless one
LARGE_STEP_RAD = np.radians(60.0)  # a turn between keyframes from which on the other way round is tried
FASTEST_RAD_PER_S = 3.0 * FULL_TURN  # nobody turns faster: dancers make two to three turns a second


def other_way(problem: ClipProblem, state: ClipState, other: ClipProblem) -> Generator[None, None, float]:
    """How much less a stretch costs about another prior, in negative log probability.

    It is solved once more from its `state`, the solution of consecutive frames cut from a window's, and anew
    about the other prior; -inf where that is hopeless.
    """
    first, last = int(state.frame[0]), int(state.frame[-1]) + 1
    window = Window(first, last, first, last)
    here = WindowProblem(problem, window, state)
    there = WindowProblem(other, window, other.start(window))
    known = yield from here.descend(())
    begun = yield from there.descend(BEGUN)
    # An alternative that costs more than the estimate by three tenths of it and 50 besides is given up by
    # then. The other steps save a third of an alternative's cost at most, and mostly a tenth.
    if begun.sum() > 1.3 * known.sum() + 50.0:
        return -np.inf
    settled = yield from here.descend((1.0,) * 4)  # its window was solved already
    ended = yield from there.descend((1.0,) * 10)  # where it departs far from the prior, as in long gaps
    return float(settled.sum() - ended.sum())


def cut(states: list[ClipState], first: int, last: int, margin: int) -> ClipState | None:
    """The state of frames `first` to `last - 1` and a margin around them; None where no window has all."""
    for state in states:
        begin, end = int(state.frame[0]), int(state.frame[-1]) + 1
        if begin <= first and last <= end:
            return state.of_frames(slice(max(first - margin - begin, 0), min(last + margin, end) - begin))
    return None


@dataclass(frozen=True)
class DoubtedTurn:
    """A gap between keyframes in which the body may turn another way."""

    gap: int
    turns: tuple[int, ...]  # whole turns that may have to be added to the short way round
    strength: float  # by which the most doubtful gap comes first


def doubted_turns(problem: ClipProblem, cost: Array) -> list[DoubtedTurn]:
    """Gaps to be tried another way round, the most doubtful first.

    `cost` (F,): what each marker seen costs on average, the short way round.
    """
    keyframes = problem.data.belief.frame
    step = heading_steps_rad(problem.data.belief.postures)
    found = []
    for gap in range(len(step)):
        first, last = int(keyframes[gap]), int(keyframes[gap + 1])
        if last - first < 2:
            continue
        time_s = float(problem.data.step_s[first:last].sum())
        misfit = float(cost[first + 1 : last].mean())
        # 0.3: gaps of this time and longer ...
        # 0.5: ... in which each marker seen costs more than this are tried both ways round. With noise as
        # assumed it would cost 2; the slow biases take most of that, so that it is 0.1 to 0.2 where all is
        # well.
        doubted = time_s >= 0.3 and misfit > 0.5
        if abs(step[gap]) < LARGE_STEP_RAD and not doubted:
            continue
        ways = (-1, 1) if doubted else (-1 if step[gap] > 0.0 else 1,)
        farthest = FASTEST_RAD_PER_S * time_s
        possible = [way for way in ways if abs(step[gap] + FULL_TURN * way) <= farthest]
        if possible:
            found.append(DoubtedTurn(gap, tuple(possible), misfit + abs(float(step[gap])) / np.pi))
    return sorted(found, key=lambda doubt: (-doubt.strength, doubt.gap))


def choose_turns(problem: ClipProblem, states: list[ClipState]) -> Part[tuple[ClipProblem, list[ClipState]]]:
    """Turn the other way round where that costs less: Gauss-Newton ends in the optimum next to its start.

    `states` are windows, solved, which may overlap.
    """
    states = list(states)
    data = problem.data
    # 0.2: how far beyond its keyframes, which hold it, a stretch is solved
    margin = round(0.2 / (data.pace * REFERENCE_STEP_S))
    seen = bool(data.observed.quality.any() or data.points.seen.any())  # contours alone decide nothing
    doubts = doubted_turns(problem, image_cost(problem, states)) if seen else []
    for number, doubt in enumerate(doubts):
        first, last = (int(frame) for frame in problem.data.belief.frame[doubt.gap : doubt.gap + 2])
        state = cut(states, first, last + 1, margin)
        if state is None:
            continue
        # 3.0: another turn is taken where it costs less by so much: it is twenty times as probable
        best, most = problem, 3.0
        for way in doubt.turns:
            turns = problem.turns.copy()
            turns[doubt.gap] = way
            other = problem.with_turns(turns)
            trying = other_way(problem, state, other)
            gain = yield from scaled(trying, number / len(doubts), (number + 1) / len(doubts))
            if gain > most:
                best, most = other, gain
        if best is not problem:
            turned = (best.prior.rotations != problem.prior.rotations).any(axis=(1, 2, 3))
            problem = best
            for index, one in enumerate(states):
                if turned[one.frame].any():
                    whole = Window(int(one.frame[0]), int(one.frame[-1]) + 1, 0, 0)
                    part = WindowProblem(problem, whole, problem.start(whole))
                    yield from scaled(part.follow_markers(), 1.0, 1.0)
                    states[index] = part.state.without_cache()
    return problem, states


# --- Sizes of the motion


# Root mean square second difference of a limb's unknowns at which the keyframes told the size right: a
# solution is smoother than the motion, whose size is one.
USUAL_SIZE = 0.15
LARGEST_PER_GAP_S = 4.5
LARGEST_OF_ALL = 3.0
# share of the whole body's in a point's squared miss: depths of one body err together
BODY_SHARE = 0.5


def adapted(
    problem: ClipProblem, spans: list[Window], states: list[ClipState]
) -> Generator[None, None, tuple[ClipProblem, list[ClipState]]]:
    """The problem with sizes learned from its states, and the states that follow from it.

    Nothing changes where neither markers nor keypoints show the whole body.
    """
    data = problem.data
    segments = tuple(one.segment for one in problem.evidence.model.placements)
    if not (all_located(data.body, segments) or points_locate(data.keypoints)) or not spans:
        return problem, states
    size = limb_sizes(problem, spans, states)
    problem = replace(problem, limb_size=size, depth_factor=_depth_factor(problem, spans, states))
    solved = []
    for window, state in zip(spans, states, strict=True):
        scaled = replace(state, factor=problem.accelerations, variation=state.variation / size)
        part = WindowProblem(problem, window, scaled)
        for _ in part.converge(2):
            yield
        solved.append(part.state.without_cache())
    return problem, solved


def limb_sizes(problem: ClipProblem, spans: list[Window], states: list[ClipState]) -> Array:
    """(D,) factor on the usual accelerations of each degree of freedom's limb."""
    kept = [state.variation[window.kept] for window, state in zip(spans, states, strict=True)]
    variation, pace, keyframes = np.concatenate(kept), problem.data.pace, problem.data.belief.frame
    size = np.ones(variation.shape[1])
    if len(variation) < 3 or len(keyframes) < 2:
        return size
    squared = (np.diff(variation, n=2, axis=0) ** 2).mean(axis=0) / pace**3
    gap_s = float(np.median(np.diff(keyframes))) * pace * REFERENCE_STEP_S
    # 1.5: Bound of a limb's factor, which is never below 1: 1.5, or more where keyframes lie more than a
    # third of a second apart and show less of the swings between them. A looser motion has more local optima.
    largest = float(np.clip(LARGEST_PER_GAP_S * gap_s, 1.5, LARGEST_OF_ALL))
    for limb in problem.data.body.skeleton.limbs:
        # 0.7: Power of the size: what a solution shows of a limb's motion is partly what was assumed of it.
        found = (np.sqrt(squared[limb].mean()) / USUAL_SIZE) ** 0.7
        size[limb] = np.clip(found, 1.0, largest)
    return size


def _depth_factor(problem: ClipProblem, spans: list[Window], states: list[ClipState]) -> Array:
    """(F, P) factor on the noise of the prior's depths, alike within a gap."""
    body, camera = problem.data.body, problem.data.camera
    squared = np.full(problem.depth_factor.shape, np.nan)
    for window, state in zip(spans, states, strict=True):
        kept, frame = state.posture[window.kept], state.frame[window.kept]
        points = body.points(body.pose(kept))
        missed = points - body.points(body.pose(state.prior[window.kept]))
        sight = camera.sight(points, frame[:, None])
        missed = missed - np.sum(missed * sight, axis=-1, keepdims=True) * sight
        squared[frame] = 0.5 * (missed**2).sum(axis=-1)  # two axes lie across
    gap = np.searchsorted(problem.data.belief.frame, np.arange(problem.frames), side="right")
    solved = np.isfinite(squared).all(axis=1)
    count = np.bincount(gap, solved)
    total = np.stack([np.bincount(gap, np.where(solved, one, 0.0)) for one in squared.T], axis=-1)
    mean = total / np.maximum(count, 1)[:, None]
    mean = (1.0 - BODY_SHARE) * mean + BODY_SHARE * mean.mean(axis=-1, keepdims=True)
    # 8.0: Factor on the depths' deviation: a frame's 13 depths and those of about five frames around err
    # together, but count as rows of their own.
    std = np.clip(8.0 * np.sqrt(mean), 0.1, 3.0)
    return np.where((count > 0)[gap][:, None], (std / DEPTH_STD_M)[gap], problem.depth_factor)


def refine(
    problem: ClipProblem,
    spans: list[Window],
    states: list[ClipState],
    contours: ContourEvidence | None,
) -> Part[tuple[ClipProblem, list[ClipState], ContourEvidence | None]]:
    """Learn from the footage what the keyframes could not tell; `contours` None: to be learned with it."""
    problem, states = yield from scaled(choose_turns(problem, states), 0.0, 0.3)
    problem, states = yield from scaled(adapted(problem, spans, states), 0.3, 0.4)
    album, camera = problem.data.seen.album, problem.evidence.model.camera  # with the lens that was found
    solved = [state.posture[window.kept] for state, window in zip(states, spans, strict=True)]
    posture = spliced(problem.prior, spans, solved)
    if contours is not None:
        contours = replace(contours, model=replace(contours.model, camera=camera))
    elif album is not None:
        data = problem.data
        located = compress(problem.evidence.model.placements, followed_markers(data))
        marked = tuple(one.segment for one in located)
        schedule = contour_schedule(data.body, camera, album.factor, marked, problem.prior, data.keypoints)
        learning = learn_contours(data.body, camera, album, posture, data.belief.frame, schedule)
        contours = yield from scaled(learning, 0.4, 0.5)
    return problem, states, contours


def followed_markers(data: ClipData) -> list[bool]:
    """Which of M markers tell where their limbs are all along: those that are never lost for long."""
    time_s, lost = data.time_s, (data.observed.quality == 0.0) & data.there[:, None]
    return [all(time_s[last - 1] - time_s[first] <= GRACE_S for first, last in runs(own)) for own in lost.T]


# --- Rests of the feet, which keyframes that are not posed do not tear


def as_found(problem: ClipProblem) -> ClipProblem:
    """The problem with every keyframe as doubtful as a found one.

    A keyframe that a person put right lies beside frames whose evidence has a foot a little elsewhere. Feet
    that move from frame to frame are released, so the one frame would jump there and back. Where feet rest
    is therefore asked before the keyframe is believed, and holds afterwards: a correction moves all of it.
    """
    data, belief = problem.data, problem.data.belief
    decided = belief.posed | belief.pictured
    if not decided.any():
        return problem
    information = problem.evidence.information.copy()
    covariance = found_covariance(belief.postures, data.camera, belief.frame)
    information[decided] = np.linalg.inv(covariance[decided])
    evidence = replace(problem.evidence, information=information)
    data = replace(data, belief=replace(belief, pictured=np.zeros_like(decided)))
    return replace(problem, evidence=evidence, data=data)


def rests_of(problem: ClipProblem, spans: list[Window], states: list[ClipState]) -> Array:
    """(F - 1, A) how far each ankle that is seen rests in states of some windows, 0 to 1; 0 elsewhere."""
    terms = [stillness_term(problem, window) for window in spans]
    rests = np.zeros((problem.frames - 1, len(terms[0].points) if terms else 0))
    for window, term, state in zip(spans, terms, states, strict=True):
        if window.last - window.first > 1 and term.points:
            rests[window.first : window.last - 1] = term.resting(state)
    return rests
