"""Curves of time for composing motions: keys, cycles, springs, flight, and irregularities.

Times are seconds unless a docstring says frames; angles are whatever unit the values have.
"""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline, PchipInterpolator
from scipy.signal import bilinear, lfilter, lfilter_zi

Array = NDArray[np.float64]
Keys = Mapping[float, float]

GRAVITY_MPS2 = 9.81


def keyed(keys: Keys, times: Array) -> Array:
    """A curve through keys without overshoot, constant beyond the outermost ones."""
    curve = PchipInterpolator(list(keys), list(keys.values()), extrapolate=False)
    return np.asarray(curve(np.clip(times, min(keys), max(keys))))


def sprung(targets: Array, times: Array, hertz: float, damping: float) -> Array:
    """Response of a mass on a spring to its target: late, then past it, then settling.

    Args:
        targets: (T,) targets of the spring.
        times: (T,) evenly spaced.
        hertz: The spring's natural frequency; a limb's is 2 to 6.
        damping: Share of the critical damping; below 1 it overshoots.
    """
    omega = 2.0 * np.pi * hertz
    rate = 1.0 / (times[1] - times[0])
    over, under = bilinear([omega**2], [1.0, 2.0 * damping * omega, omega**2], rate)
    followed, _ = lfilter(over, under, targets, zi=lfilter_zi(over, under) * targets[0])
    return np.asarray(followed)


def driven(keys: Keys, times: Array, hertz: float = 4.5, damping: float = 0.62) -> Array:
    """Keys as targets of muscles: each is reached a little late and overshot a little."""
    return sprung(keyed(keys, times), times, hertz, damping)


def cyclic(phases: Array, keys: Keys) -> Array:
    """A smooth periodic curve through keys at phases within [0, 1), read at any `phases` [cycles]."""
    places = [*keys, min(keys) + 1.0]
    values = [*keys.values(), next(iter(keys.values()))]
    return np.asarray(CubicSpline(places, values, bc_type="periodic")(phases))


def uneven_phases(times: Array, period_s: float, unevenness: float, random: np.random.Generator) -> Array:
    """Cycles (T,) counted from 0 at time 0, each of the period's length within a share of `unevenness`."""
    first, last = np.floor(times[0] / period_s) - 2, np.ceil(times[-1] / period_s) + 2
    count = int(last - first)
    lengths = period_s * np.clip(1.0 + unevenness * random.standard_normal(count), 0.7, 1.3)
    ends = first * period_s + np.concatenate([[0.0], np.cumsum(lengths)])
    return np.asarray(PchipInterpolator(ends, first + np.arange(count + 1.0))(times))


def burst(times: Array, start: float, peak: float, end: float) -> Array:
    """A smooth pulse: 0 until `start`, 1 at `peak`, 0 from `end`."""
    rise = np.clip((times - start) / (peak - start), 0.0, 1.0)
    fall = np.clip((end - times) / (end - peak), 0.0, 1.0)
    share = np.minimum(rise, fall)
    return np.asarray(share**2 * (3.0 - 2.0 * share))


def flight(times: Array, takeoff: float, landing: float) -> Array:
    """Height [m] above that of takeoff while nothing but gravity acts, 0 before and after."""
    risen, left = np.clip(times - takeoff, 0.0, None), np.clip(landing - times, 0.0, None)
    return np.asarray(0.5 * GRAVITY_MPS2 * risen * left * (risen > 0.0) * (left > 0.0))


def shock(times: Array, impacts: list[float], hertz: float = 7.0, decay_s: float = 0.07) -> Array:
    """The ringing of a body after each impact: a unit damped wave."""
    after = times[:, None] - np.array(impacts)[None, :]
    rings = np.sin(2.0 * np.pi * hertz * after) * np.exp(-np.clip(after, 0.0, None) / decay_s)
    return np.asarray(np.where(after > 0.0, rings, 0.0).sum(axis=1))


def sway(frames: Array, random: np.random.Generator, periods: tuple[float, float] = (19.0, 61.0)) -> Array:
    """Irregular motion of unit size: three waves of unrelated periods [frames]."""
    lengths = random.uniform(*periods, 3)
    starts = random.uniform(0.0, 2.0 * np.pi, 3)
    return np.asarray(np.sin(2.0 * np.pi * frames[:, None] / lengths + starts).sum(axis=1) / np.sqrt(3.0))
