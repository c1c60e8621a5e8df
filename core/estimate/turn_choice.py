"""Which way round the body turns between two keyframes: the short way, as interpolated, or another.

Whoever spins may turn by more than half a turn between two keyframes, which interpolation cannot know. Where
that is possible in the time and there is a reason to doubt, the stretch is solved with a turn the other way
as well, and the footage decides by the whole cost of both.
"""

from collections.abc import Generator
from dataclasses import dataclass

import numpy as np

from ..arrays import Array, BoolArray
from ..prior.turns import FULL_TURN, heading_steps_rad
from ..progress import Part, scaled
from .clip_problem import ClipProblem
from .clip_state import ClipState
from .local_fits import Alternative, alternative, cut
from .window_problem import WindowProblem, image_cost
from .windows import Window

LARGE_STEP_RAD = np.radians(60.0)
"""A turn between keyframes from which on the other way round is tried."""
FASTEST_RAD_PER_S = 3.0 * FULL_TURN
"""Nobody turns faster between two keyframes: dancers make two to three turns a second."""
LONG_S = 0.3
"""Gaps of this time and longer ..."""
DOUBTED_COST = 0.5
"""... in which each marker seen costs more than this are tried both ways round. With noise as assumed it
would cost 2; the slow biases take most of that, so that it is 0.1 to 0.2 where all is well."""
MARGIN_S = 0.2
"""How far beyond its keyframes, which hold it, a stretch is solved."""
CHEAPER = 3.0
"""Another turn is taken where it costs less by so much: it is twenty times as probable."""


@dataclass(frozen=True)
class DoubtedTurn:
    """A gap between keyframes in which the body may turn another way."""

    gap: int
    turns: tuple[int, ...]
    """Whole turns that may have to be added to the short way round."""
    strength: float
    """By which the most doubtful gap comes first."""


def doubted_turns(problem: ClipProblem, cost: Array, among: BoolArray) -> list[DoubtedTurn]:
    """Gaps to be tried another way round, the most doubtful first.

    Args:
        problem: The clip's problem.
        cost: (F,) what each marker seen costs on average in each frame, the short way round.
        among: (K - 1,) the gaps that are asked for.
    """
    keyframes = problem.keyframes
    step = heading_steps_rad(problem.interpolated[keyframes])
    found = []
    for gap in np.flatnonzero(among).tolist():
        first, last = int(keyframes[gap]), int(keyframes[gap + 1])
        if last - first < 2:
            continue
        time_s = float(problem.step_s[first:last].sum())
        misfit = float(cost[first + 1 : last].mean())
        doubted = time_s >= LONG_S and misfit > DOUBTED_COST
        if abs(step[gap]) < LARGE_STEP_RAD and not doubted:
            continue
        ways = (-1, 1) if doubted else (-1 if step[gap] > 0.0 else 1,)
        possible = [way for way in ways if abs(step[gap] + FULL_TURN * way) <= FASTEST_RAD_PER_S * time_s]
        if possible:
            found.append(DoubtedTurn(gap, tuple(possible), misfit + abs(float(step[gap])) / np.pi))
    return sorted(found, key=lambda doubt: (-doubt.strength, doubt.gap))


def choose_turns(
    problem: ClipProblem, states: list[ClipState], among: BoolArray
) -> Part[tuple[ClipProblem, list[ClipState]]]:
    """Turn the other way round where that costs less.

    Args:
        problem: The clip's problem, which turns the short way in these gaps.
        states: Windows of it, solved; they may overlap.
        among: (K - 1,) the gaps that are asked for.

    Yields:
        The fraction done, from 0 to 1.

    Returns:
        The problem with the turns chosen, and its windows, solved.
    """
    states = list(states)
    margin = round(MARGIN_S / float(np.median(problem.step_s))) if len(problem.step_s) else 0
    seen = bool(problem.observed.quality.any() or problem.points.seen.any())  # contours alone decide nothing
    doubts = doubted_turns(problem, image_cost(problem, states), among) if seen else []
    for number, doubt in enumerate(doubts):
        first, last = (int(frame) for frame in problem.keyframes[doubt.gap : doubt.gap + 2])
        state = cut(states, first, last + 1, margin)
        if state is None:
            continue
        trying = _best(problem, state, doubt)
        best = yield from scaled(trying, number / len(doubts), (number + 1) / len(doubts))
        if best is not None and best.gain > CHEAPER:
            before, problem = problem, best.problem
            turned = (problem.prior.rotations != before.prior.rotations).any(axis=(1, 2, 3))
            for index, one in enumerate(states):
                if turned[one.frame].any():
                    # From the prior, as an estimate that keeps these turns begins (`warm_start`).
                    whole = Window(int(one.frame[0]), int(one.frame[-1]) + 1, 0, 0)
                    part = WindowProblem(problem, whole, problem.start(whole))
                    yield from scaled(part.follow_markers(), 1.0, 1.0)
                    states[index] = part.state.without_cache()
    return problem, states


def _best(
    problem: ClipProblem, state: ClipState, doubt: DoubtedTurn
) -> Generator[None, None, Alternative | None]:
    """The turn that wins most clearly, or loses least; None where all are hopeless."""
    best: Alternative | None = None
    for way in doubt.turns:
        turns = problem.turns.copy()
        turns[doubt.gap] = way
        tried = yield from alternative(problem, state, problem.with_turns(turns))
        if tried is not None and (best is None or tried.gain > best.gain):
            best = tried
    return best
