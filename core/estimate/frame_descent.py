"""Gauss-Newton from several starts of one frame, side by side, each as if it were a frame of its own."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..arrays import Array
from .clip_state import ClipState
from .terms.term import NormalEquations, Term, total_cost

TEMPERATURES = (64.0, 32.0, 16.0, 8.0, 4.0, 2.0, *(1.0 for _ in range(10)))
"""From a start that may be far off; image noise is widened by these factors."""
LARGEST_STEP = 0.4
"""Largest change of a posture's unknown in one step [m, rad]."""
CONVERGED = 2e-3


def descend(
    state: ClipState, terms: Sequence[Term], temperatures: Sequence[float] = TEMPERATURES
) -> tuple[ClipState, Array]:
    """Descend from every start of a state.

    Args:
        state: The starts; where each descent's prior lies elsewhere is a candidate, too.
        terms: The frame's terms, for as many states of it.
        temperatures: Factors of the image noise, one a step.

    Returns:
        The best state of each descent, never less probable than its prior's mean, and their costs (S,).
    """
    best = replace(state, variation=np.zeros_like(state.variation))
    least = total_cost(terms, best)
    for temperature in temperatures:
        equations = NormalEquations(state.frames, state.unknowns.shape[1])
        for term in terms:
            term.add_to(equations, state, temperature)
        step = equations.matrix.factorize().solve(-equations.gradient)
        state, moved = state.stepped(step, LARGEST_STEP)
        if temperature > 1.0:
            continue
        costs = total_cost(terms, state)
        better = costs < least
        best = replace(
            best,
            variation=np.where(better[:, None], state.variation, best.variation),
            bias=np.where(better[:, None], state.bias, best.bias),
        )
        least = np.minimum(costs, least)
        if moved < CONVERGED:
            break
    return best, least
