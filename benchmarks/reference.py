"""A motion from elsewhere, mended: a network alone, Keymark without it, and with it, beside keypoints alone.

Usage: reference.py [TAKE ...] [--file network_mhr70.csv] [--faults] with names or folders of takes that have
such a file. See README.md.
"""

import argparse
import json
import sys
import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import numpy as np
from takes import chosen_takes, load_project, write_results
from trials import KEYPOINTS, Trial, with_keypoints

load_project()

from keymark.core.api import reconstruct  # noqa: E402
from keymark.core.arrays import Array  # noqa: E402
from keymark.core.body.mirror import OPPOSITE  # noqa: E402
from keymark.core.estimate.reference_alignment import align  # noqa: E402
from keymark.core.estimate.reference_evidence import own_and_usual_cost  # noqa: E402
from keymark.core.estimate.reference_placement import SeenPoints  # noqa: E402
from keymark.core.prior.keyframes import Keyframe  # noqa: E402
from keymark.core.prior.registry import SHIPPED, find_libraries  # noqa: E402
from keymark.core.prior.texts import EVERY_LIBRARY  # noqa: E402
from keymark.core.progress import run  # noqa: E402
from keymark.core.review.score import read_truth  # noqa: E402
from keymark.core.take.motion import Motion  # noqa: E402
from keymark.core.take.performer_keypoints import performer_keypoints  # noqa: E402
from keymark.core.take.read_footage import read_footage  # noqa: E402
from keymark.core.take.reference import ReferenceMotion, read_reference  # noqa: E402
from keymark.core.take.take_file import read_take  # noqa: E402
from scipy.spatial.transform import Rotation  # noqa: E402

NETWORK = "network_mhr70.csv"
BY_HAND = "keyframes_noisy.json"
COUNTS = (0, 3, 5, 10)
"""Posed keyframes per 100 frames."""
COLUMNS = ("hips", "place", "jitter", "truth's", "skate", "coverage", "ms a frame")


@dataclass(frozen=True)
class Measured:
    """One result of one take; lengths in millimeters."""

    hips: float
    place: float
    jitter: float
    true_jitter: float
    skate: float
    coverage: float
    frame_ms: float  # of processor time, after reading the footage


def read_bare(folder: Path) -> Trial:
    """A take with its keypoints, and neither markers nor keyframes."""
    take = replace(read_take(folder), keyframes=(), markers=())
    reading = run(read_footage(take))
    truth = read_truth(folder / "truth.json", take.frame_start, reading.tracks.frame_count)
    return with_keypoints(Trial(take, reading, truth, ()), folder)


def thinned(folder: Path, per_hundred: int, by_hand: bool, frames: int) -> tuple[Keyframe, ...]:
    """So many of a take's keyframes per 100 frames, evenly chosen; none for 0, at least two else."""
    keys = read_take(folder, folder / BY_HAND if by_hand else None).keyframes
    wanted = min(len(keys), max(2, round(per_hundred * frames / 100.0))) if per_hundred else 0
    return tuple(keys[int(index)] for index in np.unique(np.linspace(0, len(keys) - 1, wanted).round()))


def measure(trial: Trial, keys: tuple[Keyframe, ...], reference: ReferenceMotion | None) -> Measured:
    """Reconstruct a take; without keyframes and a reference poses are found."""
    take = replace(trial.take, keyframes=keys, reference=reference)
    begun = time.process_time()
    if keys or reference is not None:
        motion = run(reconstruct(take, "map", trial.reading)).motion
    else:
        libraries = find_libraries(EVERY_LIBRARY, [SHIPPED])
        motion = run(reconstruct(take, libraries=libraries)).motion
    seconds = time.process_time() - begun
    return scored(replace(trial, unscored=tuple(key.index for key in keys)), motion, seconds)


def scored(trial: Trial, motion: Motion, seconds: float) -> Measured:
    """The measures of a motion."""
    score = trial.score(motion.points, motion.sigma_m)
    return Measured(
        score.rooted,
        score.mpjpe,
        jitter_mm(motion.points),
        jitter_mm(trial.truth),
        score.skate or 0.0,
        score.coverage95 or 0.0,
        1e3 * seconds / len(trial.truth),
    )


def jitter_mm(points: Array) -> float:
    """Mean length of points' second difference [mm a frame²]."""
    return 1e3 * float(np.nanmean(np.linalg.norm(np.diff(points, n=2, axis=0), axis=-1)))


# --- Without the estimate: the network put where the keypoints are, as it is and with faults


