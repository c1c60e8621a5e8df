"""Time and memory of everything that people wait for, in one table.

Usage: waiting.py [CLIP ...] [--page]; clips are `small`, `ten` and `sixty`, by default
all, made of the demonstration. Each cell is a process of its own, so that its peak of memory is its own too.
With --page the table takes its place in docs/performance.md. Where MEDIAPIPE_PYTHON names a Python that has
MediaPipe 0.10 with the large network, its looks are measured beside ours. See README.md beside this file.
"""

import argparse
import json
import os
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from batch import busy_s, cost, make_shoot, process_cost
from takes import ROOT, write_results

DEMO = ROOT / "presets" / "demo" / "aerobic"
PAGE = ROOT / "docs" / "performance.md"
BEGIN, END = "<!-- times: begin -->", "<!-- times: end -->"
HERE = Path(__file__).resolve().parent
JOBS = 2
PROCESSORS = Path("/proc/cpuinfo")
LIMIT_S = 400.0
"""A step that takes longer has failed: the others are measured nevertheless."""
FAILED, LEFT_OUT = "failed", "not measured"


@dataclass(frozen=True)
class Clip:
    """A clip that is measured: a column of the table."""

    title: str
    frames: int | None
    """None: the demonstration as it is."""
    batch: int
    """Takes of the batch; 0: there is none, since it would take too long."""


CLIPS = {
    "small": Clip("4 s at 320 × 240", None, 2),
    "ten": Clip("10 s at 1920 × 1080", 300, 2),
    "sixty": Clip("60 s at 1920 × 1080", 1800, 0),
}
SIZE = (1920, 1080)
LOOKS_A_SECOND = 15  # as `core/detect` has them
MEDIAPIPE_PYTHON = os.environ.get("MEDIAPIPE_PYTHON", "")
CONVERT, BATCH, DETECT, BY_HAND, ANIMATE = "convert", "batch", "detect", "by_hand", "animate"
MEDIAPIPE = "mediapipe"
ROWS = {
    ANIMATE: "**from a bare clip to its motion**, found keypoints and poses",
    "decode": "decoding alone, without Keymark",
    "start": "start Blender with Keymark",
    "open_take": "**open the take**",
    "read": "**follow the markers**, until keyframes are proposed",
    "read_keypoints": "**read plain clothes** with a file of keypoints, likewise",
    DETECT: "**find keypoints**",
    MEDIAPIPE: "*instead: MediaPipe's own run of that network*",
    "pose_all": "**pose all**, nothing posed",
    "reconstruct": "**reconstruct** from posed keyframes",
    "filter_motion": "*instead: the paper's filter*",
    BY_HAND: "*instead: the keyframes' own curves*",
    "bake": "**bake** the final Action",
    "retarget": "**retarget** onto a Rigify human",
    "copy_rotations": "*instead: Copy Rotation constraints and Blender's bake*",
    CONVERT: "**`keymark convert`**, all files and pictures",
    BATCH: f"**`keymark batch --jobs {JOBS}`**, a take",
}


@dataclass(frozen=True)
class Cell:
    """What one step of one clip costs."""

    seconds: float
    processor_s: float
    peak_mb: float
    takes: int = 1
    stages: Mapping[str, float] = field(default_factory=dict)
    """Processor seconds of each of its stages, where they are known."""

    @property
    def text(self) -> str:
        """The cell as Markdown: time by the clock and of all processors, which other load changes least."""
        return f"{self.seconds / self.takes:.1f}/{self.processor_s / self.takes:.1f} s, {self.peak_mb:.0f} MB"


Found = dict[str, dict[str, Cell | str]]
"""By clip and step: what it costs, or why that is not known."""


def run_step(step: str, *words: object) -> dict[str, Any]:
    """Run a step in a process of its own; what it prints last.

    Raises:
        subprocess.SubprocessError: It fails, or takes too long.
    """
    command = [sys.executable, str(HERE / "waiting_steps.py"), step, *map(str, words)]
    done = subprocess.run(
        command, stdout=subprocess.PIPE, text=True, stdin=subprocess.DEVNULL, check=True, timeout=LIMIT_S
    )
    result: dict[str, Any] = json.loads(done.stdout.splitlines()[-1])
    return result


def measured(step: str, clip: Clip, take: Path) -> Cell | str:
    """What one step of a take costs, or why that is not known."""
    with tempfile.TemporaryDirectory() as temporary:
        output = Path(temporary) / "out"
        if step == BY_HAND:
            return "0 s"
        if step == MEDIAPIPE:
            if not MEDIAPIPE_PYTHON:
                return LEFT_OUT
            looks = str(HERE / "mediapipe_looks.py"), str(take / "clip.mp4"), str(LOOKS_A_SECOND)
            spent = process_cost(1, [MEDIAPIPE_PYTHON, *looks])
        elif step == DETECT:
            spent = cost(
                1,
                ["detect", str(take / "clip.mp4"), "--output", str(Path(temporary, "seen.json")), "--quiet"],
            )
        elif step == CONVERT:
            spent = cost(1, ["convert", str(take), "--output", str(output), "--quiet"])
        elif step == BATCH:
            if not clip.batch:
                return LEFT_OUT
            shoot = make_shoot(take, clip.batch, Path(temporary) / "shoot")
            words = ["batch", str(shoot), "--output", str(output), "--jobs", str(JOBS), "--quiet"]
            spent = cost(clip.batch, words)
        else:
            return Cell(**run_step(step, take))
    return Cell(spent.wall_s, spent.processor_s, spent.peak_mb, spent.takes)


