"""Which way round the body turns between two keyframes: alternatives, held against it by cost.

Gauss-Newton ends in the optimum next to its start. Where interpolation is a guess there may be a better one.
"""

from collections.abc import Generator
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..prior.frame_prior import REFERENCE_STEP_S
from ..prior.keyframes import FULL_TURN, heading_steps_rad
from ..progress import Part, scaled
from ..terms.state import ClipState
from .clip_problem import ClipProblem
from .window_problem import WindowProblem, image_cost
from .windows import Window

BEGUN = (8.0, 4.0, 2.0, 1.0, 1.0)  # image variance in an alternative's first steps, which tell a hopeless one


# a turn between keyframes from which on the other way round is tried
LARGE_STEP_RAD = np.radians(60.0)
# Nobody turns faster between two keyframes: dancers make two to three turns a second.
FASTEST_RAD_PER_S = 3.0 * FULL_TURN
GONE_ON = (
    1.0,
) * 10  # its other steps, which are needed where it departs far from the prior, as in long gaps
SETTLED = (1.0,) * 4  # those of the estimate in the meantime, whose window was solved already


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
    settled = yield from here.descend(SETTLED)
    ended = yield from there.descend(GONE_ON)
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
    """Turn the other way round where that costs less.

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
