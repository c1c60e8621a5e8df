"""Time and memory of `keymark convert` by stage, and their growth with the clip's length.

Usage: speed.py [TAKE] [--long] with the name or the folder of a take, by default the first found. Each row
of the first table is a process of its own, so that start-up and peak memory are those of a user's call. With
--long, ten minutes are converted instead, without Blender. See README.md beside this file.
"""

import argparse
import json
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from clock import least_time, peak_memory_mb
from takes import chosen_takes, load_project, write_results

REPEATS = (1, 10)
"""The clip's length in the two rows, in lengths of the take, played forward and backward in turn."""
STAGES = {
    "Reading the take": "read",
    "Opening the clip": "extract",
    "Following the markers": "extract",
    "Estimating the motion": "estimate",
    "Writing the motion": "write",
    "Writing Blender's files": "blend, bvh",
    "Drawing the pictures": "pictures",
}
COLUMNS = ("start-up", "read", "extract", "estimate", "write", "blend, bvh", "pictures")


class StageClock:
    """Stand-in for the command line's console that records the start of each stage, by a given clock."""

    def __init__(self, clock: Callable[[], float] = time.perf_counter) -> None:
        self.began: list[tuple[str, float]] = []
        self._clock = clock

    def stage(self, name: str) -> None:
        """Record a new stage."""
        self.began.append((name, self._clock()))

    def progress(self, progress: Any) -> None:
        """Record a new stage where a job's progress has one."""
        if not self.began or self.began[-1][0] != progress.stage:
            self.stage(progress.stage)

    def seconds(self) -> dict[str, float]:
        """Duration of each column's stages."""
        ends = [*(moment for _, moment in self.began[1:]), self._clock()]
        durations = dict.fromkeys(COLUMNS, 0.0)
        for (name, moment), end in zip(self.began, ends, strict=True):
            if name in STAGES:
                durations[STAGES[name]] += end - moment
        return durations


def convert_once(folder: Path, output: Path) -> dict[str, Any]:
    """Convert in this process; durations [s] by column, frames, and peak memory [MB]."""
    began = time.perf_counter()
    load_project()
    import bpy  # noqa: F401  # loading it is part of the start-up
    from keymark.core.take.description import describe, effective_settings
    from keymark.operators.cli.conversion.convert_take import convert_take

    clock = StageClock()
    started = time.perf_counter() - began
    description = describe(folder)
    # No more of a console is needed.
    result = convert_take(description, output, clock, effective_settings(description))  # type: ignore[arg-type]
    frames = len(result.reconstruction.motion.time_s)
    return {
        "frames": frames,
        "peak_mb": peak_memory_mb(),
        "seconds": {**clock.seconds(), "start-up": started},
    }


def measure(folder: Path, repeats: int) -> dict[str, Any]:
    """Convert a take of `repeats` times its length in a process of its own."""
    from long_clip import lengthened

    with tempfile.TemporaryDirectory() as temporary:
        place = Path(temporary)
        take = lengthened(folder, repeats, place / "take") if repeats > 1 else folder
        command = [sys.executable, __file__, "--once", str(take), str(place / "out")]
        done = subprocess.run(command, capture_output=True, text=True, stdin=subprocess.DEVNULL)
    if done.returncode:
        raise SystemExit(done.stderr)
    result: dict[str, Any] = json.loads(done.stdout.splitlines()[-1])
    return result


def table(name: str, rows: list[dict[str, Any]]) -> str:
    """The rows as Markdown."""
    lines = [
        f"Take {name}; seconds, frames per second, megabytes.",
        "",
        "| frames | " + " | ".join(COLUMNS) + " | total | frames/s | peak |",
        "|---:" * (len(COLUMNS) + 4) + "|",
    ]
    for row in rows:
        seconds = row["seconds"]
        total = sum(seconds.values())
        cells = [str(row["frames"]), *(f"{seconds[column]:.2f}" for column in COLUMNS)]
        cells += [f"{total:.1f}", f"{row['frames'] / total:.1f}", f"{row['peak_mb']:.0f}"]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)


def processor_times(folder: Path) -> dict[str, float]:
    """Processor time [ms a frame] on one core: decoding, decoding with tracking, both estimates."""
    load_project()
    import cv2
    from keymark.core.estimate.reconstruct import reconstruct
    from keymark.core.footage.markers import track_markers
    from keymark.core.progress import run
    from keymark.core.take.clip_check import open_clip
    from keymark.core.take.read_footage import expected_regions
    from keymark.core.take.take_file import read_take

    cv2.setNumThreads(1)
    take = read_take(folder)
    clip = open_clip(take)
    reading = run(reconstruct(take, "interpolation")).reading
    tracks = reading.tracks
    expected = expected_regions(take, tracks.frame_count)
    work = {
        "decode": lambda: [index for index, _, _ in clip.frames()],
        "extract": lambda: run(track_markers(clip, take.markers, expected)),
        "map": lambda: run(reconstruct(take, "map", reading)),
        "ekf": lambda: run(reconstruct(take, "ekf", reading)),
    }
    return {name: 1e3 * least_time(job) / tracks.frame_count for name, job in work.items()}


def times_table(times: dict[str, float]) -> str:
    """Processor times as Markdown, with the ratio of tracking to decoding."""
    titles = ("decode", "decode and extract", "ratio", "map", "ekf")
    ratio = times["extract"] / times["decode"]
    values = (times["decode"], times["extract"], ratio, times["map"], times["ekf"])
    return "\n".join(
        [
            "Processor time on one core [ms a frame], the shortest of three runs; with learning the colors.",
            "",
            "| " + " | ".join(titles) + " |",
            "|---:" * len(titles) + "|",
            "| " + " | ".join(f"{value:.2f}" for value in values) + " |",
        ]
    )


def main(arguments: list[str]) -> int:
    """Measure, print and write the results; with --once, convert once and print the durations."""
    if arguments[:1] == ["--once"]:
        print(json.dumps(convert_once(Path(arguments[1]), Path(arguments[2]))))
        return 0
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("take", nargs="?", metavar="TAKE", help="name or folder of a take with truth")
    parser.add_argument("--long", action="store_true", help="convert ten minutes, without Blender's files")
    options = parser.parse_args(arguments)
    name, folder = next(iter(chosen_takes([options.take] if options.take else []).items()))
    if options.long:
        import long_clip

        row = long_clip.measure_long(folder)
        write_results("speed_long", long_clip.table(name, row), json.dumps({"take": name, **row}, indent=1))
        return 0
    rows = [measure(folder, repeats) for repeats in REPEATS]
    times = processor_times(folder)
    results = {"take": name, "rows": rows, "processor_ms": times}
    write_results("speed", f"{table(name, rows)}\n\n{times_table(times)}", json.dumps(results, indent=1))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
