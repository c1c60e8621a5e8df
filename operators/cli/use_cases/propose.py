"""`keymark propose`: propose the frames of a take to pose."""

import argparse
from pathlib import Path

from ....core.arrays import Array, IndexArray
from ....core.files.json_file import write_atomically
from ....core.footage.markers import track_markers
from ....core.prior.keyframe_proposals import propose_keyframes
from ....core.prior.marker_speed import marker_speed
from ....core.progress import Job, run, within
from ....core.report.canvas import write_png
from ....core.report.speed_plot import speed_plot
from ....core.take.clip_check import open_clip
from ....core.take.take import Take
from ....core.take.take_file import read_take
from ..console import arguments_console


def propose_command(arguments: argparse.Namespace) -> None:
    """Print the frames that are worth posing, with the markers' speed for `--json`."""
    with arguments_console(arguments) as console:
        take = read_take(arguments.take, keyframes_required=False)
        speed = run(_marker_speed_job(take), console.progress)
        indices = propose_keyframes(speed, arguments.count, arguments.largest_gap)
        frames = [int(index) + take.frame_start for index in indices]
        if arguments.picture is not None:
            _write_picture(arguments.picture, speed, indices, take.frame_start)
        result = {"frames": frames, "speed_px_per_frame": [round(float(value), 3) for value in speed]}
        console.finish(result, " ".join(str(frame) for frame in frames))


def _marker_speed_job(take: Take) -> Job[Array]:
    tracks = yield from within(
        "Following the markers", track_markers(open_clip(take), take.markers), 0.0, 1.0
    )
    return marker_speed(tracks)


def _write_picture(path: Path, speed: Array, indices: IndexArray, start: int) -> None:
    picture = speed_plot(speed, [int(index) for index in indices], start)
    write_atomically(path, lambda staged: write_png(str(staged), picture))
