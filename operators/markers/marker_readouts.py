"""Readouts of a take's markers: found in sampled frames of the clip, stored with the markers."""

from typing import TYPE_CHECKING

import bpy

from ...core.errors import InputError
from ...core.progress import within
from ..bridge.footage import Footage
from ..footage.take_footage import update_clip_digest
from ..shell.messages import capitalized
from .mask_previews import keep_preview

if TYPE_CHECKING:
    from ...core.footage.clips.clip_samples import ClipSamples
    from ...core.footage.ignored_regions import IgnoredRegion
    from ...core.footage.marker_check import MarkerCheck
    from ...core.footage.marker_style import MarkerStyle
    from ...core.progress import Job

MOST_CLIPS = 2
"""Clips whose sampled frames are cached, some megabytes each, so that another color is checked at once."""
SAMPLING_SHARE = 0.7

_samples: "dict[str, ClipSamples]" = {}
"""By the digest of the clip's file, the least recently used first."""


def find_markers(
    footage: Footage, styles: "tuple[MarkerStyle, ...]", ignored: "tuple[IgnoredRegion, ...]"
) -> "Job[MarkerCheck]":
    """Find markers in frames sampled over a clip, which are decoded once a session.

    Yields:
        Progress.

    Raises:
        InputError: The clip is missing or cannot be read.
    """
    from ...core.footage.clips.clip_samples import sample_clip
    from ...core.footage.marker_check import check_markers
    from ...core.footage.reading_key import footage_digest

    key = footage_digest(footage.path)
    samples = _samples.pop(key, None)
    if samples is None:
        job = sample_clip(footage.open())
        samples = yield from within("Looking at frames of the clip", job, 0.0, SAMPLING_SHARE)
    _samples[key] = samples  # the most recently used one last
    while len(_samples) > MOST_CLIPS:
        del _samples[next(iter(_samples))]
    check = check_markers(samples, styles, ignored=ignored)
    return (yield from within("Finding the markers", check, SAMPLING_SHARE, 1.0))


def check_unchanged(now: object, then: object) -> None:
    """Refuse a result if the markers, or what is ignored, were changed while the job ran.

    Raises:
        InputError: They were.
    """
    if now != then:
        raise InputError("the markers were changed while they were looked for; nothing was stored, try again")


def write_readouts(
    take: bpy.types.PropertyGroup, styles: "tuple[MarkerStyle, ...]", check: "MarkerCheck"
) -> list[str]:
    """Store a check with the markers, and its colors for previews; return all warnings."""
    update_clip_digest(take)
    readouts = {readout.name: readout for readout in check.readouts}
    for marker in take.markers:
        readout = readouts.get(marker.name)
        if readout is None:
            marker.sampled = 0
            continue
        marker.sampled, marker.found = readout.sampled, readout.found
        marker.area, marker.area_share = readout.area_px, readout.area_share
        marker.distinctness = readout.distinctness
        marker.warning = "\n".join(capitalized(sentence) for sentence in readout.warnings)
        marker.still_areas.clear()
        for box in readout.still_boxes:
            marker.still_areas.add().box = box
        marker.checked_clip = take.clip_state.contents
    keep_preview(take, styles, check)
    return [capitalized(sentence) for readout in check.readouts for sentence in readout.warnings]
