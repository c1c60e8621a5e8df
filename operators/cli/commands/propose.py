"""`keymark propose`: propose the frames of a take to pose."""

import argparse
from dataclasses import replace
from pathlib import Path

from ....core.prior.keyframe_proposals import EvidenceSpeed, evidence_speed, propose_keyframes
from ....core.progress import Job, run, stretch, within
from ....core.shoot.discovery import take_path
from ....core.take.description import describe
from ....core.take.performer_keypoints import performer_keypoints
from ....core.take.read_footage import read_footage
from ....core.take.take import Take
from ....core.take.take_file import read_described
from ..console import Console, argument, command
from ..options import given_settings, setting_options

UNPOSED = "no keyframe is posed yet; pose these frames, or let convert find them with --keyframes auto"


@command(
    argument("take TAKE", "take to pose, as in convert", type=Path),
    *setting_options("keypoints", "evidence"),
    argument("--count N", "number of keyframes; by default 10 per 100 frames", type=int),
    argument("--largest-gap N", "most frames between two keyframes", type=int),
)
def propose_command(arguments: argparse.Namespace, console: Console) -> None:
    """Proposes frames to pose as keyframes: about evenly spaced, where the performer moves slowly.

    The performer is followed by markers or keypoints, else by what moves in the picture.
    """
    description = describe(take_path(arguments.take))
    settings = given_settings(arguments).with_defaults(description.settings)
    take = read_described(description, keyframes_required=False, settings=settings)
    # Its keyframes have no part in it; pictures are kept only where nothing else tells how fast it moves.
    bare = not take.markers and not take.keypoints
    moved = run(_speed_job(replace(take, keyframes=(), contours=take.contours and bare)), console.progress)
    speed = moved.values
    indices = propose_keyframes(speed, arguments.count, arguments.largest_gap)
    frames = [int(index) + take.frame_start for index in indices]
    notes = [moved.note] if moved.note else []
    if not take.keyframes and (take.markers or take.keypoints):
        notes.append(UNPOSED)
    rounded = [round(float(value), 3) for value in speed]
    lines = [" ".join(str(frame) for frame in frames), *(f"Note: {note}." for note in notes)]
    result = {"frames": frames, "speed_px_per_frame": rounded, "notes": notes}
    console.finish(result, "\n".join(lines))


def _speed_job(take: Take) -> Job[EvidenceSpeed]:
    reading = yield from stretch(read_footage(take), 0.0, 0.9)
    keypoints = performer_keypoints(take, reading.tracks)
    moved = evidence_speed(reading.tracks, take.marker_segments, keypoints, reading.album)
    return (yield from within("Measuring the speed", moved, 0.9, 1.0))
