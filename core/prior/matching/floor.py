"""How high the floor is that a performer stands on: from the sizes of the markers and where the feet are."""

import numpy as np
from numpy.typing import NDArray

from ...footage.camera import Camera
from ...footage.tracks import RegionTracks
from .sights import sights
from .sweep import Turned, places, sweep

Whole = NDArray[np.intp]

FLOOR_STD_M = 0.05
"""A performer's hips are that much higher or lower than the library's."""
WORLD_FLOOR_M = 0.25
"""A floor this near to z = 0 is at z = 0: sizes say no more, and scenes are built there."""
LOOKED_AT = 24
UNKNOWN_STD_M = 2.0


def floor_height(
    camera: Camera, tracks: RegionTracks, segments: tuple[str, ...], frames: Whole, states: Turned
) -> float:
    """Height of the floor [m], by the postures that explain some frames best.

    Args:
        camera: The camera.
        tracks: The markers' regions.
        segments: The segment of each marker.
        frames: Frames to choose from.
        states: The library's postures in all headings.
    """
    chosen = frames[np.unique(np.linspace(0, len(frames) - 1, LOOKED_AT).astype(int))]
    heights, weights = [], []
    for sight in sights(camera, tracks, segments, chosen, 0.0, UNKNOWN_STD_M):
        fit = sweep(sight, states)
        height = places(sight, states, fit)[2] - states.numbers[-2]
        share = np.exp(fit.cost.min() - fit.cost)
        heights.append(float((share * height).sum() / share.sum()))
        weights.append(float(sight.seen.sum()))
    order = np.argsort(heights)
    half = np.searchsorted(np.cumsum(np.array(weights)[order]), 0.5 * sum(weights))
    height = heights[int(order[min(int(half), len(order) - 1)])]
    return 0.0 if abs(height) < WORLD_FLOOR_M else height
