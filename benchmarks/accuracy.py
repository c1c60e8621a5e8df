"""Accuracy on every take with truth: the project's methods compared with keyframe interpolation.

Usage: accuracy.py [TAKE ...] [--plot] with names or folders of takes; by default all found. See README.md.
"""

import argparse
import json
import sys
from dataclasses import dataclass
from typing import Any

import numpy as np
from takes import chosen_takes, load_project, write_results
from trials import INTERPOLATIONS, Trial, read_trial

load_project()

from keymark.core.arrays import Array  # noqa: E402
from keymark.core.body.human import HUMAN  # noqa: E402
from keymark.core.review.score import Score  # noqa: E402

KEYFRAMES = {"exact": "keyframes.json", "by hand": "keyframes_noisy.json"}
ESTIMATES = ("ekf", "map")
METHODS = (*INTERPOLATIONS, *ESTIMATES)
MEASURES = ("mpjpe", "rooted", "depth", "worst_p95", "jitter", "skate", "coverage95")


@dataclass(frozen=True, eq=False)
class Measured:
    """Errors of one method on one take."""

    score: Score
    points_mm: dict[str, float]
    """Mean distance over the scored frames, by point."""

    def to_dict(self) -> dict[str, Any]:
        """The measures by name."""
        return {**self.score.to_dict(), "points": self.points_mm}


Results = dict[str, dict[str, dict[str, Measured]]]
"""By take, keyframe file, and method."""


def measure(trial: Trial) -> dict[str, Measured]:
    """Errors of all methods on one take with one keyframe file."""
    found = {name: _held_against(trial, points) for name, points in trial.interpolated().items()}
    for method in ESTIMATES:
        motion = trial.estimated(method)
        found[method] = _held_against(trial, motion.points, motion.sigma_m)
    return found


def _held_against(trial: Trial, points: Array, sigma_m: Array | None = None) -> Measured:
    distance = 1e3 * np.linalg.norm(points - trial.truth, axis=-1)
    free = np.delete(distance, trial.unscored, axis=0)
    by_point = dict(zip(HUMAN.point_names, free.mean(axis=0).round(3).tolist(), strict=True))
    return Measured(trial.score(points, sigma_m), by_point)


def table(results: Results) -> str:
    """All results as one Markdown table, with the mean over takes at its end."""
    lines = [
        "| take | keyframes | method | " + " | ".join(MEASURES) + " |",
        "|---" * 3 + "|---:" * len(MEASURES) + "|",
    ]
    for name, by_keyframes in results.items():
        for posed, found in by_keyframes.items():
            lines += [_line(name, posed, method, one.score.to_dict()) for method, one in found.items()]
    for posed in KEYFRAMES:
        for method in METHODS:
            scores = [found[posed][method].score.to_dict() for found in results.values() if posed in found]
            if scores:
                lines.append(_line("**mean**", posed, method, {m: _mean(scores, m) for m in MEASURES}))
    return "\n".join(lines)


def _line(name: str, posed: str, method: str, values: dict[str, float | None]) -> str:
    cells = []
    for measure_name in MEASURES:
        value = values[measure_name]
        digits = 2 if measure_name == "coverage95" else 1
        cells.append("" if value is None else f"{value:.{digits}f}")
    return f"| {name} | {posed} | {method} | " + " | ".join(cells) + " |"


def _mean(scores: list[dict[str, float | None]], measure_name: str) -> float | None:
    known = [value for score in scores if (value := score[measure_name]) is not None]
    return float(np.mean(known)) if known else None


def point_table(results: Results) -> str:
    """Mean error of each point over all takes as Markdown."""
    lines = [
        "Mean error of each point [mm].",
        "",
        "| keyframes | method | " + " | ".join(HUMAN.point_names) + " |",
        "|---" * 2 + "|---:" * len(HUMAN.point_names) + "|",
    ]
    for posed in KEYFRAMES:
        for method in METHODS:
            rows = [
                list(found[posed][method].points_mm.values()) for found in results.values() if posed in found
            ]
            if rows:
                means = " | ".join(f"{value:.1f}" for value in np.mean(rows, axis=0))
                lines.append(f"| {posed} | {method} | {means} |")
    return "\n".join(lines)


def main(arguments: list[str]) -> int:
    """Measure, print and write the results."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("takes", nargs="*", metavar="TAKE", help="names or folders of takes with truth")
    options = parser.parse_args(arguments)
    results: Results = {}
    for name, folder in chosen_takes(options.takes).items():
        results[name] = {}
        for posed, file in KEYFRAMES.items():
            if (folder / file).is_file():
                print(f"{name}, keyframes {posed} ...", file=sys.stderr, flush=True)
                results[name][posed] = measure(read_trial(folder, folder / file))
    as_dictionaries = {
        name: {posed: {m: one.to_dict() for m, one in found.items()} for posed, found in by_keyframes.items()}
        for name, by_keyframes in results.items()
    }
    tables = f"{table(results)}\n\n{point_table(results)}"
    write_results("accuracy", tables, json.dumps(as_dictionaries, indent=1))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
