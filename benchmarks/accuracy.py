"""Accuracy on every take with truth: what a user could do without the footage beside the project's methods.

Usage: accuracy.py [NAME ...] with names of takes; by default all found. See README.md.
"""

import json
import sys
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from takes import load_project, take_names, write_results

load_project()

from auto_clamped import interpolate_auto_clamped  # noqa: E402
from keymark.core.body.posture import Posture  # noqa: E402
from keymark.core.prior.interpolation import interpolate_linearly  # noqa: E402
from keymark.core.progress import run  # noqa: E402
from keymark.core.reconstruct import reconstruct  # noqa: E402
from keymark.core.score import Score, read_truth, score_points  # noqa: E402
from keymark.core.take import Take, read_take  # noqa: E402

Array = NDArray[np.float64]

KEYFRAMES = {"exact": "keyframes.json", "by hand": "keyframes_noisy.json"}
METHODS = ("linear", "auto-clamped", "prior", "ekf", "map")
MEASURES = ("mpjpe", "rooted", "depth", "worst_p95", "jitter", "skate", "coverage95")


def measure(folder: Path, keyframes: Path) -> dict[str, Score]:
    """Scores of all methods on one take with one file of keyframes."""
    take = read_take(folder, keyframes)
    whole_clip = run(reconstruct(take, "map"))
    filtered = run(reconstruct(take, "ekf"))
    count = len(whole_clip.motion.time_s)
    truth = read_truth(folder / "truth.json", take.frame_start, count)
    indices = [keyframe.index for keyframe in take.keyframes]

    def plain(posture: Posture) -> Score:
        return score_points(_points(take, posture), truth, indices, take.camera)

    def estimated(points: Array, sigma_m: Array | None) -> Score:
        return score_points(points, truth, indices, take.camera, sigma_m)

    return {
        "linear": plain(interpolate_linearly(take.keyframes, count)),
        "auto-clamped": plain(interpolate_auto_clamped(take.keyframes, count)),
        "prior": plain(whole_clip.interpolation.posture),
        "ekf": estimated(filtered.motion.points, filtered.motion.sigma_m),
        "map": estimated(whole_clip.motion.points, whole_clip.motion.sigma_m),
    }


def _points(take: Take, posture: Posture) -> Array:
    return take.body.points(take.body.pose(posture))


def table(results: dict[str, dict[str, dict[str, Score]]]) -> str:
    """All results as one Markdown table, with the mean over takes at its end."""
    lines = [
        "| take | keyframes | method | " + " | ".join(MEASURES) + " |",
        "|---" * 3 + "|---:" * len(MEASURES) + "|",
    ]
    for name, by_keyframes in results.items():
        for posed, scores in by_keyframes.items():
            lines += [_line(name, posed, method, score.to_dict()) for method, score in scores.items()]
    for posed in KEYFRAMES:
        for method in METHODS:
            scores = [found[posed][method].to_dict() for found in results.values() if posed in found]
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


def main(arguments: list[str]) -> int:
    """Measure, print, write."""
    takes = take_names()
    unknown = [name for name in arguments if name not in takes]
    if unknown:
        print(f"no take is called {', '.join(unknown)}; there are {', '.join(takes)}", file=sys.stderr)
        return 2
    results: dict[str, dict[str, dict[str, Score]]] = {}
    for name in arguments or takes:
        results[name] = {}
        for posed, file in KEYFRAMES.items():
            if (takes[name] / file).is_file():
                print(f"{name}, keyframes {posed} ...", file=sys.stderr, flush=True)
                results[name][posed] = measure(takes[name], takes[name] / file)
    as_dictionaries = {
        name: {posed: {m: score.to_dict() for m, score in scores.items()} for posed, scores in found.items()}
        for name, found in results.items()
    }
    write_results("accuracy", table(results), json.dumps(as_dictionaries, indent=1))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
