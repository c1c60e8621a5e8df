"""A first look at some frames: how high the floor is, and how well a library's postures do one by one."""

from dataclasses import dataclass, replace

import numpy as np

from ..arrays import IndexArray
from ..footage.camera import Camera
from ..footage.region_tracks import RegionTracks
from .emissions import Fit, Turned, sweep
from .frame_likelihood import Sight, sights
from .noise_scales import Habits, scale

FLOOR_STD_M = 0.05
"""A performer's hips are that much higher or lower than the library's."""
WORLD_FLOOR_M = 0.25
"""A floor this near to z = 0 is at z = 0: sizes say no more, and scenes are built there."""
WORSE = 1.5
"""So much dearer a frame may be with the floor at z = 0 before another is believed in."""
LOOKED_AT = 15
UNKNOWN_STD_M = 2.0


@dataclass(frozen=True)
class Glance:
    """What a first look says."""

    floor_m: float
    """Height of the floor, by the markers' sizes and the feet; 0 where that is about right."""
    cost: float
    """Mean negative logarithm of the likelihood of a frame's best posture, for a performer of the habits that
    these frames suggest: no order in time betters it much."""


def glance(
    camera: Camera, tracks: RegionTracks, segments: tuple[str, ...], frames: IndexArray, states: Turned
) -> Glance:
    """Look at some frames with no floor known.

    Args:
        camera: The camera.
        tracks: The markers' regions.
        segments: The segment of each marker.
        frames: Frames to choose from.
        states: The library's postures in all headings.
    """
    chosen = frames[np.unique(np.linspace(0, len(frames) - 1, LOOKED_AT).astype(int))]
    seen = sights(camera, tracks, segments, chosen, 0.0, UNKNOWN_STD_M)
    fits = [sweep(sight, states) for sight in seen]
    floor = _height(seen, fits, states)
    if abs(floor) > WORLD_FLOOR_M:
        grounded = sights(camera, tracks, segments, chosen, 0.0, FLOOR_STD_M)
        ground = [sweep(sight, states) for sight in grounded]
        if _mean_cost(ground) - _mean_cost(fits) < WORSE:
            floor = 0.0
    else:
        floor = 0.0
    habits = _habits(seen, fits, states)
    again = sights(camera, tracks, segments, chosen, floor, FLOOR_STD_M, habits)
    return Glance(floor, _mean_cost([sweep(sight, states) for sight in again]))


def _mean_cost(fits: list[Fit]) -> float:
    return float(np.mean([fit.cost.min() for fit in fits]))


def _height(seen: list[Sight], fits: list[Fit], states: Turned) -> float:
    """The median of what the frames say of the floor's height [m], each weighed by the markers seen in it."""
    heights, weights = np.empty(len(seen)), np.empty(len(seen))
    for frame, (sight, fit) in enumerate(zip(seen, fits, strict=True)):
        share = np.exp(fit.cost.min() - fit.cost)
        heights[frame] = (share * (fit.hips[2] - states.numbers[-2, fit.states])).sum() / share.sum()
        weights[frame] = sight.seen.sum()
    order = np.argsort(heights)
    half = int(np.searchsorted(np.cumsum(weights[order]), 0.5 * weights.sum()))
    return float(heights[order[min(half, len(order) - 1)]])


def _habits(seen: list[Sight], fits: list[Fit], states: Turned) -> Habits:
    """How the performer holds each limb otherwise, by the best posture of each frame."""
    off = []
    for sight, fit in zip(seen, fits, strict=True):
        best = int(fit.cost.argmin())
        middle = states.numbers[:-2, fit.states[best]].reshape(-1, 3)
        lines = np.einsum("mki,mi->mk", sight.axes, middle + fit.hips[:, best] - sight.location)
        off.append(lines * sight.weight[:, None])
    usual = Habits.unknown(len(seen[0].seen))
    return replace(usual, middle=scale(np.array(off), np.array([sight.seen for sight in seen]), 1.0))
