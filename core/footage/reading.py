"""A reading: the result of one pass over a clip, for all later steps."""

from dataclasses import dataclass

from .clips.album import Album
from .clips.frame_checks import NO_FINDINGS, FrameFindings
from .detections import Detections
from .region_tracks import RegionTracks


@dataclass(frozen=True, eq=False)
class Reading:
    """Result of one pass over a clip."""

    tracks: RegionTracks
    """The markers' regions in every frame."""
    album: Album | None = None
    """A small picture of every frame; None where only markers are used."""
    detections: Detections | None = None
    """All regions of the markers' colors; None where they were not kept."""
    notes: tuple[str, ...] = ()
    """Sentences on possible faults of the clip."""
    key: str = ""
    """Cache key of the clip and the settings, see `reading_key`; empty where unknown."""
    frame_findings: FrameFindings = NO_FINDINGS
    """Blank frames, cuts and interlacing."""
