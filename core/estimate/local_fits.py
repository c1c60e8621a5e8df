"""Local alternatives: a stretch of the clip solved from another start, and held against the estimate by cost.

Gauss-Newton ends in the optimum next to its start. Where interpolation is a guess there may be a better one.
"""

from collections.abc import Generator
from dataclasses import dataclass

from .clip_problem import ClipProblem
from .clip_state import ClipState
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
class Alternative:
    """Another solution of a stretch of the clip, whose frames the state names."""

    problem: ClipProblem
    state: ClipState
    gain: float
    """How much less it costs than the estimate, in negative log probability."""


def alternative(
    problem: ClipProblem, state: ClipState, other: ClipProblem
) -> Generator[None, None, Alternative | None]:
    """Solve a stretch of consecutive frames once more from where it is, and about another prior.

    It yields now and then, so that a job can be canceled.

    Args:
        problem: The clip's problem.
        state: Its solution in the stretch, cut from that of a window.
        other: The problem about the other prior.

    Returns:
        None where the other prior is hopeless.
    """
    first, last = int(state.frame[0]), int(state.frame[-1]) + 1
    window = Window(first, last, first, last)
    here = WindowProblem(problem, window, state)
    there = WindowProblem(other, window, other.start(window))
    known = yield from here.descend(())
    begun = yield from there.descend(BEGUN)
    if begun.sum() > (1.0 + HOPELESS_SHARE) * known.sum() + HOPELESS_COST:
        return None
    settled = yield from here.descend(SETTLED)
    ended = yield from there.descend(GONE_ON)
    return Alternative(other, there.state.without_cache(), float(settled.sum() - ended.sum()))


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
