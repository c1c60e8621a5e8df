"""Finding the coloured markers of a clip: from one colour sample each to tracks of their image regions."""

from __future__ import annotations

from collections.abc import Generator, Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from .association import (
    Candidates,
    candidates,
    main_path,
    region_costs,
    rivals_costs,
    still_clutter,
    typical_area,
)
from .clip import Clip
from .clip_colours import ClipColours
from .colour_model import ColourModel
from .marker_style import MarkerStyle
from .moments import centroid_and_second_moment
from .pieces import join_pieces, region_quality
from .regions import NO_REGIONS, Regions, find_regions
from .tracks import ExpectedRegions, RegionTracks
from .working_image import halvings, measuring_image

FloatArray = NDArray[np.float64]

_STRETCH_BYTES: Final = 100_000_000
"""Memory for the images that wait until the colours are learned: five seconds of video and more."""
_TOGETHER: Final = 4
"""Images that are looked at together: enough to make little of the cost of every step."""
_SAMPLED_FRAMES: Final = 12
_DEAREST_PIECE: Final = 10.0


def learn_model(
    clip: Clip, styles: Sequence[MarkerStyle], expected: ExpectedRegions | None = None
) -> ColourModel:
    """Learn the markers' colours from frames spread over a clip, for previews of its masks.

    Args:
        clip: the footage.
        styles: the markers, M of them.
        expected: where they may be, to learn from the marker rather than from clutter of its colour.

    Raises:
        InputError: a marker's colour matches nothing in the clip; the sentence names colours that are there.
    """
    colours = ClipColours(clip.path, clip.size, styles, expected)
    times = halvings(clip.size)
    colours.learn([measuring_image(image, times) for _, image in clip.sample(_SAMPLED_FRAMES)])
    colours.check_found()
    return colours.model


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
    colours = ClipColours(clip.path, clip.size, styles, expected)
    regions, time_s = yield from _all_regions(clip, colours)
    colours.check_found()
    tracks = tracks_of_regions(regions, styles, colours.groups, expected, time_s, clip.size)
    yield 1.0
    return tracks


def _all_regions(
    clip: Clip, colours: ClipColours
) -> Generator[float, None, tuple[list[Regions], FloatArray]]:
    """Find the regions of every frame, and the frames' times.

    The images of the clip's first stretch wait, reduced, until the colours are learned from them; later ones
    are looked at as they come.
    """
    times = halvings(clip.size)
    longest = _STRETCH_BYTES // (3 * (clip.size[0] >> times) * (clip.size[1] >> times))
    waiting: list[NDArray[np.uint8]] = []
    regions: list[Regions] = []
    time_s: list[float] = []
    for index, stamp, image in clip.frames():
        time_s.append(stamp)
        if index < longest:
            waiting.append(measuring_image(image, times))
        else:
            if index == longest:
                yield from _regions_of_stretch(waiting, colours, regions, clip.frame_count)
            waiting.append(image)
            colours.watch(index, image)
            if len(waiting) == _TOGETHER:
                regions += find_regions(waiting, times, colours.model, regions[-1])
                waiting.clear()
        yield min((len(time_s) + len(regions)) / (2.0 * clip.frame_count), 1.0)
    if len(time_s) <= longest:
        yield from _regions_of_stretch(waiting, colours, regions, clip.frame_count)
    elif waiting:
        regions += find_regions(waiting, times, colours.model, regions[-1])
    return regions, np.array(time_s)


def _regions_of_stretch(
    waiting: list[NDArray[np.uint8]], colours: ClipColours, regions: list[Regions], frame_count: int
) -> Generator[float, None, None]:
    """Learn the colours from images on the measuring grid; append their regions and let go of them."""
    colours.learn(waiting)
    stretch = len(waiting)
    while waiting:
        before = regions[-1] if regions else NO_REGIONS
        regions += find_regions(waiting[:_TOGETHER], 0, colours.model, before)
        del waiting[:_TOGETHER]
        yield min((stretch + len(regions)) / (2.0 * frame_count), 1.0)


def tracks_of_regions(
    regions: Sequence[Regions],
    styles: Sequence[MarkerStyle],
    groups: Sequence[Sequence[int]],
    expected: ExpectedRegions | None,
    time_s: FloatArray,
    size: tuple[int, int],
) -> RegionTracks:
    """Tell which regions are the markers', over the whole clip at once."""
    found = [candidates(regions, colour, 2.0 ** halvings(size)) for colour in range(len(groups))]
    alone = [len(group) == 1 for group in groups]
    clutter = [
        still_clutter(one) if single else np.zeros(len(one.frame), dtype=np.bool_)
        for one, single in zip(found, alone, strict=True)
    ]
    usual = [typical_area(one, still) for one, still in zip(found, clutter, strict=True)]
    reach = 0.5 * float(np.sqrt(max(usual, default=0.0)))  # about the width of a limb that covers a marker
    joined = {}
    for colour, group in enumerate(groups):
        one = found[colour]
        length = _length(one, clutter[colour], usual[colour])
        taken = np.zeros(len(one.frame), dtype=np.bool_)
        for marker in group:
            cost = region_costs(one, clutter[colour], usual[colour], expected, marker)
            cost += rivals_costs(one, taken, expected, marker, [other for other in group if other != marker])
            path = main_path(one, cost, length)
            joined[marker] = join_pieces(one, path, cost, reach, _DEAREST_PIECE)
            taken[path[path >= 0]] = True
    rows = [joined[marker] for marker in range(len(styles))]
    moments = np.stack([row[0] for row in rows], axis=1)  # (F, M, 6)
    centroid, second = centroid_and_second_moment(moments)
    area = moments[..., 0]
    return RegionTracks(
        names=tuple(style.name for style in styles),
        centroid=centroid,
        second_moment=second,
        area=np.where(area > 0.0, area, np.nan),
        quality=np.stack([region_quality(row[0][:, 0], row[1], row[2], row[3]) for row in rows], axis=1),
        clipped=np.stack([row[1] for row in rows], axis=1),
        time_s=time_s,
        size=size,
        notes=_notes(styles, groups, expected is not None),
    )


def _notes(styles: Sequence[MarkerStyle], groups: Sequence[Sequence[int]], placed: bool) -> tuple[str, ...]:
    """Say which markers look alike."""
    how = "the keyframes tell which is which" if placed else "only their paths tell which is which"
    return tuple(
        f"markers {' and '.join(styles[marker].name for marker in group)} have almost the same colour; {how}"
        for group in groups
        if len(group) > 1
    )


def _length(found: Candidates, clutter: NDArray[np.bool_], usual_area: float) -> float:
    """Return the marker's length in px: the long axis of regions of the usual size."""
    full = ~clutter & (found.area >= 0.7 * usual_area)
    if not full.any():
        return 1.0
    _, second = centroid_and_second_moment(found.moments[full])
    return float(np.median(np.sqrt(12.0 * np.linalg.eigvalsh(second)[:, 1])))
