"""Which way round the body turns between two keyframes: the short way, as interpolated, or another.

Whoever spins may turn by more than half a turn between two keyframes, which interpolation cannot know. Where
that is possible in the time and there is a reason to doubt, the stretch is solved with a turn the other way
as well, and the footage decides by the whole cost of both.
"""

from collections.abc import Generator
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..prior.turns import FULL_TURN, heading_steps_rad
from .clip_problem import ClipProblem
from .clip_state import ClipState
from .local_fits import Contest, blended, contest, cut, inside
from .window_problem import image_cost
from .windows import Window

LARGE_STEP_RAD = np.radians(60.0)
"""A turn between keyframes from which on the other way round is tried."""
FASTEST_RAD_PER_S = 3.0 * FULL_TURN
"""Nobody turns faster between two keyframes: dancers and skaters on the floor make two to three turns a
second."""
LONG_S = 0.3
"""Gaps of this time and longer ..."""
DOUBTED = 2.0
"""... in which what is seen costs so many times as much as usual are tried both ways round."""
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


def doubted_turns(problem: ClipProblem, misfit: Array, among: BoolArray) -> list[DoubtedTurn]:
    """Gaps to be tried another way round, the most doubtful first.

    Args:
        problem: The clip's problem.
        misfit: (F,) what the image costs in each frame, followed the short way round.
        among: (K - 1,) the gaps that are asked for.
    """
    keyframes = problem.keyframes
    step = heading_steps_rad(problem.interpolated[keyframes])
    usual = max(float(np.median(misfit)), 1e-9)
    found = []
    for gap in np.flatnonzero(among).tolist():
        first, last = int(keyframes[gap]), int(keyframes[gap + 1])
        if last - first < 2:
            continue
        time_s = float(problem.step_s[first:last].sum())
        misfits = float(misfit[first + 1 : last].mean()) / usual
        doubted = time_s >= LONG_S and misfits > DOUBTED
        if abs(step[gap]) < LARGE_STEP_RAD and not doubted:
            continue
        other = -1 if step[gap] > 0.0 else 1
        ways = (other, -other) if doubted else (other,)
        possible = [way for way in ways if abs(step[gap] + FULL_TURN * way) <= FASTEST_RAD_PER_S * time_s]
        if possible:
            found.append(DoubtedTurn(gap, tuple(possible), misfits + abs(step[gap]) / np.pi))
    return sorted(found, key=lambda doubt: (-doubt.strength, doubt.gap))
LOG=[]

def choose_turns(
    problem: ClipProblem, states: list[ClipState], among: BoolArray
) -> Generator[None, None, tuple[ClipProblem, list[ClipState]]]:
    """Turn the other way round where that costs less.

    Args:
        problem: The clip's problem.
        states: Windows of it, solved; they may overlap.
        among: (K - 1,) the gaps that are asked for.

    Returns:
        The problem with the turns that were chosen, and the windows' states about its prior.
    """
    margin = round(MARGIN_S / float(np.median(problem.step_s))) if len(problem.step_s) else 0
    for doubt in doubted_turns(problem, image_cost(problem, states), among):
        first, last = (int(frame) for frame in problem.keyframes[doubt.gap : doubt.gap + 2])
        state = cut(states, first, last + 1, margin)
        if state is None:
            continue
        best: Contest | None = None
        for way in doubt.turns:
            turns = problem.turns.copy()
            turns[doubt.gap] += way
            other = problem.with_turns(turns)
            start = other.start(Window(int(state.frame[0]), int(state.frame[-1]) + 1, first, last))
            tried = yield from contest(problem, state, other, start)
            LOG.append(((first,last), doubt, way, tried, problem, other))
            if tried is not None and (best is None or tried.gain > best.gain):
                best = tried
        if best is not None and best.gain > CHEAPER:
            problem = best.other.problem
            share = inside(best.other.state.frame, first, last)
            states = [blended(one, best.other, share) for one in states]
    return problem, states
