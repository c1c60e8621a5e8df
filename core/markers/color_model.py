"""Color space: chromaticity, which is free of shading, and the cells of color histograms.

A surface in shadow keeps the ratios of its channels, and both gamma-encoded luma and chroma scale with the
light to a good approximation; chroma over luma therefore describes the surface, and luma the light on it. A
small offset keeps dark pixels, whose ratios are noise, near gray.
"""

from collections.abc import Iterable, Sequence
from colorsys import rgb_to_hsv
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array, Image, IndexArray, Int32Array, SingleArray
from ..numerics.vectors import weighted_median
from ..video.working_image import learning_image, smooth

SIDE = 64  # cells a channel: a cell holds a color to two levels, less than compression noise
CELL_COUNT = SIDE**3
LEVELS = np.arange(SIDE) * 4.0 + 1.5
"""The center of each cell of a channel."""
LUMA_OFFSET = 16.0  # levels added before dividing by luma: five times the noise of a dark pixel

# Recommendation ITU-R BT.601, full range, as video decoders' 4:2:0 chroma is split.
LUMA_BGR = np.array([0.114, 0.587, 0.299])
BLUE_SCALE = 0.564
RED_SCALE = 0.713


def chromaticity(bgr: ArrayLike) -> tuple[Array, Array]:
    """Split gamma-encoded colors (..., 3), blue, green, red in 0..255, into chromaticity and luma.

    Returns blue and red difference over offset luma (..., 2), without unit, and offset luma (...) in levels.
    """
    color = np.asarray(bgr, dtype=np.float64)
    # Written out: for so short a product, linear algebra libraries start threads that only wait.
    luma = color[..., 0] * LUMA_BGR[0] + color[..., 1] * LUMA_BGR[1] + color[..., 2] * LUMA_BGR[2]
    offset_luma = luma + LUMA_OFFSET
    differences = np.stack([(color[..., 0] - luma) * BLUE_SCALE, (color[..., 2] - luma) * RED_SCALE], axis=-1)
    return differences / offset_luma[..., None], offset_luma


def cell_volume(offset_luma: ArrayLike) -> Array:
    """The volume of a cell in (chromaticity, log luma), for densities counted by cells."""
    luma = np.asarray(offset_luma)
    # d(blue, red difference, luma) / d(b, g, r) has the determinant 0.564 · 0.713 · 0.587; the division
    # scales it.
    return np.asarray(4**3 * BLUE_SCALE * RED_SCALE * LUMA_BGR[1] / luma**3)


def cell_index(image: Image) -> IndexArray:
    """The cell of every pixel, (rows, columns) in 0..CELL_COUNT-1, of a (rows, columns, 3) image."""
    packed = np.asarray(cv2.cvtColor(image, cv2.COLOR_BGR2BGRA)).view("<u4")[..., 0]
    index = (packed >> 2) & 0x3F | (packed >> 4) & 0xFC0 | (packed >> 6) & 0x3F000
    return index.astype(np.intp)


def cell_colors(cells: Int32Array | None = None) -> Array:
    """Centers of cells, (..., 3) blue, green, red in levels; of all cells by default."""
    index = np.arange(CELL_COUNT) if cells is None else cells
    return LEVELS[np.stack(np.unravel_index(index, (SIDE, SIDE, SIDE), order="F"), axis=-1)]


def cell_chromaticity(cells: Int32Array) -> tuple[SingleArray, SingleArray]:
    """Chromaticity (N, 2) and offset luma (N,) of the centers of cells; single precision is plenty."""
    levels = LEVELS.astype(np.float32)
    blue, green, red = (levels.take(cells >> shift & SIDE - 1) for shift in (0, 6, 12))
    luma = green * np.float32(LUMA_BGR[1])
    luma += blue * np.float32(LUMA_BGR[0]) + red * np.float32(LUMA_BGR[2])
    offset_luma = luma + np.float32(LUMA_OFFSET)
    chroma = np.empty((len(cells), 2), dtype=np.float32)
    chroma[:, 0] = (blue - luma) * np.float32(BLUE_SCALE) / offset_luma
    chroma[:, 1] = (red - luma) * np.float32(RED_SCALE) / offset_luma
    return chroma, offset_luma


