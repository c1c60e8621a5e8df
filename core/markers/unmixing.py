"""Unmixing: the share of a surface in pixels that it covers only in part or only for a part of the exposure.

A limb that moves while the shutter is open leaves a pale trace, and one behind another a thin rim: colors
between the surface's and whatever else is there, which no classifier takes for the surface's. Each pixel is
explained twice, as a mixture that contains the surface and as the best one of all that do not; only where the
first is the likelier by more than noise can make it, the surface was there.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import cv2
import numpy as np

from ..arrays import Array, BoolArray, Image, IndexArray, SingleArray
from .color_model import BLUE_SCALE, LUMA_BGR, RED_SCALE
from .moments import MOMENT_POWERS, PIXEL_VARIANCE

CONTRAST = np.array(
    [
        (1.0 / 3.0) * LUMA_BGR,
        BLUE_SCALE * (np.array([1.0, 0.0, 0.0]) - LUMA_BGR),
        RED_SCALE * (np.array([0.0, 0.0, 1.0]) - LUMA_BGR),
    ]
)
"""Turns blue, green, red into luma and chroma of like noise."""
DARKEST, BRIGHTEST = 0.5, 1.15  # light on the background, relative to usual: shadows are no surface
ODD = 6.0  # squared distance from a color, in deviations, of what may be something else as well
SMALLEST_DEVIATION = 3.0  # of a color, in levels: compression and the smoothing of what lies beside it
MOST_GAIN = 12.0  # largest gain of a pixel: models of color are wrong once in so many (e^12)
LEAST_GAIN = 2.0


class Surface(NamedTuple):
    """A surface's color."""

    color: Array  # (3,) as `contrast` gives it
    deviation: float  # its standard deviation in each component


class Unmixed(NamedTuple):
    """What is known of the pixels of a window."""

    share: Array  # (rows, columns) share of the surface, 0 to 1
    gain: Array
    """(rows, columns) log likelihood with the surface less that without it, within ±MOST_GAIN;
    zero where the pixel is clearly something else."""


class Traces(NamedTuple):
    """R connected regions in which a surface shows."""

    moments: Array  # (R, 6) raw moments of its share, the smoothing taken out
    gain: Array  # (R,) sum of the gains, by as many independent pixels
    peak: Array  # (R,) largest share
    certainty: Array  # (R,) mean gain where it shows, relative to the largest

    def scaled(self, factor: int) -> "Traces":
        """The same in pixels that are `factor` times as small."""
        return self._replace(moments=self.moments * float(factor) ** MOMENT_POWERS)


def contrast(pixels: Image | Array) -> Array:
    """Luma and chroma (..., 3) of blue, green, red (..., 3), in which all noise is about alike."""
    return np.asarray(np.asarray(pixels, dtype=np.float64) @ CONTRAST.T)


def surface_of(pixels: Image) -> Surface:
    """The surface that all of N pixels (N, 3) show: their median and its robust deviation."""
    colors = contrast(pixels)
    middle = np.median(colors, axis=0)
    spread = 1.48 * np.median(np.abs(colors - middle), axis=0)
    return Surface(middle, max(float(np.sqrt(np.mean(spread**2))), SMALLEST_DEVIATION))


@dataclass(frozen=True, eq=False)
class Palette:
    """A surface that is looked for, and K others that may lie where it does not."""

    surface: Surface
    rest: tuple[Surface, ...]

    @cached_property
    def _colors(self) -> Array:
        return np.array([other.color for other in self.rest]).reshape(-1, 3)

    @cached_property
    def _deviations(self) -> Array:
        return np.array([other.deviation for other in self.rest])

    def unmix(self, picture: Image, background: SingleArray, deviation: SingleArray) -> Unmixed:
        """The share of the surface in the pixels of a window (rows, columns, 3).

        It may lie before the background, and before another surface where that one is seen beside it.
        Background colors are NaN where unknown, which tells nothing.
        """
        differs = np.abs(picture - background) > 5.0  # levels: a fast bound
        odd = differs[..., 0] | differs[..., 1] | differs[..., 2]
        seen, usual = contrast(picture[odd]), contrast(background[odd])
        spread = np.maximum(deviation[odd].astype(np.float64), SMALLEST_DEVIATION)
        _, empty = mixed(seen, DARKEST * usual, spread, BRIGHTEST * usual, spread)
        lit = (BRIGHTEST - DARKEST) ** 2 * _dot(usual, usual)
        unlit = empty > 4.0 * np.log(spread) + np.log(np.maximum(lit, spread**2)) + ODD
        odd[odd] = unlit
        seen, usual, spread, without = seen[unlit], usual[unlit], spread[unlit], empty[unlit]
        colors = self._colors
        # (N, K) squared distances from the other surfaces' colors.
        away = _dot(seen, seen)[:, None] - 2.0 * seen @ colors.T + _dot(colors, colors)
        variance = self._deviations**2
        pure = (away / variance + 3.0 * np.log(variance)).min(axis=1, initial=np.inf)
        without = np.minimum(without, pure)
        # Most pixels of the performer are one surface's alone.
        mixture = np.flatnonzero((away / variance).min(axis=1, initial=np.inf) > ODD)
        where = np.flatnonzero(odd)[mixture]
        seen, without = seen[mixture], without[mixture]
        behind, noise = usual[mixture], spread[mixture]
        own, cost = mixed(seen, behind, noise, self.surface.color, self.surface.deviation)
        if self.rest:
            over, cost_over = self._before_others(seen, self._beside(away, odd, where))
            own, cost = np.where(cost_over < cost, over, own), np.minimum(cost_over, cost)
        left = np.flatnonzero((own > 0.05) & (without - cost > -2.0 * LEAST_GAIN))
        without = np.minimum(without[left], self._without(seen[left], behind[left], noise[left]))
        share, gain = np.zeros(odd.shape), np.zeros(odd.shape)
        share.ravel()[where[left]] = own[left]
        gain.ravel()[where[left]] = np.clip(0.5 * (without - cost[left]), -MOST_GAIN, MOST_GAIN)
        return Unmixed(share, gain)

    def _beside(self, away: Array, odd: BoolArray, where: IndexArray) -> BoolArray:
        """(N, K) whether other surfaces are seen beside pixels `where` (N,) of a window."""
        near = away < (3.0 * self._deviations) ** 2
        beside = np.zeros((len(where), len(self.rest)), dtype=np.bool_)
        mask = np.zeros(odd.shape, dtype=np.uint8)
        for other in np.flatnonzero(near.any(axis=0)).tolist():
            mask[odd] = near[:, other]
            # Blurred edges and halved chroma.
            beside[:, other] = cv2.dilate(mask, np.ones((7, 7), dtype=np.uint8)).ravel()[where]
        return beside

    def _before_others(self, seen: Array, beside: BoolArray) -> tuple[Array, Array]:
        """Share and cost (N,) of the surface before the likeliest other one that is seen beside a pixel."""
        ends = np.broadcast_to(self.surface.color, self._colors.shape)
        deviation = np.full(len(ends), self.surface.deviation)
        share, cost = _lines(seen, self._colors, self._deviations, ends, deviation)
        cost = np.where(beside, cost, np.inf)
        best = cost.argmin(axis=1)[:, None]
        return np.take_along_axis(share, best, 1)[:, 0], np.take_along_axis(cost, best, 1)[:, 0]

    def _without(self, seen: Array, behind: Array, noise: Array) -> Array:
        """Cost (N,) of the likeliest mixture of other surfaces and the background."""
        colors, deviations = self._colors, self._deviations
        if not len(colors) or not len(seen):
            return np.full(len(seen), np.inf)
        first, second = np.tril_indices(len(colors))
        _, among = _lines(seen, colors[first], deviations[first], colors[second], deviations[second])
        _, before = mixed(seen[:, None], behind[:, None], noise[:, None], colors, deviations)
        return np.minimum(among.min(axis=1), before.min(axis=1))


