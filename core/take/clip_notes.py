"""What a person should know of a take's clip, one sentence each."""

import numpy as np

from ..footage.clips.clip import Clip
from ..footage.reading import Reading
from ..footage.region_tracks import RegionTracks
from .take import Take, rate_note

PAUSE = 2.5
"""Longest time between two frames, in usual ones, that is nothing to speak of."""


def clip_notes(take: Take, clip: Clip, reading: Reading) -> tuple[str, ...]:
    """Sentences on what may be wrong with the clip."""
    rate = rate_note(take, clip)
    notes = [*clip.notes] if rate is None else [*clip.notes, rate]
    tracks = reading.tracks
    short = tracks.frame_count < clip.frame_count
    if short and tracks.time_s[-1] * clip.fps < clip.frame_count - 1.5:
        notes.append(
            f"{clip.path.name} claims {clip.frame_count} frames, of which {tracks.frame_count} can be "
            "decoded; it may be cut off or damaged"
        )
    return (*notes, *reading.frame_findings.notes(take.frame_start), *_pause_notes(take, tracks))


def _pause_notes(take: Take, tracks: RegionTracks) -> tuple[str, ...]:
    """A sentence where frames seem to have been left out, so that numbers of frames are not times."""
    pauses = np.diff(tracks.time_s)
    if len(pauses) < 2 or pauses.max() < PAUSE * np.median(pauses):
        return ()
    before = int(pauses.argmax())
    return (
        f"no frame was recorded for {pauses[before]:.2f} s after frame {before + take.frame_start}: "
        "keyframes count the frames there are, so look whether those after it lie where they should",
    )