ColorArray = Array | SingleArray
NOISE_LEVELS = 5.0  # deviation of a decoded, smoothed color difference: sensor and compression
OUTLIER_DISTANCE = 16.0  # squared distance past which no color is a marker's: 99.9 % of χ²
BACKGROUND = 255  # label of pixels that are no marker's


@dataclass(frozen=True, eq=False)
class ColorDistribution:
    """Color of one surface under changing light: log luma is normal, and so is chromaticity given it.

    Chromaticity may drift with luma (tone mapping takes color from bright pixels), so its mean is a line in
    it.
    """

    log_luma: float  # mean logarithm of offset luma
    log_luma_deviation: float  # its standard deviation
    mean: Array  # (2,) chromaticity at the mean luma
    slope: Array  # (2,) change of chromaticity per unit of log luma
    covariance: Array  # (2, 2) of the chromaticity, without the pixel noise of dark colors

    def distance(
        self, chroma: ColorArray, luma: ColorArray, noise_levels: float = NOISE_LEVELS
    ) -> tuple[Array, Array]:
        """The squared Mahalanobis distance and log density over (chromaticity, log luma), (...) each."""
        light = np.log(luma) - self.log_luma
        noise = (noise_levels / luma) ** 2
        first = float(self.covariance[0, 0]) + noise
        second = float(self.covariance[1, 1]) + noise
        cross = float(self.covariance[0, 1])
        determinant = first * second - cross**2
        x = chroma[..., 0] - float(self.mean[0]) - float(self.slope[0]) * light
        y = chroma[..., 1] - float(self.mean[1]) - float(self.slope[1]) * light
        squared = (second * x * x - 2.0 * cross * x * y + first * y * y) / determinant
        squared += (light / self.log_luma_deviation) ** 2
        normalizer = 3.0 * np.log(2.0 * np.pi) + np.log(determinant) + 2.0 * np.log(self.log_luma_deviation)
        return squared, -0.5 * (squared + normalizer)

    def within_reach(self, chroma: ColorArray, luma: ColorArray) -> IndexArray:
        """Indices of all of N colors nearer than OUTLIER_DISTANCE, and of some beyond: a bound."""
        light = np.log(luma) - self.log_luma
        widest = OUTLIER_DISTANCE * (float(self.covariance[0, 0]) + (NOISE_LEVELS / luma) ** 2)
        offset = chroma[..., 0] - float(self.mean[0]) - float(self.slope[0]) * light
        limit = float(np.sqrt(OUTLIER_DISTANCE)) * self.log_luma_deviation
        return np.flatnonzero((offset * offset <= widest) & (np.abs(light) <= limit))


@dataclass(frozen=True, eq=False)
class ColorModel:
    """Classifier of colors as markers or background, learned for one clip."""

    distributions: tuple[ColorDistribution, ...]  # one a color
    label: Image  # (CELL_COUNT,) uint8, index of the likeliest color of each cell, or BACKGROUND
    probability: Image  # (CELL_COUNT,) uint8, posterior probability in 1/255

    def labels(self, image: Image) -> Image:
        """The label, (rows, columns), of every pixel of an image."""
        return np.take(self.label, cell_index(image))


