"""Tracks as the estimate has seen them: those of the reading, and the regions found at a second look."""

from dataclasses import replace

import numpy as np

from ..footage.region_tracks import RegionTracks
from .terms.regions import ObservedRegions


def seen_tracks(tracks: RegionTracks, observed: ObservedRegions) -> RegionTracks:
    """The tracks with the regions that the estimate compared; what it did not find anew stays as tracked."""
    found = np.isfinite(observed.area) & (observed.area != tracks.area)
    return replace(
        tracks,
        centroid=np.where(found[..., None], observed.centroid, tracks.centroid),
        second_moment=np.where(found[..., None, None], observed.second_moment, tracks.second_moment),
        area=np.where(found, observed.area, tracks.area),
        quality=np.where(found, observed.quality, tracks.quality),
    )
