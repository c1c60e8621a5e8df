"""Error against the number of keyframes, and the fewest that keep it within a limit.

Usage: keyframe_economy.py [TAKE ...] [--ekf] [--snap] with names or folders of takes. See README.md.
"""

import argparse
import json
import sys
from pathlib import Path
from typing import Any

import numpy as np
from keyframing import exact_postures, hand_posed, keyed, spread_frames
from takes import chosen_takes, write_results
from threshold import needed_for
from trials import Trial, read_trial

PER_100_FRAMES = (3, 4, 5, 6, 8, 10, 14)
FEWEST = 2
LIMIT_MM = 40.0
POSED = ("exact", "by hand")

Curves = dict[str, dict[str, list[float]]]
"""Errors [mm] of each method, for each way of posing, in the order of the densities."""


def measure(folder: Path, methods: tuple[str, ...], *, snap: bool) -> dict[str, Any]:
    """Measure one take: the keyframes per 100 frames, rounded to whole keyframes, and the errors."""
    trial = read_trial(folder)
    frames = len(trial.truth)
    counts = [max(FEWEST, round(frames * density / 100.0)) for density in PER_100_FRAMES]
    exact = exact_postures(trial)
    errors: Curves = {}
    for posed, postures in zip(POSED, (exact, hand_posed(trial, exact)), strict=True):
        found = {
            count: errors_of(keyed(trial, postures, spread_frames(trial, count, snap=snap)), methods)
            for count in sorted(set(counts))
        }
        errors[posed] = {method: [found[count][method] for count in counts] for method in methods}
    return {"densities": [100.0 * count / frames for count in counts], "mpjpe": errors}


def errors_of(trial: Trial, methods: tuple[str, ...]) -> dict[str, float]:
    """Mean error [mm] of each method with the trial's keyframes."""
    return {
        method: trial.best_interpolation().mpjpe
        if method == "interpolation"
        else trial.score(trial.estimated(method).points).mpjpe
        for method in methods
    }


def mean_of(takes: dict[str, dict[str, Any]], methods: tuple[str, ...]) -> dict[str, Any]:
    """The mean curves of all takes, each take counting the same."""
    return {
        "densities": np.mean([take["densities"] for take in takes.values()], axis=0).tolist(),
        "mpjpe": {
            posed: {
                method: np.mean([take["mpjpe"][posed][method] for take in takes.values()], axis=0).tolist()
                for method in methods
            }
            for posed in POSED
        },
    }


def add_needed(measured: dict[str, Any]) -> dict[str, Any]:
    """Add a take's curves, and the keyframes per 100 frames that each method needs."""
    needed = {
        posed: {
            method: needed_for(LIMIT_MM, *distinct(measured["densities"], errors))
            for method, errors in curves.items()
        }
        for posed, curves in measured["mpjpe"].items()
    }
    return {**measured, f"needed_for_{LIMIT_MM:g}_mm": needed}


def distinct(densities: list[float], errors: list[float]) -> tuple[list[float], list[float]]:
    """The curve without duplicate densities, which arise in clips too short to tell them apart."""
    places = np.unique(densities, return_index=True)[1]
    return [densities[place] for place in places], [errors[place] for place in places]


def table(takes: dict[str, dict[str, Any]]) -> str:
    """All curves as Markdown."""
    lines = [
        f"Mean error [mm] by keyframes per 100 frames, and how many of these give {LIMIT_MM:g} mm.",
        "",
        "| take | keyframes | method | " + " | ".join(map(str, PER_100_FRAMES)) + f" | for {LIMIT_MM:g} mm |",
        "|---" * 3 + "|---:" * (len(PER_100_FRAMES) + 1) + "|",
    ]
    for name, measured in takes.items():
        densities = distinct(measured["densities"], measured["densities"])[0]
        for posed, curves in measured["mpjpe"].items():
            for method, errors in curves.items():
                needed = measured[f"needed_for_{LIMIT_MM:g}_mm"][posed][method]
                cells = [name, posed, method, *(f"{error:.1f}" for error in errors)]
                lines.append("| " + " | ".join([*cells, shown(needed, densities)]) + " |")
    return "\n".join(lines)


def shown(needed: float | None, densities: list[float]) -> str:
    """A density as text, with `<` or `>` where it lies outside the measured ones."""
    if needed is None:
        return f"> {densities[-1]:.1f}"
    return f"< {needed:.1f}" if needed <= densities[0] else f"{needed:.1f}"


def main(arguments: list[str]) -> int:
    """Measure, print and write the results."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("takes", nargs="*", metavar="TAKE", help="names or folders of takes with truth")
    parser.add_argument(
        "--ekf", action="store_true", help="measure the paper's filter as well, which is slow"
    )
    parser.add_argument("--snap", action="store_true", help="move keyframes to where the markers are slow")
    options = parser.parse_args(arguments)
    methods = ("interpolation", *(("ekf",) if options.ekf else ()), "map")
    takes: dict[str, dict[str, Any]] = {}
    for name, folder in chosen_takes(options.takes).items():
        print(f"{name} ...", file=sys.stderr, flush=True)
        takes[name] = measure(folder, methods, snap=options.snap)
    results = {name: add_needed(found) for name, found in takes.items()}
    results["**mean**"] = add_needed(mean_of(takes, methods))
    name = "keyframe_economy_snapped" if options.snap else "keyframe_economy"
    write_results(name, table(results), json.dumps(results, indent=1))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
