"""Student's t, under which errors far off count for less, and Levenberg-Marquardt for batches of problems.

Lange, Little & Taylor (1989), *Robust statistical modeling using the t distribution*, JASA 84.
"""

from collections.abc import Callable
from typing import TypeVar

import numpy as np

from ..arrays import Array, BoolArray, IndexArray, SingleArray

DEGREES = 4.0  # of Student's t for all that is seen (Lange, Little & Taylor 1989); few forgive more

Floats = TypeVar("Floats", Array, SingleArray)


def student_weight(squared: Array, degrees: float, count: IndexArray | int) -> Array:
    """Weight of groups of rows whose t gets `degrees` for each row; 1 at zero.

    `squared` sums `count` whitened residuals of a group; fewer `degrees` forgive more.
    """
    return np.asarray(degrees / (degrees + squared / np.maximum(count, 1)))


def student_cost(squared: Array, degrees: float, count: int) -> Array:
    """Negative logarithm that `student_weight` belongs to, up to a constant."""
    size = degrees * count
    return np.asarray(0.5 * size * np.log1p(squared / size))


def multivariate_cost(squared: Floats, degrees: float, dimensions: float) -> Floats:
    """Negative logarithm of a `dimensions`-variate t of squared distances, up to a constant."""
    off = squared / degrees
    off += 1.0
    # NumPy's log1p takes seven times as long in single precision, and differs by 1e-6.
    return 0.5 * (degrees + dimensions) * np.log(off)


State = TypeVar("State")
Equations = tuple[Array, Array, Array]  # cost (N,), normal matrix (N, D, D), gradient (N, D)


def levenberg_marquardt(
    equations: Callable[[State], Equations],
    start: State,
    plus: Callable[[State, Array], State],
    choose: Callable[[BoolArray, State, State], State],
    iterations: int,
    converged: float,
) -> State:
    """Lower the cost of N problems together.

    `plus` changes a state by steps (N, D); `choose` takes of each problem the first state where a mask (N,)
    holds, else the second; a step that gains less than `converged` of the cost ends a problem.
    """
    state = start
    cost, normal, gradient = equations(state)
    damping = np.full(len(cost), 1e-3)
    diagonal = np.arange(gradient.shape[-1])
    for _ in range(iterations):
        damped = normal.copy()
        damped[:, diagonal, diagonal] *= 1.0 + damping[:, None]
        damped[:, diagonal, diagonal] += 1e-9
        trial = plus(state, -np.linalg.solve(damped, gradient[..., None])[..., 0])
        trial_cost, trial_normal, trial_gradient = equations(trial)
        better = trial_cost < cost
        gain = np.where(better, (cost - trial_cost) / np.maximum(cost, 1e-12), 0.0)
        state = choose(better, trial, state)
        cost = np.where(better, trial_cost, cost)
        normal = np.where(better[:, None, None], trial_normal, normal)
        gradient = np.where(better[:, None], trial_gradient, gradient)
        damping = np.clip(np.where(better, damping * 0.2, damping * 8.0), 1e-9, 1e9)
        if np.all(np.where(better, gain < converged, damping > 1e6)):
            break
    return state
