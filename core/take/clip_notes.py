"""Notes on a take's clip for a person, one sentence each."""

import numpy as np

from ..footage.clips.clip import Clip
from ..footage.reading import Reading
from ..footage.region_tracks import RegionTracks
from .take import Take

NOTICEABLE_RATE = 0.02
"""Difference of two frame rates that is worth a note, as a share of the take's."""
LONGEST_INTERVAL = 2.5
"""Time between two frames, as a multiple of the median, from which on frames seem to be missing."""
VARIABLE_RATE = "the clip has a variable frame rate: keys lie at the true times, between whole frames"


def clip_notes(take: Take, clip: Clip, reading: Reading) -> tuple[str, ...]:
    """Sentences on what may be wrong with a clip that has been read."""
    rate = rate_note(take, clip)
    notes = [*clip.notes] if rate is None else [*clip.notes, rate]
    tracks = reading.tracks
    short = tracks.frame_count < clip.frame_count
    if short and tracks.time_s[-1] * clip.fps < clip.frame_count - 1.5:
        notes.append(
            f"{clip.path.name} claims {clip.frame_count} frames, of which {tracks.frame_count} can "
            "be decoded; it may be cut off or damaged"
        )
    return (*notes, *reading.frame_findings.notes(take.frame_start), *_gap_notes(take, tracks))


def rate_note(take: Take, clip: Clip) -> str | None:
    """A sentence where the clip's own frame rate differs from the take's; None where they agree."""
    if abs(clip.fps - take.fps) <= NOTICEABLE_RATE * take.fps:
        return None
    return (
        f"{take.file.name} says {take.fps:g} frames per second, {take.clip.name} says {clip.fps:g}; "
        "check that it is the take's own clip"
    )


def _gap_notes(take: Take, tracks: RegionTracks) -> tuple[str, ...]:
    """A sentence on the longest gap in the time stamps: there, frame numbers are no longer times."""
    intervals = np.diff(tracks.time_s)
    if len(intervals) < 2 or intervals.max() < LONGEST_INTERVAL * np.median(intervals):
        return ()
    before = int(intervals.argmax())
    return (
        (
            f"{intervals[before]:.2f} s are missing after frame {before + take.frame_start}; check the "
            "keyframes after it"
        ),
    )
