"""Gauss-Newton on the sum of some terms, which is the iterated Kalman smoother over time (Bell 1994)."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from ..arrays import Array
from .term import ClipState, NormalEquations, Term, total_cost


def assembling(
    equations: NormalEquations,
    terms: Sequence[Term],
    state: ClipState,
    temperature: float,
    doubt: Sequence[float] | None = None,
) -> Iterator[None]:
    """Add the normal equations of terms at a state, one after the other.

    `temperature` is a factor of the image's variance, `doubt` one of each term's own.
    """
    _ = state.pose, state.tangent_jacobian  # cached for all terms
    for index, term in enumerate(terms):
        yield
        term.add_to(equations, state, temperature * (doubt[index] if doubt else 1.0))
    yield


def gauss_newton(
    terms: Sequence[Term],
    state: ClipState,
    temperatures: Sequence[float],
    largest: float = 0.5,
    settled: float = 3e-3,
) -> Iterator[tuple[float, ClipState, bool]]:
    """Steps of at most `largest` [m, rad], till the temperatures end, or at 1 none is over `settled`.

    Yields temperature, state and whether this is a new one: several times on the way to it.
    """
    for temperature in temperatures:
        equations = NormalEquations(state.frames, state.unknowns.shape[1])
        for _ in assembling(equations, terms, state, temperature):
            yield temperature, state, False
        step = equations.matrix.factorize().solve(-equations.gradient)
        state, moved = state.stepped(step, largest)
        yield temperature, state, True
        if temperature == 1.0 and moved < settled:
            break


TEMPERATURES = (64.0, 32.0, 16.0, 8.0, 4.0, 2.0, *(1.0 for _ in range(10)))  # of image noise, from far off


def descend(
    state: ClipState, terms: Sequence[Term], temperatures: Sequence[float] = TEMPERATURES
) -> tuple[ClipState, Array]:
    """Descend from every start of a state.

    `terms` are the frame's, for as many states of it; where a start's prior lies elsewhere it is a candidate,
    too. The best state of each descent, never less probable than its prior's mean, and their costs (S,).
    """
    best = replace(state, variation=np.zeros_like(state.variation))
    least = total_cost(terms, best)
    for temperature, found, is_new in gauss_newton(terms, state, temperatures, 0.4, 2e-3):
        if temperature > 1.0 or not is_new:
            continue
        costs = total_cost(terms, found)
        better = costs < least
        best = replace(
            best,
            variation=np.where(better[:, None], found.variation, best.variation),
            bias=np.where(better[:, None], found.bias, best.bias),
        )
        least = np.minimum(costs, least)
    return best, least