Deviation = Array | float


def mixed(
    pixels: Array, first: Array, first_deviation: Deviation, second: Array, second_deviation: Deviation
) -> tuple[Array, Array]:
    """Share of the second color in pixels (..., 3), and -2 log density of all mixtures, (...).

    All shares are equally likely beforehand: a color lies within its noise of the line between both.
    """
    axis = second - first
    offset = pixels - first
    squared, along, length = _dot(axis, axis), _dot(offset, axis), _dot(offset, offset)
    return _weighed(squared, along, length, first_deviation, second_deviation)


def _weighed(
    squared: Array, along: Array, length: Array, first_deviation: Deviation, second_deviation: Deviation
) -> tuple[Array, Array]:
    """Share and cost by the products of a line's axis and a pixel's offset from its first end."""
    share = np.clip(along / np.maximum(squared, 1e-6), 0.0, 1.0)
    away = length - share * (2.0 * along - share * squared)
    variance = ((1.0 - share) * first_deviation) ** 2 + (share * second_deviation) ** 2
    variance = np.maximum(variance, SMALLEST_DEVIATION**2)
    density = 2.0 * np.log(variance) + np.log(np.maximum(squared, variance))
    return share, away / variance + density


def _lines(
    pixels: Array, first: Array, first_deviation: Array, second: Array, second_deviation: Array
) -> tuple[Array, Array]:
    """`mixed` of N pixels (N, 3) between S pairs of colors (S, 3), (N, S)."""
    axis = second - first
    squared = _dot(axis, axis)
    along = pixels @ axis.T - _dot(first, axis)
    length = _dot(pixels, pixels)[:, None] - 2.0 * pixels @ first.T + _dot(first, first)
    return _weighed(squared, along, length, first_deviation, second_deviation)


def _dot(one: Array, other: Array) -> Array:
    # Written out: sums over an axis of three are slow.
    return np.asarray(one[..., 0] * other[..., 0] + one[..., 1] * other[..., 1] + one[..., 2] * other[..., 2])


def traces(seen: Unmixed, origin: tuple[int, int]) -> Traces:
    """Connected regions in which a surface shows, of a window with its left and top at `origin`."""
    core = (seen.gain > LEAST_GAIN).astype(np.uint8)
    rim = cv2.dilate(core, np.ones((9, 9), dtype=np.uint8)) > 0  # a color that fits no worse is the blur here
    shown = (seen.gain > -LEAST_GAIN) & (seen.share > 0.0) & rim
    count, number = cv2.connectedComponents(shown.astype(np.uint8), connectivity=8)
    row, column = np.nonzero(shown)
    owner = number[row, column].astype(np.intp) - 1
    weight, gain = seen.share[row, column], seen.gain[row, column]
    x, y = column + origin[0] + 0.5, row + origin[1] + 0.5
    terms = (weight, weight * x, weight * y, weight * x * x, weight * x * y, weight * y * y, gain)
    sums = np.array([np.bincount(owner, term, minlength=count - 1) for term in terms], dtype=np.float64)
    moments = sums[:6].T.copy()
    moments[:, [3, 5]] += (PIXEL_VARIANCE - 0.5) * moments[:, :1]  # a binomial one over three pixels [px²]
    peak = np.zeros(count - 1)
    np.maximum.at(peak, owner, weight)
    sure = np.bincount(owner, weight * np.maximum(gain, 0.0), minlength=count - 1)
    # Pixels of halved chroma, smoothed, err together.
    return Traces(moments, sums[6] / 9.0, peak, sure / (MOST_GAIN * sums[0]))
