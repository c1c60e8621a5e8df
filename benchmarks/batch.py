"""Cost of a shoot of many takes: `keymark batch` with one worker and with several, and its alternatives.

Usage: batch.py [TAKE] [--takes N] [--jobs N] with the name or the folder of a take, by default the
demonstration's, of which the shoot has N copies with hard links to one clip. See README.md beside this file.
"""

import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from stages import COLUMNS, StageClock
from takes import chosen_takes, load_project, write_results

USUAL, USUAL_JOBS = "demo/aerobic", 2
TAKES, LOOPED = 12, 3
"""Number of takes in the shoot, and of those converted by a loop of `convert`."""
MB_OF_MAXRSS = 2**20 if sys.platform == "darwin" else 2**10
STATISTICS = Path("/proc/stat")
NEEDED = ("take.json", "keyframes.json")
LOOP, ONE, SEVERAL, AGAIN, START, CHECK = "loop", "one", "several", "again", "start", "check"
CONVERSIONS = 5
"""Number of conversions averaged for the breakdown of one."""
CORE = ("extract", "estimate")
"""Columns of `stages.py` that are the core's own work; all others are overhead."""


@dataclass(frozen=True)
class Cost:
    """Cost of commands, including all processes they start."""

    takes: int
    wall_s: float
    processor_s: float
    peak_mb: float
    others: float | None
    """Processors kept busy by other programs meanwhile; None where the system does not tell."""

    @property
    def a_take(self) -> tuple[float, float]:
        """Seconds and processor seconds a take."""
        return self.wall_s / self.takes, self.processor_s / self.takes


def make_shoot(take: Path, count: int, folder: Path) -> Path:
    """Make a folder of copies of a take; their clips are hard links to one file where the disk allows."""
    clip = json.loads((take / "take.json").read_text(encoding="utf-8")).get("clip", "clip.mp4")
    for number in range(count):
        copy = folder / f"day{number // 50 + 1}" / f"take{number + 1:03d}"
        copy.mkdir(parents=True)
        for name in NEEDED:
            shutil.copyfile(take / name, copy / name)
        try:
            os.link(take / clip, copy / clip)
        except OSError:
            shutil.copyfile(take / clip, copy / clip)
    return folder


def busy_s() -> float | None:
    """Processor seconds used by the whole machine since it started."""
    if not STATISTICS.is_file():
        return None
    user, nice, system, _, _, irq, softirq, *_ = map(
        int, STATISTICS.read_text(encoding="ascii").splitlines()[0].split()[1:]
    )
    return (user + nice + system + irq + softirq) / os.sysconf("SC_CLK_TCK")


def cost(takes: int, *commands: Sequence[str]) -> Cost:
    """Run command lines of this source tree one after the other, and measure them.

    Raises:
        SystemExit: One of them fails.
    """
    return process_cost(takes, *([sys.executable, __file__, "--keymark", *words] for words in commands))


def process_cost(takes: int, *commands: Sequence[str]) -> Cost:
    """Run any programs one after the other, and measure them and the processes they start.

    Raises:
        SystemExit: One of them fails.
    """
    began, before = time.perf_counter(), busy_s()
    processor_s = peak = 0.0
    for words in commands:
        process = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
        _, status, used = os.wait4(process.pid, 0)  # includes the processes it has started and waited for
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode:
            raise SystemExit(f"{' '.join(words)} ended with {process.returncode}")
        processor_s += used.ru_utime + used.ru_stime
        peak = max(peak, used.ru_maxrss / MB_OF_MAXRSS)
    wall_s, after = time.perf_counter() - began, busy_s()
    others = None if before is None or after is None else max(0.0, after - before - processor_s) / wall_s
    return Cost(takes, wall_s, processor_s, peak, others)


def conversion_s(take: Path) -> dict[str, float]:
    """Processor time of a conversion's stages [s] as in a worker, on one thread: mean after a warm-up."""
    load_project()
    import cv2
    from keymark.core.take.description import describe, effective_settings
    from keymark.operators.cli.conversion.convert_take import convert_take

    cv2.setNumThreads(1)
    description = describe(take)
    spent = dict.fromkeys(COLUMNS, 0.0)
    with tempfile.TemporaryDirectory() as temporary:
        for number in range(CONVERSIONS + 1):
            clock = StageClock(time.process_time)
            output = Path(temporary) / str(number)
            convert_take(description, output, clock, effective_settings(description))  # type: ignore[arg-type]
            if number:  # the first starts Blender
                spent = {name: spent[name] + value for name, value in clock.seconds().items()}
    return {name: value / CONVERSIONS for name, value in spent.items()}


