"""Looking at a take's markers in frames spread over its clip, and what the scene keeps of it."""

from typing import TYPE_CHECKING

import bpy

from ...core.errors import InputError
from ...core.progress import within
from ..bridge.footage import Footage
from ..footage.take_footage import note_contents
from .mask_previews import keep_preview

if TYPE_CHECKING:
    from ...core.footage.clips.clip_samples import ClipSamples
    from ...core.footage.marker_check import MarkerCheck
    from ...core.footage.marker_style import MarkerStyle
    from ...core.progress import Job

MOST_CLIPS = 2
"""Clips whose samples are kept, some megabytes each, so that another color is judged at once."""
SAMPLING_SHARE = 0.7

_samples: "dict[str, ClipSamples]" = {}
"""By what the clip's file is known by."""


def look_at_markers(footage: Footage, styles: "tuple[MarkerStyle, ...]") -> "Job[MarkerCheck]":
    """Find markers in frames spread over a clip.

    Yields:
        Progress; the frames are decoded only once a session.

    Raises:
        InputError: There is no clip, or it cannot be read.
    """
    from ...core.footage.clips.clip_samples import sample_clip
    from ...core.footage.marker_check import check_markers
    from ...core.footage.reading_key import footage_digest

    key = footage_digest(footage.path)
    samples = _samples.pop(key, None)
    if samples is None:
        job = sample_clip(footage.open())
        samples = yield from within("Looking at frames of the clip", job, 0.0, SAMPLING_SHARE)
    _samples[key] = samples  # the one used last comes last
    while len(_samples) > MOST_CLIPS:
        del _samples[next(iter(_samples))]
    check = check_markers(samples, styles)
    return (yield from within("Finding the markers", check, SAMPLING_SHARE, 1.0))


def check_unchanged(now: "tuple[MarkerStyle, ...]", then: "tuple[MarkerStyle, ...]") -> None:
    """Refuse a result about markers that are others by now.

    Raises:
        InputError: They are.
    """
    if now != then:
        raise InputError("the markers were changed while they were looked for; nothing was stored, try again")


def write_readouts(
    take: bpy.types.PropertyGroup, styles: "tuple[MarkerStyle, ...]", check: "MarkerCheck"
) -> list[str]:
    """Store what was found with the markers, keep the colors for previews; return all warnings."""
    note_contents(take)
    readouts = {readout.name: readout for readout in check.readouts}
    for marker in take.markers:
        readout = readouts.get(marker.name)
        if readout is None:
            marker.sampled = 0
            continue
        marker.sampled, marker.found = readout.sampled, readout.found
        marker.area, marker.area_share = readout.area_px, readout.area_share
        marker.distinctness = readout.distinctness
        marker.warning = "\n".join(readout.warnings)
        marker.checked_clip = take.clip_state.contents
    keep_preview(take, styles, check)
    return [sentence for readout in check.readouts for sentence in readout.warnings]
