"""Long clips made from a take: cost of ten minutes, cost of a correction, and the seam between windows.

Usage: long_clip.py [TAKE] with the name or the folder of a take, by default the first found. See README.md.
"""

import argparse
import json
import math
import subprocess
import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from clock import peak_memory_mb
from takes import chosen_takes, load_project, write_results

load_project()

from keymark.core.estimate.reconstruct import reconstruct  # noqa: E402
from keymark.core.estimate.whole_clip import Believed, Seen, WholeClipOptions, estimate_whole_clip  # noqa: E402
from keymark.core.prior.interpolation import interpolate  # noqa: E402
from keymark.core.prior.keyframes import Keyframe  # noqa: E402
from keymark.core.progress import run  # noqa: E402
from keymark.core.take.clip_check import open_clip  # noqa: E402
from keymark.core.take.motion_file import write_motion  # noqa: E402
from keymark.core.take.take import Take  # noqa: E402
from keymark.core.take.take_file import read_take, write_take  # noqa: E402

CONVERT = "--convert"
LONG_FRAMES = 18_000
"""Ten minutes at 30 frames a second."""
SEAM_S = 60.0
"""Length of the clip that is solved in windows and at once: three windows, and memory for one."""


def lengthened(folder: Path, repeats: int, place: Path) -> Path:
    """Make a take that plays `folder`'s clip `repeats` times, forward and backward in turn."""
    take = read_take(folder)
    images, capture = [], cv2.VideoCapture(str(take.clip))
    while True:
        ok, image = capture.read()
        if not ok:
            break
        images.append(image)
    count = len(images)
    place.mkdir()
    video = cv2.VideoWriter(
        str(place / "clip.mp4"), cv2.VideoWriter.fourcc(*"mp4v"), take.fps, take.camera.resolution
    )
    keyframes = []
    for turn in range(repeats):
        backwards = turn % 2 == 1
        for image in reversed(images) if backwards else images:
            video.write(image)
        for keyframe in take.keyframes:
            index = count - 1 - keyframe.index if backwards else keyframe.index
            keyframes.append(Keyframe(turn * count + index, keyframe.posture))
    video.release()
    keyframes.sort(key=lambda keyframe: keyframe.index)
    long = Take(
        place, place / "clip.mp4", take.fps, take.frame_start, count * repeats, take.camera, take.body,
        take.markers, tuple(keyframes),
    )  # fmt: skip
    write_take(long, place)
    return place


def measure_long(folder: Path) -> dict[str, Any]:
    """Convert ten minutes, without Blender's files, in a process of its own, and measure the seam of one."""
    short = read_take(folder)
    frames, fps = len(open_clip(short).time_stamps()), short.fps
    with tempfile.TemporaryDirectory() as temporary:
        place = Path(temporary)
        take = lengthened(folder, math.ceil(LONG_FRAMES / frames), place / "long")
        command = [sys.executable, __file__, CONVERT, str(take), str(place / "motion.json")]
        done = subprocess.run(command, capture_output=True, text=True, stdin=subprocess.DEVNULL)
        if done.returncode:
            raise SystemExit(done.stderr)
        row: dict[str, Any] = json.loads(done.stdout.splitlines()[-1])
        minute = lengthened(folder, math.ceil(SEAM_S * fps / frames), place / "minute")
        return {**row, **measure_seam(minute)}


def measure_seam(folder: Path) -> dict[str, float]:
    """Largest distance [mm] of any point between a motion solved in windows and the same solved at once."""
    take = read_take(folder)
    reading = run(reconstruct(take, "interpolation")).reading
    tracks = reading.tracks
    prior = interpolate(take.keyframes, tracks.frame_count)

    def points(options: WholeClipOptions) -> np.ndarray:
        job = estimate_whole_clip(
            take.body,
            take.camera,
            Seen(tracks, take.marker_segments, album=reading.album),
            Believed(prior, take.keyframe_indices),
            options,
        )
        return take.body.points(take.body.pose(run(job).posture))

    at_once = points(WholeClipOptions(window_s=2.0 * tracks.frame_count / take.fps))
    apart = np.linalg.norm(points(WholeClipOptions()) - at_once, axis=-1)
    return {
        "seam_frames": tracks.frame_count,
        "seam_largest_mm": 1e3 * float(apart.max()),
        "seam_at_frame": int(apart.max(axis=-1).argmax()),
    }


def convert_long(folder: Path, output: Path) -> dict[str, Any]:
    """Reconstruct and write the motion in this process; processor time [s] and peak memory [MB] by stage."""
    seconds: dict[str, float] = {}
    peak_mb: dict[str, float] = {}
    began = time.process_time()

    def ended(stage: str) -> None:
        seconds[stage] = time.process_time() - began - sum(seconds.values())
        peak_mb[stage] = peak_memory_mb()

    take = read_take(folder)
    reading = run(reconstruct(take, "interpolation")).reading
    ended("extract")
    result = run(reconstruct(take, "map", reading))
    ended("estimate")
    write_motion(result.motion, output)
    ended("write")
    run(reconstruct(with_one_moved(take), "map", reading, result))
    ended("again")
    return {"frames": len(result.motion.time_s), "seconds": seconds, "peak_mb": peak_mb}


def with_one_moved(take: Take) -> Take:
    """The take with its middle keyframe posed a little differently, as after an animator's correction."""
    middle = len(take.keyframes) // 2
    deviations = take.body.skeleton.deviations
    step = 0.1 * deviations * np.random.default_rng(3).normal(size=len(deviations))
    moved = replace(take.keyframes[middle], posture=take.keyframes[middle].posture.plus(step))
    return replace(take, keyframes=(*take.keyframes[:middle], moved, *take.keyframes[middle + 1 :]))


def table(name: str, row: dict[str, Any]) -> str:
    """A long clip's costs as Markdown."""
    stages, frames = list(row["seconds"]), row["frames"]
    cells = [str(frames), *(f"{1e3 * row['seconds'][stage] / frames:.2f}" for stage in stages)]
    cells += [*(f"{row['peak_mb'][stage]:.0f}" for stage in stages), f"{row['seam_largest_mm']:.3f}"]
    titles = ["frames", *stages, *(f"peak by {stage}" for stage in stages), "seam"]
    return "\n".join(
        [
            f"Take {name} over and over; processor time [ms a frame], most memory so far [MB], seam [mm].",
            "",
            "| " + " | ".join(titles) + " |",
            "|---:" * len(titles) + "|",
            "| " + " | ".join(cells) + " |",
        ]
    )


def main(arguments: list[str]) -> int:
    """Measure, print and write the results; with --convert, convert once and print the costs."""
    if arguments[:1] == [CONVERT]:
        print(json.dumps(convert_long(Path(arguments[1]), Path(arguments[2]))))
        return 0
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("take", nargs="?", metavar="TAKE", help="name or folder of a take with truth")
    wanted = parser.parse_args(arguments).take
    name, folder = next(iter(chosen_takes([wanted] if wanted else []).items()))
    row = measure_long(folder)
    write_results("long_clip", table(name, row), json.dumps({"take": name, **row}, indent=1))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
