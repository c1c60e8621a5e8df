"""Keyframes saved by a library learned from another take of the same kind: error against posed keyframes.

Usage: learning.py [LEARNED:TAKE ...] with names or folders of takes. See README.md.
"""

import argparse
import json
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

from keyframing import exact_postures, hand_posed, keyed, spread_frames
from takes import chosen_takes, load_project, write_results
from threshold import needed_for
from trials import Trial, read_trial

load_project()

from keymark.core.library.learning import LibraryMetadata, learn_library  # noqa: E402
from keymark.core.library.library import Library  # noqa: E402
from keymark.core.posing.found_poses import with_found  # noqa: E402
from keymark.core.posing.pose_clip import pose_clip  # noqa: E402
from keymark.core.progress import run  # noqa: E402

PAIRS = ("stroll:walk", "walk:stroll", "demo/aerobic:aerobic", "aerobic:demo/aerobic")
COUNTS = (0, 2, 3, 4, 6, 8, 10, 12)
"""Numbers of posed keyframes tried; 0 is the library alone."""


def learned(folder: Path) -> Library:
    """The library learned from a take's own motion, reconstructed from hand-posed keyframes."""
    motion = read_trial(folder, folder / "keyframes_noisy.json").estimated("map")
    about = LibraryMetadata(folder.name, "Keymark")
    return learn_library(motion.body, motion.posture, motion.time_s, about)


def measure(library: Library, folder: Path) -> dict[str, Any]:
    """Errors [mm], hips aligned and absolute, by the number of keyframes, without the library and with it."""
    trial = read_trial(folder)
    posed = hand_posed(trial, exact_postures(trial))
    fit = 0.0
    errors: dict[str, dict[int, tuple[float, float]]] = {"posed": {}, "with the library": {}}
    for count in COUNTS:
        some = (
            keyed(trial, posed, spread_frames(trial, count))
            if count
            else replace(trial, take=replace(trial.take, keyframes=()), unscored=())
        )
        if count:
            errors["posed"][count] = scored(some)
        match = run(pose_clip(some.take, trial.reading, [library]))  # keyframes constrain it
        fit = fit if count else match.fit
        errors["with the library"][count] = scored(replace(some, take=with_found(some.take, match)))
    return {"frames": len(trial.truth), "fit": fit, "errors": errors}


def scored(trial: Trial) -> tuple[float, float]:
    """Mean error [mm] over unposed frames, hips aligned and absolute."""
    score = trial.score(trial.estimated("map").points)
    return score.rooted, score.mpjpe


def saved(measured: dict[str, Any], column: int) -> dict[int, float | None]:
    """Number of keyframes that alone give the same error, for each number used with the library."""
    alone = measured["errors"]["posed"]
    counts = [float(count) for count in alone]
    curve = [alone[count][column] for count in alone]
    return {
        count: needed_for(error[column], counts, curve)
        for count, error in measured["errors"]["with the library"].items()
    }


def table(found: dict[str, dict[str, Any]]) -> str:
    """All pairs as Markdown."""
    lines = [
        "Mean error [mm], hips aligned / absolute, by the number of keyframes posed by hand; last, what the "
        "error with the library takes without it.",
        "",
        "| learned from: used on | keyframes | " + " | ".join(map(str, COUNTS)) + " |",
        "|---" * 2 + "|---:" * len(COUNTS) + "|",
    ]
    for name, measured in found.items():
        for way, errors in measured["errors"].items():
            cells = [
                f"{errors[count][0]:.0f} / {errors[count][1]:.0f}" if count in errors else ""
                for count in COUNTS
            ]
            lines.append("| " + " | ".join([name, way, *cells]) + " |")
        rooted, absolute = saved(measured, 0), saved(measured, 1)
        cells = [f"{shown(rooted[count])} / {shown(absolute[count])}" for count in COUNTS]
        lines.append("| " + " | ".join([name, "worth posed", *cells]) + " |")
    return "\n".join(lines)


def shown(count: float | None) -> str:
    """A number of keyframes as text."""
    return f"> {COUNTS[-1]}" if count is None else f"{count:.1f}"


def main(arguments: list[str]) -> int:
    """Measure, print and write the results."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("pairs", nargs="*", metavar="LEARNED:TAKE", default=PAIRS)
    found: dict[str, dict[str, Any]] = {}
    for pair in parser.parse_args(arguments).pairs:
        print(f"{pair} ...", file=sys.stderr, flush=True)
        source, target = (next(iter(chosen_takes([name]).values())) for name in pair.split(":"))
        found[pair] = measure(learned(source), target)
    write_results("learning", table(found), json.dumps(found, indent=1))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
