"""What one pass over a clip leaves for everything that follows."""

from dataclasses import dataclass

from .album import Album
from .tracks import RegionTracks


@dataclass(frozen=True, eq=False)
class Reading:
    """A clip as it was read.

    Attributes:
        tracks: the markers' regions in every frame.
        album: a small picture of every frame; None where nothing is to be looked for but markers.
    """

    tracks: RegionTracks
    album: Album | None = None
