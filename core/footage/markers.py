"""Finding the coloured markers of a clip: from one colour sample each to tracks of their image regions."""

from __future__ import annotations

from collections.abc import Generator, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError
from .association import Candidates, candidates, main_path, region_costs, still_clutter, typical_area
from .clip import Clip
from .colour_learning import learn_colours
from .colour_model import ColourModel
from .colour_names import nearest_colours
from .moments import centroid_and_second_moment
from .pieces import join_pieces, region_quality
from .regions import Region, find_regions
from .tracks import ExpectedRegions, RegionTracks
from .working_image import searching_image

FloatArray = NDArray[np.float64]

_SAMPLED_FRAMES: Final = 12
_MOST_SAMPLED_FRAMES: Final = 48
_LEARNING_SHARE: Final = 0.15
"""Share of the progress that learning the colours takes."""
_FEWEST_LEARNED: Final = 12
_DEAREST_PIECE: Final = 10.0


@dataclass(frozen=True)
class MarkerStyle:
    """A coloured surface marker as the performer wears it.

    Attributes:
        name: the marker's name.
        segment: the body segment it is bound to.
        color_srgb: one eyedropper sample of the footage, (red, green, blue) in 0..255.
    """

    name: str
    segment: str
    color_srgb: tuple[int, int, int]


def learn_model(
    clip: Clip, styles: Sequence[MarkerStyle], expected: ExpectedRegions | None = None
) -> ColourModel:
    """Learn the markers' colours from frames spread over a clip.

    Args:
        clip: the footage.
        styles: the markers, M of them.
        expected: where they may be, to learn from the marker rather than from clutter of its colour.

    Raises:
        InputError: a marker's colour matches nothing in the clip; the sentence names colours that are there.
    """
    for count in (_SAMPLED_FRAMES, _MOST_SAMPLED_FRAMES):
        frames = [(index, searching_image(image)) for index, image in clip.sample(count)]
        allowed = (
            None if expected is None else [_allowed(i, im.shape[:2], clip.size, expected) for i, im in frames]
        )
        learned = learn_colours(
            [image for _, image in frames], [style.color_srgb for style in styles], allowed
        )
        missing = np.flatnonzero(learned.found < _FEWEST_LEARNED)
        if not len(missing):
            return learned.model
    style = styles[int(missing[0])]
    nearest = ", ".join(
        str(list(colour)) for colour in nearest_colours(learned.background_counts, style.color_srgb)
    )
    raise InputError(
        f"{clip.path}: marker {style.name} has the colour {list(style.color_srgb)}, which matches "
        f"nothing in the clip; pick it on the marker in a frame (the nearest colours found are {nearest})"
    )


def track_markers(
    clip: Clip, styles: Sequence[MarkerStyle], expected: ExpectedRegions | None = None
) -> Generator[float, None, RegionTracks]:
    """Follow the markers through a clip.

    One pass over the clip in constant memory records the regions of each marker's colour; the marker is then
    told from clutter of like hue over the whole clip at once.

    Args:
        clip: the footage.
        styles: the markers, M of them, in the order of the result.
        expected: where each marker is expected, (F, M); never required.

    Yields:
        The fraction done, from 0 to 1.

    Returns:
        The markers' regions in every frame.

    Raises:
        InputError: a marker's colour matches nothing in the clip, or a frame cannot be read.
    """
    yield 0.0
    model = learn_model(clip, styles, expected)
    yield _LEARNING_SHARE
    regions: list[list[list[Region]]] = []
    times: list[float] = []
    for index, time_s, image in clip.frames():
        regions.append(find_regions(image, model))
        times.append(time_s)
        yield _LEARNING_SHARE + (1.0 - _LEARNING_SHARE) * min((index + 1) / clip.frame_count, 1.0)
    found = [candidates([frame[marker] for frame in regions]) for marker in range(len(styles))]
    return _tracks(found, styles, expected, np.array(times), clip.size)


def _tracks(
    found: Sequence[Candidates],
    styles: Sequence[MarkerStyle],
    expected: ExpectedRegions | None,
    time_s: FloatArray,
    size: tuple[int, int],
) -> RegionTracks:
    clutter = [still_clutter(one) for one in found]
    usual = [typical_area(one, still) for one, still in zip(found, clutter, strict=True)]
    reach = 0.5 * float(np.sqrt(max(usual, default=0.0)))  # about the width of a limb that covers a marker
    joined = []
    for marker, one in enumerate(found):
        centre = None if expected is None else expected.centre[:, marker]
        radius = None if expected is None else expected.radius[:, marker]
        cost = region_costs(one, clutter[marker], usual[marker], centre, radius)
        path = main_path(one, cost, _length(one, clutter[marker], usual[marker]))
        joined.append(join_pieces(one, path, cost, reach, _DEAREST_PIECE))
    moments = np.stack([row[0] for row in joined], axis=1)  # (F, M, 6)
    centroid, second = centroid_and_second_moment(moments)
    area = moments[..., 0]
    return RegionTracks(
        names=tuple(style.name for style in styles),
        centroid=centroid,
        second_moment=second,
        area=np.where(area > 0.0, area, np.nan),
        quality=np.stack([region_quality(row[0][:, 0], row[1], row[2], row[3]) for row in joined], axis=1),
        clipped=np.stack([row[1] for row in joined], axis=1),
        time_s=time_s,
        size=size,
    )


def _length(found: Candidates, clutter: NDArray[np.bool_], usual_area: float) -> float:
    """Return the marker's length in px: the long axis of regions of the usual size."""
    full = ~clutter & (found.area >= 0.7 * usual_area)
    if not full.any():
        return 1.0
    _, second = centroid_and_second_moment(found.moments[full])
    return float(np.median(np.sqrt(12.0 * np.linalg.eigvalsh(second)[:, 1])))


def _allowed(
    frame: int, shape: tuple[int, ...], size: tuple[int, int], expected: ExpectedRegions
) -> NDArray[np.bool_] | None:
    """Return where each marker may be looked for on the searching grid, (M, rows, columns)."""
    if frame >= len(expected.centre):
        return None
    rows, columns = np.mgrid[: shape[0], : shape[1]]
    step = size[0] // shape[1]
    pixels = np.stack([(columns + 0.5) * step, (rows + 0.5) * step], axis=-1)
    offset = np.linalg.norm(pixels - expected.centre[frame][:, None, None], axis=-1)
    # The radius bounds the centroid; the region itself reaches beyond it.
    return np.asarray(~(offset > 1.5 * expected.radius[frame][:, None, None]))
