"""Cost of `keymark check` per take, by size and length of its clip, as a share of converting a small one.

Usage: check.py [TAKE] with the name or the folder of a take, by default the demonstration's. Its clip is made
larger and longer with ffmpeg, with encoders' default settings: an intra frame every 250 frames.
"""

import argparse
import json
import subprocess
import tempfile
from pathlib import Path

import imageio_ffmpeg
from clock import least_time, processor_time
from takes import chosen_takes, load_project, write_results

load_project()

from keymark.core.estimate.reconstruct import reconstruct  # noqa: E402
from keymark.core.progress import run  # noqa: E402
from keymark.core.shoot.check.take_check import TakeCheck, check_take  # noqa: E402
from keymark.core.shoot.shoot import ShootTake  # noqa: E402
from keymark.core.take.take_file import read_take  # noqa: E402

USUAL = "demo/aerobic"
NOISE = "noise=alls=6:allf=t"
"""Camera noise: without it, an enlarged clip decodes more easily than a filmed one."""
KINDS: dict[str, tuple[int, list[str]]] = {
    "as it is": (0, ["-c", "copy"]),
    "twenty minutes of it": (305, ["-c", "copy", "-t", "1200"]),
    "1920 x 1080, 20 s": (7, ["-vf", f"scale=1920:1080,{NOISE}", "-t", "20", "-preset", "veryfast"]),
    "1920 x 1080, 20 s, HEVC": (7, ["-vf", f"scale=1920:1080,{NOISE}", "-t", "20", "-c:v", "libx265",
                                    "-preset", "ultrafast", "-x265-params", "log-level=none"]),
    "3840 x 2160, 4 s": (1, ["-vf", f"scale=3840:2160,{NOISE}", "-t", "4", "-preset", "ultrafast"]),
}  # fmt: skip
"""Repetitions of the clip, and ffmpeg's arguments, by kind."""


def made_take(source: Path, folder: Path, repeats: int, options: list[str]) -> Path:
    """Make a take of another clip, with a library in place of keyframes unless the clip is the original."""
    folder.mkdir()
    said = json.loads((source / "take.json").read_text(encoding="utf-8"))
    clip = source / said.get("clip", "clip.mp4")
    command = [imageio_ffmpeg.get_ffmpeg_exe(), "-v", "error", "-stream_loop", str(repeats), "-i", str(clip)]
    subprocess.run([*command, *options, str(folder / "clip.mp4")], check=True, stdin=subprocess.DEVNULL)
    size = next((word for word in options if word.startswith("scale=")), "")
    if size:
        said["camera"]["resolution"] = [int(part) for part in size[6:].partition(",")[0].split(":")]
    if repeats:
        said.pop("frame_count", None)
        said["library"] = "auto"
    else:
        (folder / "keyframes.json").write_bytes((source / "keyframes.json").read_bytes())
    (folder / "take.json").write_text(json.dumps({**said, "clip": "clip.mp4"}), encoding="utf-8")
    return folder


def measure(take: Path) -> list[dict[str, float | str]]:
    """Measure processor time of every kind of clip [s], and as a share of reconstructing the take itself."""
    converting_s = processor_time(lambda: run(reconstruct(read_take(take))))
    rows: list[dict[str, float | str]] = []
    for kind, (repeats, options) in KINDS.items():
        with tempfile.TemporaryDirectory() as temporary:
            place = made_take(take, Path(temporary) / "take", repeats, options)
            found: list[TakeCheck] = []

            def look(place: Path = place, found: list[TakeCheck] = found) -> None:
                found.append(check_take(ShootTake("take", place), lambda name: None))

            seconds = least_time(look)
        checked = found[-1]
        assert not checked.problems, checked.problems
        looked_at = checked.markers[0].sampled
        rows.append(
            {
                "clip": kind,
                "frames": checked.frames or 0,
                "looked_at": looked_at,
                "processor_s": seconds,
                "of_converting": seconds / converting_s,
            }
        )
    return rows


def report(name: str, rows: list[dict[str, float | str]]) -> str:
    """All results as Markdown."""
    lines = [
        f"Take {name}; processor seconds, and as a share of reconstructing the take as it is.",
        "",
        "| clip | frames | looked at | processor s | of converting |",
        "|---|---:|---:|---:|---:|",
    ]
    lines += [
        f"| {row['clip']} | {row['frames']} | {row['looked_at']} | {row['processor_s']:.2f} | "
        f"{row['of_converting']:.2f} |"
        for row in rows
    ]
    return "\n".join(lines)


def main() -> None:
    """Measure, print and write the results."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("take", nargs="?", metavar="TAKE", default=USUAL, help="name or folder of a take")
    name, take = next(iter(chosen_takes([parser.parse_args().take]).items()))
    rows = measure(take)
    write_results("check", report(name, rows), json.dumps(rows, indent=1))


if __name__ == "__main__":
    main()