def measure(name: str, place: Path) -> dict[str, Cell | str]:
    """Measure every step of a clip, whose take is made in `place`, beside the character."""
    clip, take = CLIPS[name], place / name
    if clip.frames is None:
        shutil.copytree(DEMO, take)
    else:
        run_step("make_take", take, DEMO, *SIZE, clip.frames)
    found: dict[str, Cell | str] = {}
    for step in ROWS:
        print(f"{name}: {step} ...", file=sys.stderr, flush=True)
        try:
            found[step] = measured(step, clip, take)
        except (subprocess.SubprocessError, SystemExit) as error:
            print(f"{name}: {step} failed: {error}", file=sys.stderr, flush=True)
            found[step] = FAILED
    shutil.rmtree(take)
    return found


def table(found: Found, said: str) -> str:
    """All results as Markdown."""
    titles = [CLIPS[name].title for name in found]
    lines = [said, "", "| | " + " | ".join(titles) + " |", "|---" + "|---:" * len(titles) + "|"]
    for step, title in ROWS.items():
        cells = [found[name][step] for name in found]
        if all(cell == LEFT_OUT for cell in cells):
            continue
        shown = [cell if isinstance(cell, str) else cell.text for cell in cells]
        lines.append(f"| {title} | " + " | ".join(shown) + " |")
    batches = [found[name][BATCH] for name in found]
    hourly = [
        cell if isinstance(cell, str) else f"{3600 * cell.takes / cell.seconds:.0f}" for cell in batches
    ]
    lines.append("| clips an hour by that batch, by the clock | " + " | ".join(hourly) + " |")
    cell = found[list(found)[-1]][ANIMATE]
    if isinstance(cell, Cell):
        ranked = sorted(cell.stages.items(), key=lambda one: -one[1])
        shares = [f"{stage.lower()} {100 * own / cell.processor_s:.0f} %" for stage, own in ranked]
        lines += ["", f"Of the last bare clip: {', '.join(shares[:5])}."]
    return "\n".join(lines)


def machine() -> str:
    """This machine by its cores, their clock and its memory, as far as the system tells them."""
    clocks = []
    if PROCESSORS.is_file():
        lines = PROCESSORS.read_text(encoding="utf-8").splitlines()
        clocks = [float(line.partition(":")[2]) for line in lines if line.startswith("cpu MHz")]
    at = f" at {max(clocks) / 1000.0:.1f} GHz" if clocks else ""
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 2**30
    return f"{os.cpu_count()} cores{at}, {memory:.0f} GB of memory, no graphics card"


def others_busy(began: float, before: float | None) -> str:
    """A sentence on how much other programs did since then; empty where the system does not tell."""
    after = busy_s()
    if before is None or after is None:
        return ""
    own = sum(
        used.ru_utime + used.ru_stime
        for used in map(resource.getrusage, (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    )
    others = max(0.0, after - before - own) / (time.perf_counter() - began)
    return f" Other programs kept {others:.1f} processors busy meanwhile."


def placed(page: str, text: str) -> str:
    """A page with `text` between its two marks, in place of what was there.

    Raises:
        SystemExit: The page has not both marks.
    """
    head, begin, rest = page.partition(BEGIN)
    _, end, tail = rest.partition(END)
    if not begin or not end:
        raise SystemExit(f"{PAGE} has no {BEGIN} with an {END} after it")
    return f"{head}{BEGIN}\n{text}\n{END}{tail}"


def to_json(found: Found) -> Mapping[str, Any]:
    """The results for the JSON file."""
    return {
        name: {step: cell if isinstance(cell, str) else asdict(cell) for step, cell in steps.items()}
        for name, steps in found.items()
    }


def report(found: Found, others: str, on_page: bool) -> None:
    """Print and write what is known, and put it into the page if that is wanted."""
    said = (
        f"Seconds by the clock/of all processors and the most memory held, on {machine()}, in Blender as a "
        f"module.{others}"
    )
    text = table(found, said)
    write_results("waiting", text, json.dumps(to_json(found), indent=1))
    if on_page:
        PAGE.write_text(placed(PAGE.read_text(encoding="utf-8"), text), encoding="utf-8")


def main(arguments: list[str]) -> int:
    """Measure, print and write the results."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "clips", nargs="*", metavar="CLIP", help=f"some of {', '.join(CLIPS)}; by default all"
    )
    parser.add_argument("--page", action="store_true", help=f"put the table into {PAGE.name}")
    options = parser.parse_args(arguments)
    unknown = set(options.clips) - set(CLIPS)
    if unknown:
        parser.error(f"{', '.join(sorted(unknown))} is none of {', '.join(CLIPS)}")
    began, before = time.perf_counter(), busy_s()
    found: Found = {}
    with tempfile.TemporaryDirectory() as temporary:
        run_step("make_character", temporary)
        for name in options.clips or CLIPS:
            found[name] = measure(name, Path(temporary))
            # After each clip, so that a run that is broken off leaves what it knows.
            report(found, others_busy(began, before), options.page)
    return int(any(cell == FAILED for steps in found.values() for cell in steps.values()))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
