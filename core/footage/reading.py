"""What one pass over a clip leaves for everything that follows."""

from __future__ import annotations

from dataclasses import dataclass

from .clips.album import Album
from .clips.frame_checks import NOTHING_NOTICED, Noticed
from .detections import Sightings
from .region_tracks import RegionTracks


@dataclass(frozen=True, eq=False)
class Reading:
    """A clip as it was read.

    Attributes:
        tracks: the markers' regions in every frame.
        album: a small picture of every frame; None where nothing is to be looked for but markers.
        sightings: all regions of the markers' colors; None where they were not kept.
        notes: sentences on what may be wrong with the clip.
        key: of what it was read from and how, see `reading_key`; empty where nobody knows.
        noticed: what is to be known of the frames themselves.
    """

    tracks: RegionTracks
    album: Album | None = None
    sightings: Sightings | None = None
    notes: tuple[str, ...] = ()
    key: str = ""
    noticed: Noticed = NOTHING_NOTICED
