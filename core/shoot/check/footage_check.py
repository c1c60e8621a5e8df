"""The check of a take's clip from a few frames: frame count, light, and how well the markers are seen."""

import json

import numpy as np

from ...markers.ignored_regions import IGNORED_REGIONS, IgnoredRegion, ignored_region_fields
from ...markers.marker_check import MarkerCheck, MarkerReadout, check_markers
from ...markers.region_tracks import is_variable_frame_rate
from ...progress import run
from ...take.clip_check import VARIABLE_RATE, check_size, rate_note
from ...take.read_footage import expected_regions
from ...take.take import Take
from ...video.clip import SAMPLED_FRAMES, Clip, ClipSamples, sample_spread_frames
from ...video.container import read_packets
from ...video.image_sequence import ImageSequence
from ...video.video_file import VideoFile
from .evidence_check import Findings

MOST_EXPECTED = 5000
"""Frames of the longest clip for which the markers' expected regions are computed."""
ASTRAY = 0.8
"""Share of a marker's regions near where keyframes put it, below which a warning is given."""


def count_frames(clip: Clip, findings: Findings) -> int:
    """Number of frames of a clip, as far as known without decoding it."""
    if isinstance(clip.source, ImageSequence):
        findings.warn(*clip.source.notes)
    video = isinstance(clip.source, VideoFile) and not clip.source.is_trimmed
    packets = read_packets(clip.path) if video else None
    if packets is None:
        return clip.frame_count
    held = len(packets.time_s)
    if packets.complete and held < clip.frame_count:
        findings.warn(
            f"{clip.path.name} claims {clip.frame_count} frames, of which about {held} are there; "
            "it may be cut off"
        )
        return held
    if is_variable_frame_rate(packets.time_s):
        findings.warn(VARIABLE_RATE)
    return clip.frame_count


def check_footage(take: Take, clip: Clip, frames: int, findings: Findings) -> tuple[MarkerReadout, ...]:
    """Check a take's clip."""
    with findings.catching():
        check_size(take, clip)
    rate = rate_note(take, clip) if clip.knows_its_rate else None
    if rate is not None:
        findings.warn(rate)
    samples = None
    with findings.catching():
        samples = run(sample_spread_frames(clip))
    if samples is None:
        return ()
    dark = _check_light(samples, findings)
    if not take.markers:
        return ()
    check = _find_markers(take, samples, frames, findings)
    enough = len(samples.images) >= min(SAMPLED_FRAMES // 2, samples.indices[-1] + 1)
    missing = tuple(check.missing.values()) if enough else ()  # else the conversion may find them
    if len(missing) == len(take.markers) > 1:
        findings.problem(
            f"{take.clip}: the color of no marker is in any of {len(samples.images)} sampled frames; "
            + ("there is too little light" if dark else "is it a clip of this performer?")
        )
        return check.readouts
    findings.problem(*(f"{take.clip}: marker {sentence}" for sentence in missing))
    for readout in check.readouts:
        findings.warn(*(warning for warning in readout.warnings if warning not in missing))
    names = [readout.name for readout in check.readouts if readout.still_boxes]
    if names:
        boxes = dict.fromkeys(box for readout in check.readouts for box in readout.still_boxes)
        every = [*take.ignored_regions, *(IgnoredRegion(box=box) for box in boxes)]
        field = json.dumps(ignored_region_fields(every, take.frame_start))
        findings.warn(
            f"still areas have the color of {' and '.join(names)}; they are left out where {take.file.name} "
            f'says "{IGNORED_REGIONS}": {field}'
        )
    return check.readouts


def _check_light(samples: ClipSamples, findings: Findings) -> bool:
    """Whether many frames are dark; warns of them."""
    bright = np.array([np.percentile(image.max(axis=-1), 90.0) for image in samples.images])
    for limit, word in ((16.0, "black"), (40.0, "dark")):  # levels of 255 of the brightest tenth
        count = int(np.count_nonzero(bright < limit))
        if count >= max(0.25 * len(bright), 1):
            findings.warn(
                f"{count} of {len(bright)} sampled frames are {word}; colors are hard to tell "
                "there, more light is worth most"
            )
            return True
    return False


def _find_markers(take: Take, samples: ClipSamples, frames: int, findings: Findings) -> MarkerCheck:
    """Search for the markers as the conversion will: near where the keyframes put them, else anywhere.

    Markers found elsewhere only are a warning: camera, keyframes or clip do not fit each other.
    """
    if findings.problems or len(take.keyframes) < 2 or frames > MOST_EXPECTED:
        return run(check_markers(samples, take.markers, ignored=take.ignored_regions))
    nearby = run(check_markers(samples, take.markers, expected_regions(take, frames), take.ignored_regions))
    if all(readout.found >= ASTRAY * readout.sampled for readout in nearby.readouts):
        return nearby
    anywhere = run(check_markers(samples, take.markers, ignored=take.ignored_regions))
    astray = [
        f"{near.name} in {free.found - near.found} of {free.found} frames"
        for free, near in zip(anywhere.readouts, nearby.readouts, strict=True)
        if near.found < ASTRAY * free.found
    ]
    if not astray:
        return nearby
    findings.warn(
        f"markers are seen far from where keyframes and camera put them: {', '.join(astray)}; check "
        "that the keyframes are this clip's, where the camera stands, and which marker is on which "
        "side"
    )
    return anywhere
