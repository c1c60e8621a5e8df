"""What a glance at a take's clip tells: its frames, its light, and how well the markers are seen."""

import numpy as np

from ...footage.clips.clip import Clip
from ...footage.clips.clip_samples import SAMPLED_FRAMES, ClipSamples
from ...footage.clips.clip_timing import is_variable_frame_rate
from ...footage.clips.image_sequence import ImageSequence
from ...footage.clips.packets import read_packets
from ...footage.clips.spread_frames import sample_spread_frames
from ...footage.clips.video_file import VideoFile
from ...footage.marker_check import MarkerCheck, MarkerReadout, check_markers
from ...progress import run
from ...take.read_footage import expected_regions
from ...take.take import Take, check_size, rate_note
from .findings import Findings

ENOUGH = SAMPLED_FRAMES // 2
"""So many frames without a marker's color tell that the conversion will not find it either."""
MOST_EXPECTED = 5000
"""Frames of the longest clip for which it is worked out where keyframes put the markers."""
ASTRAY = 0.8
"""Share of a marker's frames, near where keyframes put it, below which something is wrong."""
BLACK, DARK = 16.0, 40.0
"""Brightest tenth of a picture that is black, or dark, in levels of 255."""
FEW = 0.25
"""Share of the frames that must be dark for a word."""


def count_frames(clip: Clip, said: Findings) -> int:
    """Frames that a clip holds, as far as that is told without decoding it.

    Args:
        clip: The clip.
        said: Takes the sentences on what is odd.
    """
    if isinstance(clip.source, ImageSequence):
        said.warn(*clip.source.notes)
    packets = read_packets(clip.path) if isinstance(clip.source, VideoFile) else None
    if packets is None:
        return clip.frame_count
    held = len(packets.time_s)
    if packets.complete and held < clip.frame_count:
        said.warn(
            f"{clip.path.name} claims {clip.frame_count} frames, of which about {held} are there; it may be "
            "cut off"
        )
        return held
    if is_variable_frame_rate(packets.time_s):
        said.warn("the clip has a variable frame rate: keys will lie at the true times, between whole frames")
    return clip.frame_count


def check_footage(take: Take, clip: Clip, frames: int, said: Findings) -> tuple[MarkerReadout, ...]:
    """Look at a take's clip.

    Args:
        take: The take, with the keyframes that a person posed.
        clip: Its clip.
        frames: As many as it holds.
        said: Takes the sentences.

    Returns:
        How well each marker is seen; empty where no frame can be read.
    """
    with said.noting():
        check_size(take, clip)
    rate = rate_note(take, clip) if clip.knows_its_rate else None
    if rate is not None:
        said.warn(rate)
    samples = None
    with said.noting():
        samples = run(sample_spread_frames(clip))
    if samples is None:
        return ()
    dark = _check_light(samples, said)
    check = _seen_markers(take, samples, frames, said)
    refused = _refused(check, samples)
    if len(refused) == len(take.markers) > 1:
        said.problem(
            f"{take.clip}: the color of no marker is in any of {len(samples.images)} frames looked at; "
            + ("there is too little light" if dark else "is it a clip of this performer?")
        )
        return check.readouts
    said.problem(*(f"{take.clip}: marker {sentence}" for sentence in refused))
    for readout in check.readouts:
        said.warn(*(warning for warning in readout.warnings if warning not in refused))
    return check.readouts


def _check_light(samples: ClipSamples, said: Findings) -> bool:
    """Tell whether it is too dark in many frames."""
    bright = np.array([np.percentile(image.max(axis=-1), 90.0) for image in samples.images])
    for limit, word in ((BLACK, "black"), (DARK, "dark")):
        count = int(np.count_nonzero(bright < limit))
        if count >= max(FEW * len(bright), 1):
            said.warn(
                f"{count} of {len(bright)} frames looked at are {word}; colors are hard to tell there, more "
                "light is worth most"
            )
            return True
    return False


def _refused(check: MarkerCheck, samples: ClipSamples) -> tuple[str, ...]:
    """Sentences on colors that are nowhere, as far as enough was looked at to know it."""
    enough = len(samples.images) >= min(ENOUGH, samples.indices[-1] + 1)
    return tuple(check.missing.values()) if enough else ()


def _seen_markers(take: Take, samples: ClipSamples, frames: int, said: Findings) -> MarkerCheck:
    """Look for the markers, as the conversion will: where the keyframes put them; else anywhere.

    What is found anywhere but not there is told: something is wrong with what is said of the take.
    """
    if said.problems or len(take.keyframes) < 2 or frames > MOST_EXPECTED:
        return run(check_markers(samples, take.markers))
    nearby = run(check_markers(samples, take.markers, expected_regions(take, frames)))
    if all(readout.found >= ASTRAY * readout.sampled for readout in nearby.readouts):
        return nearby
    anywhere = run(check_markers(samples, take.markers))
    astray = [
        f"{near.name} in {free.found - near.found} of {free.found} frames"
        for free, near in zip(anywhere.readouts, nearby.readouts, strict=True)
        if near.found < ASTRAY * free.found
    ]
    if not astray:
        return nearby
    said.warn(
        f"seen far from where keyframes and camera put it: {', '.join(astray)}; check that the keyframes are "
        "this clip's, where the camera stands, and which marker is on which side"
    )
    return anywhere
