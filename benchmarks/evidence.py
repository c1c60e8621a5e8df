"""What each kind of evidence is worth: markers, keypoints, hints of depth, contours, alone and together.

Usage: evidence.py [TAKE ...] [--wrong] with names or folders of takes. See README.md beside this file.
"""

import argparse
import json
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from clock import processor_time
from network_motion import aligned_network_points
from takes import chosen_takes, load_project, write_results
from tracked_points import tracked_people
from trials import Trial, read_trial
from wrong_keypoints import WRONG

load_project()

from keymark.core.api import reconstruct  # noqa: E402
from keymark.core.detect.keypoint_file import read_keypoints  # noqa: E402
from keymark.core.detect.keypoints import People  # noqa: E402
from keymark.core.estimate.reconstruct import Reconstruction  # noqa: E402
from keymark.core.progress import run  # noqa: E402
from keymark.core.review.score import Score  # noqa: E402
from keymark.core.take.evidence import CONTOURS, DEPTH_HINTS, KEYPOINTS, MARKERS  # noqa: E402
from keymark.core.take.read_footage import read_footage  # noqa: E402
from keymark.core.take.take import Take, with_evidence  # noqa: E402

KEYFRAMES = {"exact": "keyframes.json", "by hand": "keyframes_noisy.json"}
KEYPOINT_FILES = ("keypoints_mediapipe.json", "keypoints.json")
"""Files of a take that hold what a detector saw, the first there is."""
COMBINATIONS: Mapping[str, tuple[str, ...]] = {
    "markers": (MARKERS, CONTOURS),
    "markers + keypoints": (MARKERS, KEYPOINTS, CONTOURS),
    "markers + keypoints + hints": (MARKERS, KEYPOINTS, DEPTH_HINTS, CONTOURS),
    "keypoints": (KEYPOINTS, CONTOURS),
    "keypoints + hints": (KEYPOINTS, DEPTH_HINTS, CONTOURS),
    "contours alone": (CONTOURS,),
}
"""Kinds of evidence by name in the table; all with contours, as a user has them."""
INTERPOLATION, TRACKS, NETWORK = "interpolation", "six tracks", "the network's own"
FILTER = "the paper's filter"
UNWORN, NO_KEYPOINTS = "without markers", ", no keypoints"
"""Parts of the names of rows with wrong keypoints."""


@dataclass(frozen=True)
class Measured:
    """Errors of one combination on one take, and its cost."""

    score: Score
    ms: float | None
    """Processor time a frame, the reading of the footage not included [ms]."""
    notes: tuple[str, ...] = ()


def trials_of(folder: Path) -> Iterator[tuple[str, Trial]]:
    """A take with each of its keyframe files, its keypoints included."""
    for posed, file in KEYFRAMES.items():
        if (folder / file).is_file():
            trial = read_trial(folder, folder / file)
            people = detected(folder, trial)
            keypoints = () if people is None else (people,)
            yield posed, replace(trial, take=replace(trial.take, keypoints=keypoints))


def detected(folder: Path, trial: Trial) -> People | None:
    """What a detector saw of a take; None where no file says so."""
    files = [folder / name for name in KEYPOINT_FILES if (folder / name).is_file()]
    camera, frames = trial.take.camera, len(trial.truth)
    return read_keypoints(files[0], frames, camera.resolution) if files else None


def measure(trial: Trial) -> dict[str, Measured]:
    """Errors of one take with one keyframe file, by what the estimate is held against."""
    found = {INTERPOLATION: Measured(trial.best_interpolation(), None)}
    take = trial.take
    for name, kinds in COMBINATIONS.items():
        worn = MARKERS not in kinds or take.markers
        if worn and (KEYPOINTS not in kinds or take.keypoints):
            found[name] = estimated(trial, with_evidence(take, kinds))[1]
    if take.markers:
        found[FILTER] = estimated(trial, with_evidence(take, (MARKERS,)), "ekf")[1]
    tracked = replace(take, keypoints=(tracked_people(trial),))
    found[TRACKS] = estimated(trial, with_evidence(tracked, (KEYPOINTS, CONTOURS)))[1]
    if take.keypoints:
        result, _ = estimated(trial, with_evidence(take, (KEYPOINTS, DEPTH_HINTS)), "interpolation")
        points = aligned_network_points(trial, result.keypoints)
        if points is not None:
            found[NETWORK] = Measured(trial.score(points), None)
    return found


