"""What one pass over a clip leaves for everything that follows."""

from dataclasses import dataclass

from .clips.album import Album
from .clips.frame_checks import NO_FINDINGS, FrameFindings
from .detections import Detections
from .region_tracks import RegionTracks


@dataclass(frozen=True, eq=False)
class Reading:
    """A clip as it was read."""

    tracks: RegionTracks
    """The markers' regions in every frame."""
    album: Album | None = None
    """A small picture of every frame; None where nothing is to be looked for but markers."""
    detections: Detections | None = None
    """All regions of the markers' colors; None where they were not kept."""
    notes: tuple[str, ...] = ()
    """Sentences on what may be wrong with the clip."""
    key: str = ""
    """Of what it was read from and how, see `reading_key`; empty where nobody knows."""
    frame_findings: FrameFindings = NO_FINDINGS
    """What is to be known of the frames themselves."""