def color_model(
    distributions: Sequence[ColorDistribution], pixel_counts: ArrayLike, background_counts: ArrayLike
) -> ColorModel:
    """Classify every color cell as a marker's, the background's or unknown, by posterior probability.

    `pixel_counts` (M,) are the markers' in the frames in which `background_counts` (CELL_COUNT,) were
    counted.
    """
    # Tested by groups of two by two by two cells, within which colors change little.
    red, green, blue = np.meshgrid(*[(LEVELS[::2] + LEVELS[1::2]) / 2.0] * 3, indexing="ij")
    middle = chromaticity(np.stack([blue, green, red], axis=-1).reshape(-1, 3))
    single = middle[0].astype(np.float32), middle[1].astype(np.float32)
    groups = np.zeros(len(single[1]), dtype=np.bool_)
    for distribution in distributions:
        groups |= distribution.distance(*single)[0] < 2.0 * OUTLIER_DISTANCE
    cells = groups.reshape(SIDE // 2, SIDE // 2, SIDE // 2)
    near = np.flatnonzero(cells.repeat(2, axis=0).repeat(2, axis=1).repeat(2, axis=2)).astype(np.int32)
    chroma, luma = cell_chromaticity(near)
    counts = np.asarray(background_counts, dtype=np.float64)[near]
    likeliest, sureness = weigh(distributions, pixel_counts, counts, chroma, luma)
    label = np.full(CELL_COUNT, BACKGROUND, dtype=np.uint8)
    probability = np.zeros(CELL_COUNT, dtype=np.uint8)
    label[near] = np.where(sureness >= 0.5, likeliest, BACKGROUND)
    probability[near] = np.round(255.0 * sureness)
    return ColorModel(tuple(distributions), label, probability)


def weigh(
    distributions: Sequence[ColorDistribution],
    pixel_counts: ArrayLike,
    background_counts: ArrayLike,
    chroma: ColorArray,
    luma: ColorArray,
) -> tuple[IndexArray, Array]:
    """The likeliest marker of each of N color cells, (N,), and its posterior probability, (N,).

    Counts are as in `color_model`, those of the background by cell (N,), like chromaticity and luma.
    """
    counts = np.asarray(pixel_counts, dtype=np.float64)
    best, total = np.zeros(len(luma)), np.asarray(background_counts, dtype=np.float64).copy()
    label, distance = np.zeros(len(luma), dtype=np.intp), np.full(len(luma), np.inf)
    for marker, distribution in enumerate(distributions):
        near = distribution.within_reach(chroma, luma)
        squared, log_density = distribution.distance(chroma.take(near, axis=0), luma.take(near))
        evidence = counts[marker] * np.exp(log_density) * cell_volume(luma[near])
        total[near] += evidence
        better = evidence > best[near]
        where = near[better]
        best[where], label[where], distance[where] = evidence[better], marker, squared[better]
    # The unknown: as likely as the marker itself at the outlier distance, everywhere.
    with np.errstate(over="ignore", invalid="ignore"):
        unknown = best * np.exp(0.5 * (distance - OUTLIER_DISTANCE))
        return label, np.nan_to_num(best / (total + unknown))


def nearest_colors(counts: ArrayLike, sample_srgb: tuple[int, int, int]) -> list[tuple[int, int, int]]:
    """Up to three colors (red, green, blue) found in the clip, the nearest to the sample first."""
    count = np.asarray(counts, dtype=np.float64)
    common = np.flatnonzero(count > max(2e-5 * count.sum(), 0.5))  # fewer are noise
    colors = cell_colors()[common]
    wanted, wanted_luma = chromaticity(np.asarray(sample_srgb, dtype=np.float64)[::-1])
    chroma, luma = chromaticity(colors)
    distance = np.linalg.norm(chroma - wanted, axis=1) + 0.1 * np.abs(np.log(luma / wanted_luma))
    chosen: list[int] = []
    for index in np.argsort(distance):
        if all(np.linalg.norm(chroma[index] - chroma[other]) >= 0.08 for other in chosen):
            chosen.append(int(index))
        if len(chosen) == 3:
            break
    return [(int(red), int(green), int(blue)) for blue, green, red in np.round(colors[chosen])]


def share_of_color(counts: ArrayLike, sample_srgb: tuple[int, int, int]) -> float:
    """The share of the clip's pixels, counted by color cell, that look like a color."""
    count = np.asarray(counts, dtype=np.float64)
    present = np.flatnonzero(count)
    wanted, wanted_luma = chromaticity(np.asarray(sample_srgb, dtype=np.float64)[::-1])
    chroma, luma = chromaticity(cell_colors(present.astype(np.int32)))
    like = np.linalg.norm(chroma - wanted, axis=1) < 0.04
    like &= np.abs(np.log(luma / wanted_luma)) < 0.25
    return float(count[present[like]].sum() / max(count.sum(), 1.0))


HUES = "red 15, orange 42, yellow 70, green 165, cyan 200, blue 255, purple 290, pink 340, red 360"
"""Hues with their upper bounds [degrees]."""


@dataclass(frozen=True)
class StrongColor:
    """A salient color."""

    color_srgb: tuple[int, int, int]  # (red, green, blue) in 0..255, the median of its pixels
    share: float  # share of the pixels that have it

    @property
    def hue(self) -> str:
        """Common name of its hue."""
        red, green, blue = self.color_srgb
        degrees = 360.0 * rgb_to_hsv(red / 255.0, green / 255.0, blue / 255.0)[0]
        named = (one.split() for one in HUES.split(", "))
        return next(name for name, end in named if degrees <= float(end))


def strong_colors(images: Iterable[Image]) -> tuple[StrongColor, ...]:
    """The strongest colors of images on the measuring grid, the most salient first."""
    counts = np.zeros(CELL_COUNT)
    for image in images:
        cells = cell_index(smooth(learning_image(image)))
        counts += np.bincount(cells.ravel(), minlength=CELL_COUNT)
    present = np.flatnonzero(counts).astype(np.int32)
    colors = cell_colors(present)
    chroma, luma = chromaticity(colors)
    strong = (np.linalg.norm(chroma, axis=1) > 0.2) & (luma > 25.0 + LUMA_OFFSET)
    colors, chroma = colors[strong], chroma[strong]
    left, least = counts[present][strong], 2e-4 * counts.sum()
    found: list[tuple[float, StrongColor]] = []
    while left.sum() > least:
        square = np.round(chroma / 0.04).astype(np.int64)
        _, index = np.unique(square[:, 0] * 10_000 + square[:, 1], return_inverse=True)
        densest = index == int(np.bincount(index, left).argmax())
        center = np.average(chroma[densest], axis=0, weights=left[densest])
        near = np.linalg.norm(chroma - center, axis=1) < 0.10
        share = float(left[near].sum() / counts.sum())
        if share > 2e-4:
            blue, green, red = (round(weighted_median(channel, left[near])) for channel in colors[near].T)
            # Blends at borders are many and dull; a marker is small and strong.
            standing_out = float(np.linalg.norm(center)) * share**0.25
            found.append((standing_out, StrongColor((red, green, blue), share)))
        left[near] = 0.0
    found.sort(key=lambda one: -one[0])
    return tuple(color for _, color in found[:12])  # markers, skin, and things in the room


def color_confusion(model: ColorModel) -> Array:
    """Confusion matrix (C, C + 1): shares of each color's pixels classified as each color, and as background.

    Pixels drawn from a color's learned density count by the posterior probability of their cells, as in
    tracking; rows sum to 1.
    """
    cells = np.arange(len(model.label), dtype=np.int32)
    chroma, luma = cell_chromaticity(cells)
    count = len(model.distributions)
    claims = np.zeros((count, count + 1))
    for color, distribution in enumerate(model.distributions):
        near = distribution.within_reach(chroma, luma)
        _, log_density = distribution.distance(chroma.take(near, axis=0), luma.take(near))
        share = np.exp(log_density) * cell_volume(luma.take(near))
        share = share / max(float(share.sum()), 1e-300)
        sureness = model.probability.take(near) / 255.0
        label = np.minimum(model.label.take(near), count)
        claims[color] = np.bincount(label, share * sureness, minlength=count + 1)
        claims[color, count] = 1.0 - claims[color, :count].sum()
    return claims