def faults(points: Array) -> dict[str, Array]:
    """The same motion with a fault each; the same seeds each time."""
    rng = np.random.default_rng(5)
    third = len(points) // 3
    late, lacking, exchanged = points.copy(), points.copy(), points.copy()
    late[3:], late[:3] = points[:-3], np.nan
    lacking[rng.random(len(points)) < 0.1] = np.nan
    exchanged[third : third + 20] = points[third : third + 20][:, OPPOSITE]
    turn = Rotation.from_euler("zx", [130.0, 15.0], degrees=True).as_matrix()
    return {
        "as it is": points,
        "3 frames late": late,
        "a tenth missing": lacking,
        "sides exchanged": exchanged,
        "1.15 as large": 1.15 * points,
        "another heading": points @ turn.T,
        "shuffled": points[rng.permutation(len(points))],
    }


def placed(trial: Trial, points: Array) -> tuple[float, float, float]:
    """Error of the hips aligned and in place [mm] of a network alone, and how much it gains ."""
    take, tracks = trial.take, trial.reading.tracks
    keypoints = performer_keypoints(take, tracks)
    seen = SeenPoints.of(take.camera, keypoints, tracks, take.marker_segments)
    found = align(ReferenceMotion(points), take.body, seen, tracks.time_s, take.fps)
    known = found.known
    world = (found.points + found.hips[:, None])[known]
    score = replace(trial, truth=trial.truth[known], unscored=()).score(world)
    cost, usual = own_and_usual_cost(found, seen)
    return score.rooted, score.mpjpe, 1.0 - cost / usual


# --- Tables


def table(results: dict[str, dict[str, Measured]]) -> str:
    """Means over the takes, a row a way."""
    lines = [f"| way | {' | '.join(COLUMNS)} |", f"|---|{'---:|' * len(COLUMNS)}"]
    for way, each in results.items():
        mean = np.mean([list(asdict(one).values()) for one in each.values()], axis=0)
        digits = (0, 0, 1, 1, 1, 2, 0)
        cells = [f"{value:.{digit}f}" for value, digit in zip(mean, digits, strict=True)]
        lines.append(f"| {way} | {' | '.join(cells)} |")
    takes = list(dict.fromkeys(name for each in results.values() for name in each))
    lines += ["", f"| hips, place | {' | '.join(takes)} |", f"|---|{'---:|' * len(takes)}"]
    for way, each in results.items():
        cells = [f"{each[name].hips:.0f}, {each[name].place:.0f}" if name in each else "" for name in takes]
        lines.append(f"| {way} | {' | '.join(cells)} |")
    return "\n".join(lines)


def fault_table(found: dict[str, dict[str, tuple[float, float, float]]]) -> str:
    """A network alone, put where the keypoints are, with each fault: hips, place and gain."""
    names = list(found)
    lines = [f"| hips, place, gain | {' | '.join(names)} |", f"|---|{'---:|' * len(names)}"]
    for fault in next(iter(found.values())):
        cells = ["{:.0f}, {:.0f}, {:.2f}".format(*found[name][fault]) for name in names]
        lines.append(f"| {fault} | {' | '.join(cells)} |")
    return "\n".join(lines)


def main(arguments: Sequence[str]) -> None:
    """Measure takes and write the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("takes", nargs="*")
    parser.add_argument("--file", default=NETWORK)
    parser.add_argument("--faults", action="store_true", help="the alignment alone, which takes seconds")
    given = parser.parse_args(arguments)
    folders = {
        name: folder
        for name, folder in chosen_takes(given.takes, plain=True).items()
        if (folder / given.file).is_file() and (folder / KEYPOINTS).is_file()
    }
    if not folders:
        raise SystemExit(f"none of the takes has {given.file} and {KEYPOINTS}")
    results: dict[str, dict[str, Measured]] = {}
    wrong: dict[str, dict[str, tuple[float, float, float]]] = {}
    for name, folder in folders.items():
        print(f"{name} ...", file=sys.stderr, flush=True)
        trial = read_bare(folder)
        reference = read_reference(folder / given.file)
        wrong[name] = {fault: placed(trial, points) for fault, points in faults(reference.points_m).items()}
        if given.faults:
            continue
        for count in COUNTS:
            for by_hand in (False, True) if count == COUNTS[-1] else (False,):
                keys = thinned(folder, count, by_hand, len(trial.truth))
                for label, used in (("without", None), ("with", reference)):
                    way = f"{label}, {count} posed per 100{' by hand' if by_hand else ''}"
                    results.setdefault(way, {})[name] = measure(trial, keys, used)
    parts = ([] if given.faults else [table(results)]) + [fault_table(wrong)]
    numbers = {way: {name: asdict(one) for name, one in each.items()} for way, each in results.items()}
    write_results(
        "reference", "\n\n".join(parts), json.dumps({"results": numbers, "faults": wrong}, indent=1)
    )


if __name__ == "__main__":
    main(sys.argv[1:])
