"""Search for shifts of parts of the body along their axes: cuffs, shoe lines, belts, the crown of the head.

Contours along a limb say nothing of a motion along it. The colors from one of its ends to the other say it:
of all shifts of the learned sequence along the axis those are likely whose colors are seen. As with contours,
this gives a distribution whose mean and variance are the measurement: a limb of one color measures nothing.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array, BoolArray, Image, IndexArray
from ..body.kinematics import Pose
from ..markers.appearance import BAND_LEVELS as LEVELS
from ..markers.appearance import BANDS, Appearance, BandColors, band_cells, learn_band_colors
from ..terms.contours import FREE, UNKNOWN, ContourModel, LimbAxes, part_map
from ..terms.occlusion import PartOutlines
from .contour_search import LARGEST_LOG_RATIO, SearchRange, measured

STEP_PX = 2.0  # distance of the pixels that are looked at, along the axis
CELL_LOG_VOLUME = float(np.log((256 / LEVELS) ** 3))  # levels³ in a cell: background densities are per level³
SHORTEST_PX = 8.0  # least length of a part in the pictures; shorter ones are seen end on


@dataclass(frozen=True, eq=False)
class Shifts:
    """Shifts of O parts along their axes in F frames."""

    share: Array  # (F, O) the point of a part's length that the colors say most of
    distance: Array  # (F, O) along the axis, toward its end [px]; zero where nothing was found
    variance: Array  # (F, O) [px²], infinite where nothing was found
    direction: Array  # (F, O, 2) unit direction of the axis in the image
    scale: Array  # (F, O) pixels of a meter


def learn_along(
    model: ContourModel,
    pose: Pose,
    frame: IndexArray,
    factor: float,
    images: list[Image],
    labels: list[NDArray[np.int8]],
) -> BandColors:
    """The colors along each part, from pictures of known postures and the parts their pixels show."""
    outlines = model.part_outlines(pose, frame)
    shares = []
    for i, label in enumerate(labels):
        row, column = np.nonzero(label >= 0)
        part = label[row, column].astype(np.intp)
        start = outlines.start[i, part] / factor
        axis = outlines.end[i, part] / factor - start
        squared = np.sum(axis * axis, axis=-1)
        along = np.sum((np.stack([column, row], axis=-1) + 0.5 - start) * axis, axis=-1)
        share = np.full(label.shape, np.nan)
        share[row, column] = np.where(squared < SHORTEST_PX**2, np.nan, along / np.maximum(squared, 1.0))
        shares.append(share)
    return learn_band_colors(images, labels, shares, len(model.parts.segments))


def find_shifts(
    model: ContourModel,
    pose: Pose,
    frame: IndexArray,
    pictures: Image,
    factor: float,
    appearance: Appearance,
    colors: BandColors,
    search: SearchRange,
) -> Shifts:
    """Search for the shifts of all parts near predicted postures.

    `pictures` (F, rows, columns, 3) are small ones, `factor` pixels of the camera to one of theirs.
    """
    outlines = model.part_outlines(pose, frame)
    size = pictures.shape[2], pictures.shape[1]
    shown = np.stack([part_map(outlines, i, size, factor) for i in range(len(pictures))])
    beyond = LimbAxes(model.parts, model.camera).beyond
    lines = _Lines.of(outlines, factor)
    shape = lines.length.shape
    found = Shifts(
        np.full(shape, 0.5),
        np.zeros(shape),
        np.full(shape, np.inf),
        lines.direction,
        model.camera.pixels_per_meter(outlines.depth.mean(axis=-1)),
    )
    samples = len(model.part_of) // shape[1]
    joined = np.concatenate([model.adjoining[::samples], np.ones((shape[1], 1), dtype=np.bool_)], axis=1)
    step = 1.0 if search.reach <= 8 else 2.0
    offset = step * np.arange(-(search.reach // step), search.reach // step + 1.0)
    for part in range(shape[1]):
        use = np.flatnonzero(lines.length[:, part] >= SHORTEST_PX)
        if not len(use):
            continue
        run, row, column, inside = lines.pixels(use, part, search.reach, size)
        inside &= joined[part][shown[use[:, None, None], row, column]]  # the last, -1, is no part
        logs = _logs(
            appearance, colors, part, beyond[part], row, column, pictures[use[:, None, None], row, column]
        )
        logs = np.where(inside[..., None], logs, 0.0).mean(axis=2)
        share = run / lines.length[use, part, None]  # (U, Q)
        _measure(found, use, part, logs, share, offset, lines.length[use, part], search, factor)
    return found


def _measure(
    found: Shifts,
    use: IndexArray,
    part: int,
    logs: Array,
    share: Array,
    offset: Array,
    length: Array,
    search: SearchRange,
    factor: float,
) -> None:
    """Fill in one part's shifts by the log likelihoods (U, Q, BANDS + 2) of pixels at shares (U, Q)."""
    place = (
        share[..., None] - offset / length[:, None, None]
    )  # (U, Q, S): where a pixel lies on a shifted part
    label = np.clip(np.floor(place * BANDS) + 1.0, 0, BANDS + 1).astype(np.intp)
    picked = np.take_along_axis(logs, label, axis=-1)
    likelihood = picked.sum(axis=1)
    # Pixels are looked at every other one.
    (mean, variance), (distance, spread) = measured(likelihood, offset, search.prior_std, STEP_PX)
    log = likelihood - 0.5 * (offset / search.prior_std) ** 2
    best = np.clip(log.argmax(axis=-1), 1, len(offset) - 2)
    pair = np.take_along_axis(picked, np.stack([best - 1, best + 1], axis=-1)[:, None], axis=-1)
    change = (pair[..., 1] - pair[..., 0]) ** 2  # (U, Q) what a pixel says of the shift
    center = np.sum(change * share, axis=1) / np.maximum(change.sum(axis=1), 1e-9)
    known = (variance < 0.5 * search.prior_std**2) & (np.abs(mean) < search.farthest)
    where = use[known]
    found.share[where, part] = np.clip(center, 0.0, 1.0)[known]
    found.distance[where, part] = distance[known] * factor
    found.variance[where, part] = spread[known] * factor**2


