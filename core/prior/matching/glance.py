"""A first look at some frames: how high the floor is, and how well a library's postures do one by one."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...footage.camera import Camera
from ...footage.tracks import RegionTracks
from .sights import sights
from .sweep import Turned, sweep

Whole = NDArray[np.intp]

FLOOR_STD_M = 0.05
"""A performer's hips are that much higher or lower than the library's."""
WORLD_FLOOR_M = 0.25
"""A floor this near to z = 0 is at z = 0: sizes say no more, and scenes are built there."""
LOOKED_AT = 24
UNKNOWN_STD_M = 2.0


@dataclass(frozen=True)
class Glance:
    """What a first look says."""

    floor_m: float
    """Height of the floor, by the markers' sizes and the feet; 0 where that is about right."""
    cost: float
    """Mean negative logarithm of the likelihood of a frame's best posture: no order in time betters it."""


def glance(
    camera: Camera, tracks: RegionTracks, segments: tuple[str, ...], frames: Whole, states: Turned
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
    heights, weights, costs = [], [], []
    for sight in sights(camera, tracks, segments, chosen, 0.0, UNKNOWN_STD_M):
        fit = sweep(sight, states)
        height = fit.hips[2] - states.numbers[-2, fit.states]
        share = np.exp(fit.cost.min() - fit.cost)
        heights.append(float((share * height).sum() / share.sum()))
        weights.append(float(sight.seen.sum()))
        costs.append(float(fit.cost.min()))
    order = np.argsort(heights)
    half = np.searchsorted(np.cumsum(np.array(weights)[order]), 0.5 * sum(weights))
    height = heights[int(order[min(int(half), len(order) - 1)])]
    return Glance(0.0 if abs(height) < WORLD_FLOOR_M else height, float(np.mean(costs)))