def measure_wrong(trial: Trial) -> dict[str, Measured]:
    """Errors with keypoints that are wrong, beside the same evidence without them."""
    take, found = trial.take, {}
    for worn, kinds in {"markers": (MARKERS, CONTOURS), UNWORN: (CONTOURS,)}.items():
        if MARKERS in kinds and not take.markers:
            continue
        found[f"{worn}{NO_KEYPOINTS}"] = estimated(trial, with_evidence(take, kinds))[1]
        for name, mistake in WRONG.items():
            wrong = replace(take, keypoints=tuple(mistake(people) for people in take.keypoints))
            more = with_evidence(wrong, (*kinds, KEYPOINTS, DEPTH_HINTS))
            found[f"{worn}, {name}"] = estimated(trial, more)[1]
    return found


def estimated(trial: Trial, take: Take, method: str = "map") -> tuple[Reconstruction, Measured]:
    """The estimate of a take, measured; the footage is read anew where other markers are followed."""
    reading = trial.reading
    if tuple(style.name for style in take.markers) != reading.tracks.names:
        reading = run(read_footage(take))
    results: list[Reconstruction] = []
    seconds = processor_time(lambda: results.append(run(reconstruct(take, method, reading))))
    motion = results[0].motion
    sigma_m = motion.sigma_m if method == "map" else None
    score = trial.score(motion.points, sigma_m)
    return results[0], Measured(score, 1e3 * seconds / len(trial.truth), results[0].notes)


Results = dict[str, dict[str, dict[str, Measured]]]
"""By take, keyframe file, and name of the evidence."""


def table(results: Results) -> str:
    """All results as one Markdown table, with the mean over the takes that have them at its end."""
    lines = [
        "| take | keyframes | evidence | error | share | depth | jitter | covered | ms |",
        "|---|---|---|---:|---:|---:|---:|---:|---:|",
    ]
    names: dict[str, None] = {}
    for take, by_keyframes in results.items():
        for posed, found in by_keyframes.items():
            names |= dict.fromkeys(found)
            for name, one in found.items():
                score, ms, base = one.score, one.ms, _base(found, name).score.mpjpe
                values = [score.mpjpe, score.mpjpe / base, score.depth, score.jitter, score.coverage95, ms]
                lines.append(_line(take, posed, name, values))
    for posed in KEYFRAMES:
        for name in names:
            known = [(found[posed][name], _base(found[posed], name))
                     for found in results.values() if name in found.get(posed, {})]  # fmt: skip
            if known:
                lines.append(_line(f"**mean of {len(known)}**", posed, name, _means(known)))
    return "\n".join(lines)


def _base(found: dict[str, Measured], name: str) -> Measured:
    """What a row is divided by: interpolation, or the same evidence without the wrong keypoints."""
    without = f"{name.partition(',')[0]}{NO_KEYPOINTS}"
    return found.get(without, next(iter(found.values())))


def _means(known: list[tuple[Measured, Measured]]) -> list[float | None]:
    scores = [one.score for one, _ in known]
    covered = [score.coverage95 for score in scores if score.coverage95 is not None]
    times = [one.ms for one, _ in known if one.ms is not None]
    return [
        float(np.mean([score.mpjpe for score in scores])),
        float(np.mean([one.score.mpjpe / base.score.mpjpe for one, base in known])),
        float(np.mean([score.depth for score in scores])),
        float(np.mean([score.jitter for score in scores])),
        float(np.mean(covered)) if covered else None,
        float(np.mean(times)) if times else None,
    ]


def _line(take: str, posed: str, name: str, values: list[float | None]) -> str:
    digits = (1, 2, 1, 1, 2, 1)
    cells = ["" if v is None else f"{v:.{d}f}" for v, d in zip(values, digits, strict=True)]
    return f"| {take} | {posed} | {name} | " + " | ".join(cells) + " |"


def main(arguments: list[str]) -> int:
    """Measure, print and write the results."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("takes", nargs="*", metavar="TAKE", help="names or folders of takes with truth")
    parser.add_argument("--wrong", action="store_true", help="with keypoints that are wrong")
    options = parser.parse_args(arguments)
    results: Results = {}
    for name, folder in chosen_takes(options.takes, plain=True).items():
        for posed, trial in trials_of(folder):
            if options.wrong and not trial.take.keypoints:
                continue
            print(f"{name}, keyframes {posed} ...", file=sys.stderr, flush=True)
            found = measure_wrong(trial) if options.wrong else measure(trial)
            results.setdefault(name, {})[posed] = found
    as_dictionaries = {
        name: {
            posed: {key: {**one.score.to_dict(), "ms": one.ms, "notes": one.notes} for key, one in f.items()}
            for posed, f in by_keyframes.items()
        }
        for name, by_keyframes in results.items()
    }
    file = "evidence_wrong" if options.wrong else "evidence"
    write_results(file, table(results), json.dumps(as_dictionaries, indent=1))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