def _logs(
    appearance: Appearance,
    colors: BandColors,
    part: int,
    beyond: IndexArray,
    row: IndexArray,
    column: IndexArray,
    seen: Image,
) -> Array:
    """(..., BANDS + 2) log likelihoods of pixels under a part's bands, relative to the likeliest and bounded.

    Those of what lies before its start come first, after its end last.
    """
    cell = band_cells(seen)
    logs = np.empty((*cell.shape, BANDS + 2))
    logs[..., 1:-1] = np.moveaxis(colors.bands[part][:, cell], 0, -1)
    for slot, other in zip((0, -1), beyond.tolist(), strict=True):
        if other == FREE:
            logs[..., slot] = appearance.background(row, column, seen) + CELL_LOG_VOLUME
        elif other == UNKNOWN:
            logs[..., slot] = colors.anything[cell]
        else:  # a joint may be bent, and the axis then leaves the neighbor
            logs[..., slot] = np.logaddexp(colors.parts[other][cell], colors.anything[cell]) - np.log(2.0)
    return np.asarray(np.maximum(logs - logs.max(axis=-1, keepdims=True), -LARGEST_LOG_RATIO))


@dataclass(frozen=True, eq=False)
class _Lines:
    start: Array
    direction: Array
    length: Array
    half_width: Array

    @classmethod
    def of(cls, outlines: PartOutlines, factor: float) -> "_Lines":
        axis = (outlines.end - outlines.start) / factor
        length = np.linalg.norm(axis, axis=-1)
        direction = axis / np.maximum(length, 1e-6)[..., None]
        return cls(outlines.start / factor, direction, length, outlines.half_width.mean(axis=-1) / factor)

    def pixels(
        self, use: IndexArray, part: int, reach: int, size: tuple[int, int]
    ) -> tuple[Array, IndexArray, IndexArray, BoolArray]:
        """Distances along the axis (Q,), rows and columns (U, Q, lines), and which of these count."""
        direction, length = self.direction[use, part], self.length[use, part]
        across = np.stack([-direction[:, 1], direction[:, 0]], axis=-1)
        run = np.arange(-reach, length.max() + reach, STEP_PX)
        lines = np.array([-0.4, 0.0, 0.4])[:, None]  # in half-widths from the axis
        aside = lines * (self.half_width[use, part, None, None] * across[:, None])  # (U, lines, 2)
        place = self.start[use, part][:, None] + run[:, None] * direction[:, None]
        column, row = np.moveaxis(np.floor(place[:, :, None] + aside[:, None]).astype(np.intp), -1, 0)
        inside = (column >= 0) & (column < size[0]) & (row >= 0) & (row < size[1])
        inside &= (run < length[:, None] + reach)[..., None]
        return run, np.clip(row, 0, size[1] - 1), np.clip(column, 0, size[0] - 1), inside
