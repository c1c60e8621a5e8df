"""Where the time and the memory of `keymark convert` go, and how both grow with the clip's length.

Usage: speed.py [NAME] with the name of a take, by default the first found. Each row is a process of its own,
so that start-up and peak memory are those of a user's call. See README.md beside this file.
"""

import json
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from takes import load_project, take_names, write_results

REPEATS = (1, 10)
"""The clip's length in the two rows, in lengths of the take, played forwards and backwards in turn."""
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
    """Takes the part of the command line's console and notes when each stage begins."""

    def __init__(self) -> None:
        self.began: list[tuple[str, float]] = []

    def stage(self, name: str) -> None:
        """A new stage begins."""
        self.began.append((name, time.perf_counter()))

    def progress(self, progress: Any) -> None:
        """A job goes on; its stage may have changed."""
        if not self.began or self.began[-1][0] != progress.stage:
            self.stage(progress.stage)

    def seconds(self) -> dict[str, float]:
        """Duration of each column's stages."""
        ends = [*(moment for _, moment in self.began[1:]), time.perf_counter()]
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
    from keymark.operators.command_line.conversion import convert

    clock = StageClock()
    started = time.perf_counter() - began
    result = convert(folder, output, clock)  # type: ignore[arg-type]  # it needs no more of a console
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
    frames = len(result.reconstruction.motion.time_s)
    return {"frames": frames, "peak_mb": peak, "seconds": {**clock.seconds(), "start-up": started}}


def lengthened(folder: Path, repeats: int, place: Path) -> Path:
    """A take that plays `folder`'s clip `repeats` times, forwards and backwards in turn."""
    load_project()
    import cv2
    from keymark.core.prior.keyframes import Keyframe
    from keymark.core.take import Take, read_take, write_take

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


def measure(folder: Path, repeats: int) -> dict[str, Any]:
    """Convert a take of `repeats` times its length in a process of its own."""
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


def main(arguments: list[str]) -> int:
    """Measure, print, write; with --once, convert once and print the durations."""
    if arguments[:1] == ["--once"]:
        print(json.dumps(convert_once(Path(arguments[1]), Path(arguments[2]))))
        return 0
    takes = take_names()
    name = arguments[0] if arguments else next(iter(takes))
    if name not in takes:
        print(f"no take is called {name}; there are {', '.join(takes)}", file=sys.stderr)
        return 2
    rows = [measure(takes[name], repeats) for repeats in REPEATS]
    write_results("speed", table(name, rows), json.dumps({"take": name, "rows": rows}, indent=1))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
