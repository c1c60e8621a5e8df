"""Local alternatives: a stretch of the clip solved from another start, and held against the estimate by cost.

Gauss-Newton ends in the optimum next to its start. Where interpolation is a guess there may be a better one.
"""

from collections.abc import Generator
from dataclasses import dataclass

import numpy as np

from ..arrays import Array, IndexArray
from .clip_problem import ClipProblem
from .clip_state import ClipState
from .unseen_markers import unseen_cost
from .window_problem import WindowProblem
from .windows import Window

BEGUN = (8.0, 4.0, 2.0, 1.0, 1.0)
"""Factors of the image's variance in an alternative's first steps: enough to tell a hopeless one."""
HOPELESS_SHARE, HOPELESS_COST = 0.3, 50.0
"""An alternative that costs more than the estimate by more than this share of it and this much besides is
given up by then. The other steps save a third of an alternative's cost at most, and mostly a tenth."""
GONE_ON = tuple(1.0 for _ in range(10))
"""An alternative's other steps, which are needed where it departs as far from the prior as in long gaps."""
SETTLED = tuple(1.0 for _ in range(4))
"""Steps of the estimate in the meantime, whose window was solved already."""


@dataclass(frozen=True, eq=False)
class LocalFit:
    """One solution of a stretch of the clip, whose frames the state names."""

    problem: ClipProblem
    state: ClipState
    cost: float
    """Negative logarithm of its probability, up to a constant."""


@dataclass(frozen=True, eq=False)
class Contest:
    """The estimate of a stretch and an alternative to it, both solved to the end."""

    estimate: LocalFit
    other: LocalFit

    @property
    def gain(self) -> float:
        """How much less the alternative costs."""
        return self.estimate.cost - self.other.cost


def contest(
    problem: ClipProblem, state: ClipState, other: ClipProblem, start: ClipState, findable: Array
) -> Generator[None, None, Contest | None]:
    """Solve a stretch of consecutive frames once more from where it is, and from another start.

    It yields now and then, so that a job can be canceled.

    Args:
        problem: The clip's problem.
        state: Its solution in the stretch, cut from that of a window.
        other: The problem about another prior, or the same.
        start: Where the alternative begins, a state of the same frames about the other problem's prior.
        findable: (F, M) what `findable_share` says of the clip.

    Returns:
        Both solutions; None where the alternative is hopeless.
    """
    known = yield from _fit(problem, state, (), findable)
    begun = yield from _fit(other, start, BEGUN, findable)
    if begun.cost > (1.0 + HOPELESS_SHARE) * known.cost + HOPELESS_COST:
        return None
    settled = yield from _fit(problem, state, SETTLED, findable)
    ended = yield from _fit(other, begun.state, GONE_ON, findable)
    return Contest(settled, ended)


def _fit(
    problem: ClipProblem, start: ClipState, temperatures: tuple[float, ...], findable: Array
) -> Generator[None, None, LocalFit]:
    first, last = int(start.frame[0]), int(start.frame[-1]) + 1
    part = WindowProblem(problem, Window(first, last, first, last), start)
    cost = yield from part.descend(temperatures)
    cost = cost + unseen_cost(problem, part.state, findable)
    return LocalFit(problem, part.state.without_cache(), float(cost.sum()))


def cut(states: list[ClipState], first: int, last: int, margin: int) -> ClipState | None:
    """The state of the frames `first` to `last - 1` and a margin around them; None where no window has all.

    Args:
        states: Of windows, in order, which may overlap.
        first: A frame of the clip.
        last: One past another.
        margin: Frames more on either side, where the window has them.
    """
    for state in states:
        begin, end = int(state.frame[0]), int(state.frame[-1]) + 1
        if begin <= first and last <= end:
            return state.of_frames(slice(max(first - margin - begin, 0), min(last + margin, end) - begin))
    return None


def blended(state: ClipState, fit: LocalFit, share: Array) -> ClipState:
    """A window's state with a local solution blended in, about the local one's prior.

    Args:
        state: The window's, perhaps about another prior.
        fit: The solution of some frames, of which the window has any or none.
        share: (F,) of the local solution in each of its frames, 0 to 1.
    """
    prior = fit.problem.prior[slice(int(state.frame[0]), int(state.frame[-1]) + 1)]
    _, mine, its = np.intersect1d(state.frame, fit.state.frame, assume_unique=True, return_indices=True)
    step, bias = np.zeros_like(state.variation), state.bias.copy()
    weight = share[its, None]
    step[mine] = weight * fit.state.posture[its].minus(state.posture[mine])
    bias[mine] += weight * (fit.state.bias[its] - state.bias[mine])
    return state.about(prior, state.posture.plus(step), bias).without_cache()


def inside(frame: IndexArray, first: int, last: int) -> Array:
    """(F,) share of a local solution in its frames: all from `first` to `last`, less in its margins.

    Args:
        frame: (F,) the frames, consecutive.
        first: A frame in them.
        last: A later one.
    """
    before = (frame - frame[0] + 1.0) / (first - frame[0] + 1.0)
    after = (frame[-1] - frame + 1.0) / (frame[-1] - last + 1.0)
    left = np.clip(np.minimum(before, after), 0.0, 1.0)
    return np.asarray(left**2 * (3.0 - 2.0 * left))
