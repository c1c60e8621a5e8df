"""Paths of points and keypoints as items: what is drawn of a motion beside its body and markers.

A keypoint is a cross where it is seen, a ring where the
motion puts it; shapes tell apart what colors do: one that is not believed is a slanting cross, one that its
source saw on the other side of the body a cross in a square.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ...core.arrays import Array, BoolArray, IndexArray
from ...core.detect.keypoints import mirrored_point
from .drawing import MIDDLE, PATH_FRAMES, SOURCES, THROWN_OUT, Fill, Item, Stroke, Style, side_color
from .figures import SLANTING, UPRIGHT, circles, dashes, diamonds, segments, squares

if TYPE_CHECKING:
    from ...core.review.compared_keypoints import ComparedKeypoints
    from ..follow.frame_keypoints import FrameKeypoints


ToRegion = Callable[[Array], Array]
ARM, RING = 5.5, 3.5  # half-length of a cross's arms, and radius of a ring [px]


def window(index: int, frame_count: int) -> IndexArray:
    """Indices of a path's frames about one, within the clip."""
    return np.arange(max(0, index - PATH_FRAMES), min(frame_count, index + PATH_FRAMES + 1))


def paths(
    names: Sequence[str],
    positions: Array,
    frames: IndexArray,
    index: int,
    keyframe_indices: IndexArray,
    style: Style,
) -> list[Item]:
    """The paths of N points: `positions` (N, I, 2) at the clip's `frames` (I,), about the frame `index`."""
    keyed = np.isin(frames, keyframe_indices)
    dots, marks = positions[:, ~keyed].reshape(-1, 2), positions[:, keyed]
    items: list[Item] = []
    for name, path in zip(names, positions, strict=True):
        color = style.color(side_color(name))
        ahead = dashes(path[frames >= index], style.dash * style.scale, style.gap * style.scale)
        items.append(Stroke(segments(path[frames <= index]), color, style.width, style.halo))
        items.append(Stroke(ahead, color, style.width, style.halo))
    items.append(Fill(circles(dots, style.size(style.dot + 0.5 * style.width), 8), style.color(MIDDLE)))
    # All edges, then all diamonds: alike neighbors are drawn in one call.
    corners = [diamonds(mark, style.size(style.diamond)) for mark in marks]
    colors = [style.color(side_color(name)) for name in names]
    pairs = list(zip(corners, colors, strict=True))
    items += [Stroke(segments(mark, closed=True), color, 1.5, style.halo) for mark, color in pairs]
    items += [Fill(mark, color) for mark, color in pairs]
    return items


def source_color(sources: Sequence[str], source: str, style: Style) -> tuple[float, ...]:
    """The color of a source among all that are drawn; the fifth has the first's again."""
    return style.color(SOURCES[list(dict.fromkeys(sources)).index(source) % len(SOURCES)])


def all_sources(keypoints: "ComparedKeypoints | None", seen: "Sequence[FrameKeypoints]") -> tuple[str, ...]:
    """The sources of what is drawn, those of the motion's keypoints first."""
    compared = () if keypoints is None else keypoints.sources
    return tuple(dict.fromkeys((*compared, *(each.source for each in seen))))


def compared_marks(
    keypoints: "ComparedKeypoints", index: int, to_region: ToRegion, sources: Sequence[str], style: Style
) -> list[Item]:
    """The keypoints of one frame that a motion was held against; `sources` in order of color."""
    if not keypoints.names:
        return []
    seen, predicted = to_region(keypoints.seen[index]), to_region(keypoints.predicted[index])
    colors = np.array([source_color(sources, source, style) for source in keypoints.sources])
    thrown_out, swapped = keypoints.thrown_out[index], keypoints.swapped[index]
    red = np.broadcast_to(style.color(THROWN_OUT), colors.shape)
    links = np.stack([seen, predicted], axis=1)
    linked = np.isfinite(links).all(axis=(-2, -1)) & ~thrown_out
    shown = np.isfinite(seen).all(axis=-1)
    rims = circles(predicted, style.size(RING), 12)
    ringed = np.isfinite(predicted).all(axis=-1)
    frames = squares(seen, style.size(1.1 * ARM))
    return [
        Stroke(links[linked], colors[linked], style.width),
        _outlines(rims, ringed, colors, style),
        _crosses(seen, shown & ~thrown_out, colors, UPRIGHT, style),
        _crosses(seen, shown & thrown_out, red, SLANTING, style),
        _outlines(frames, shown & swapped, colors, style),
    ]


def seen_marks(
    seen: "Sequence[FrameKeypoints]", to_region: ToRegion, sources: Sequence[str], style: Style
) -> list[Item]:
    """The keypoints that a take's sources see in a frame, of everyone; `sources` in order of color."""
    items: list[Item] = []
    for each in seen:
        places = to_region(each.pixel.reshape(-1, 2))
        color = np.array(source_color(sources, each.source, style))
        known = np.isfinite(places).all(axis=-1)
        items.append(_crosses(places, known, np.broadcast_to(color, (len(places), 4)), UPRIGHT, style))
    return items


def not_yet_compared(
    seen: "Sequence[FrameKeypoints]", keypoints: "ComparedKeypoints", index: int
) -> "tuple[FrameKeypoints, ...]":
    """What of a frame's keypoints the motion was not held against: clicked since, or other people's."""
    found = []
    for each in seen:
        pixel = each.pixel.copy()
        for column, name in enumerate(each.names):
            sides = name, mirrored_point(name)
            same = [point for point, known in enumerate(keypoints.names) if known in sides]
            apart = np.linalg.norm(pixel[:, column, None] - keypoints.seen[index, same], axis=-1)
            pixel[(apart < 0.5).any(axis=1), column] = np.nan
        if np.isfinite(pixel).any():
            found.append(replace(each, pixel=pixel))
    return tuple(found)


def _crosses(places: Array, shown: BoolArray, colors: Array, directions: Array, style: Style) -> Stroke:
    arms = style.size(ARM) * directions
    lines = places[shown][:, None, None] + np.stack([-arms, arms], axis=1)  # (N, 2, 2, 2)
    return Stroke(lines.reshape(-1, 2, 2), np.repeat(colors[shown], 2, axis=0), style.width, style.halo)


def _outlines(corners: Array, shown: BoolArray, colors: Array, style: Style) -> Stroke:
    count = corners.shape[1]
    lines = segments(corners[shown], closed=True)
    return Stroke(lines, np.repeat(colors[shown], count, axis=0), style.width, style.halo)