def measure(take: Path, count: int, jobs: int) -> dict[str, Cost]:
    """Measure every way of converting the same shoot, a repeated batch, and `check`."""
    with tempfile.TemporaryDirectory() as temporary:
        shoot = make_shoot(take, count, Path(temporary) / "shoot")
        results = Path(temporary) / "results"

        def batch(output: str, workers: int) -> list[str]:
            return ["batch", str(shoot), "--output", str(results / output), "--jobs", str(workers), "--quiet"]

        looped = sorted(shoot.glob("*/*"))[: min(LOOPED, count)]
        loop = [["convert", str(one), "--output", str(results / one.name), "--quiet"] for one in looped]
        return {
            LOOP: cost(len(looped), *loop),
            ONE: cost(count, batch("one", 1)),
            SEVERAL: cost(count, batch("several", jobs)),
            AGAIN: cost(count, batch("several", 1)),
            START: cost(1, [*batch("several", 1), "--take", looped[0].relative_to(shoot).as_posix()]),
            CHECK: cost(count, ["check", str(shoot), "--quiet"]),
        }


def report(name: str, jobs: int, costs: dict[str, Cost], parts: dict[str, float]) -> str:
    """All results as Markdown."""
    titles = {
        LOOP: "`convert` in a loop",
        ONE: "`batch --jobs 1`",
        SEVERAL: f"`batch --jobs {jobs}`",
        AGAIN: "the same again",
        START: "one take of it again",
        CHECK: "`check`",
    }
    one, again, start = costs[ONE], costs[AGAIN], costs[START]
    lines = [
        f"Take {name}, {one.takes} copies; seconds and processor seconds a take, with starting up, and the "
        "most memory a process held [MB]. `of one` is the throughput as a share of one job's, by the clock "
        "and by what the processors did; `others` is how many processors others kept busy meanwhile.",
        "",
        "| way | takes | s a take | processor s | of one | by processor | MB | others |",
        "|---|---:|---:|---:|---:|---:|---:|---:|",
    ]
    for key, found in costs.items():
        wall_s, processor_s = found.a_take
        at_once = jobs if key == SEVERAL else 1
        share, by_processor = one.a_take[0] / wall_s, at_once * one.a_take[1] / processor_s
        others = "" if found.others is None else f"{found.others:.2f}"
        lines.append(
            f"| {titles[key]} | {found.takes} | {wall_s:.2f} | {processor_s:.2f} | {share:.2f} | "
            f"{by_processor:.2f} | {found.peak_mb:.0f} | {others} |"
        )
    core = sum(parts[column] for column in CORE)
    whole = sum(parts.values())
    surrounding = ", ".join(
        f"{title} {parts[title]:.2f}" for title in COLUMNS if title not in (*CORE, "start-up")
    )
    each = (again.processor_s - start.processor_s) / max(again.takes - 1, 1)
    checked = costs[CHECK].processor_s / costs[CHECK].takes
    return "\n".join(
        [
            *lines,
            "",
            f"In a worker that has started, a take costs {whole:.2f} s of processor time, {core:.2f} s of "
            f"it for reading the footage and estimating; the rest ({surrounding}) is {whole - core:.2f} s. "
            f"Starting a batch and its worker takes {start.processor_s:.2f} s, finding a take converted "
            f"{each:.3f} s, checking one {checked:.2f} s: {each / whole:.1%} and {checked / whole:.0%} of "
            "converting it.",
        ]
    )


def main(arguments: list[str]) -> int:
    """Measure, print and write the results; with --keymark, act as the command line of this tree."""
    if arguments[:1] == ["--keymark"]:
        load_project()
        from keymark.operators.cli.main import main as keymark

        return keymark(arguments[1:])
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("take", nargs="?", metavar="TAKE", default=USUAL, help="name or folder of a take")
    parser.add_argument("--takes", metavar="N", type=int, default=TAKES, help="takes of the shoot")
    parser.add_argument("--jobs", metavar="N", type=int, default=USUAL_JOBS, help="workers at once")
    options = parser.parse_args(arguments)
    ((name, folder),) = chosen_takes([options.take]).items()
    costs, parts = measure(folder, options.takes, options.jobs), conversion_s(folder)
    values = {"take": name, "jobs": options.jobs, "conversion_s": parts}
    values["costs"] = {key: asdict(found) for key, found in costs.items()}
    write_results("batch", report(name, options.jobs, costs, parts), json.dumps(values, indent=1))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
