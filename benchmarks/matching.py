"""Keyframe libraries: accuracy without posed keyframes, and with two, by markers and by keypoints.

Usage: matching.py [TAKE ...] [--keypoints] with names or folders of takes. See README.md.
"""

import argparse
import json
import sys
import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace

import numpy as np
from keyframing import exact_postures
from takes import chosen_takes, load_project, write_results

load_project()

from keymark.core.estimate.reconstruct import reconstruct  # noqa: E402
from keymark.core.footage.reading import Reading  # noqa: E402
from keymark.core.library.library import Library  # noqa: E402
from keymark.core.library.library_file import read_library  # noqa: E402
from keymark.core.library.registry import SHIPPED  # noqa: E402
from keymark.core.posing.found_poses import FoundPoses, with_found  # noqa: E402
from keymark.core.posing.pose_clip import pose_clip  # noqa: E402
from keymark.core.prior.keyframes import Keyframe  # noqa: E402
from keymark.core.progress import run  # noqa: E402
from keymark.core.review.score import Score  # noqa: E402
from keymark.core.take import evidence_kinds as kinds  # noqa: E402
from keymark.core.take.evidence import with_evidence  # noqa: E402
from keymark.core.take.read_footage import read_footage  # noqa: E402
from keymark.core.take.take import Take  # noqa: E402
from trials import KEYPOINTS, Trial, read_unposed, with_keypoints  # noqa: E402

FITTING: dict[str, str] = {
    "walk": "walking",
    "reach": "reaching",
    "aerobic": "aerobic",
    "demo/aerobic": "aerobic",
    "real_balance": "balance",
    "stroll": "walking",
    "jog": "running",
    "jump": "jumping",
    "kick": "kicking",
    "box": "punching",
    "lift": "squatting_lifting",
    "spin": "turning",
    "star_jumps": "aerobic",
}
"""Fitting library by take; other takes fit none."""
ON_THE_FLOOR = 0.0
RAISED = ("real_balance",)
"""Takes whose performer stands on something other than the floor z = 0; their floor is not given."""
COMBINATIONS: dict[str, tuple[str, ...]] = {
    "markers": (kinds.MARKERS, kinds.CONTOURS),
    "and keypoints": kinds.EVIDENCE,
    "keypoints": (kinds.KEYPOINTS, kinds.CONTOURS),
    "with hints": (kinds.KEYPOINTS, kinds.DEPTH_HINTS, kinds.CONTOURS),
}
"""What a take is held against, by the title of its columns."""
COLUMNS = (
    "library", "course", "no posing", "hips aligned", "coverage", "two alone", "two interpolated",
    "two and library", "of two alone", "of interpolated", "ms a frame",
)  # fmt: skip


@dataclass(frozen=True)
class Measured:
    """Errors [mm] of one take with the library that fits it."""

    library: str
    course: Score
    """The match itself, before the estimate."""
    unposed: Score
    """The motion without posed keyframes."""
    two: Score
    """The motion with the first and the last frame posed, without a library."""
    two_interpolated: Score
    """The best interpolation of the same two keyframes."""
    both: Score
    """The motion with the first and the last frame posed, and the library."""
    matching_ms: float
    """Process time of matching per frame, reading excluded."""


def matched(name: str, take: Take, reading: Reading, library: Library) -> tuple[FoundPoses, float]:
    """The match, and its process time [ms a frame]."""
    begun = time.process_time()
    match = run(pose_clip(take, reading, [library], None if name in RAISED else ON_THE_FLOOR))
    return match, 1e3 * (time.process_time() - begun) / reading.tracks.frame_count


def measure(name: str, trial: Trial, library: Library) -> Measured:
    """Measure a take with one library: without posed keyframes, and with the first and the last frame."""
    match, matching_ms = matched(name, trial.take, trial.reading, library)
    body = trial.take.body
    unposed = replace(trial, take=with_found(trial.take, match))
    ends = (0, len(trial.truth) - 1)
    exact = exact_postures(trial)
    posed = tuple(Keyframe(index, exact[index]) for index in ends)
    two = replace(trial, take=replace(trial.take, keyframes=posed), unscored=ends)
    known, _ = matched(name, two.take, trial.reading, library)  # posed keyframes constrain the match
    both = replace(two, take=with_found(two.take, known))
    return Measured(
        library.identifier,
        trial.score(body.points(body.pose(match.postures))),
        estimated(unposed),
        estimated(two),
        two.best_interpolation(),
        estimated(both),
        matching_ms,
    )


def compare(name: str, trial: Trial, library: Library) -> dict[str, tuple[Score, Score]]:
    """Errors of the match and of the motion without posed keyframes, by what the take is held against."""
    found, bare = {}, None
    for title, names in COMBINATIONS.items():
        take = with_evidence(trial.take, names)
        if take.markers:
            held = replace(trial, take=take)
        else:
            bare = bare or run(read_footage(take))
            held = replace(trial, take=take, reading=bare)
        match, _ = matched(name, take, held.reading, library)
        held = replace(held, take=with_found(take, match))
        points = take.body.points(take.body.pose(match.postures))
        found[title] = held.score(points), estimated(held)
    return found


def keypoint_table(results: dict[str, dict[str, tuple[Score, Score]]]) -> str:
    """Errors by evidence as Markdown, the hips aligned, with their mean."""
    lines = [
        "Mean distance from the truth with the hips aligned [mm]: the match, and the motion without posed "
        "keyframes.",
        "",
        "| take | " + " | ".join(f"{title}: match | motion" for title in COMBINATIONS) + " |",
        "|---" + "|---:" * (2 * len(COMBINATIONS)) + "|",
    ]
    rows = {
        name: [score.rooted for title in COMBINATIONS for score in found[title]]
        for name, found in results.items()
    }
    rows["**mean**"] = np.mean(list(rows.values()), axis=0).tolist()
    lines += [
        f"| {name} | " + " | ".join(f"{value:.0f}" for value in row) + " |" for name, row in rows.items()
    ]
    return "\n".join(lines)


def estimated(trial: Trial) -> Score:
    """Score of the default method's motion."""
    motion = run(reconstruct(trial.take, "map", trial.reading)).motion
    return trial.score(motion.points, motion.sigma_m)


def accuracy_table(results: dict[str, Measured]) -> str:
    """Errors as Markdown, with their mean."""
    lines = [
        "Mean distance from the truth [mm]; two: the first and the last frame posed exactly.",
        "",
        "| take | " + " | ".join(COLUMNS) + " |",
        "|---|---" + "|---:" * (len(COLUMNS) - 1) + "|",
    ]
    rows = []
    for name, found in results.items():
        row = [
            found.course.mpjpe, found.unposed.mpjpe, found.unposed.rooted, found.unposed.coverage95 or 0.0,
            found.two.mpjpe, found.two_interpolated.mpjpe, found.both.mpjpe,
            found.both.mpjpe / found.two.mpjpe, found.both.mpjpe / found.two_interpolated.mpjpe,
            found.matching_ms,
        ]  # fmt: skip
        rows.append(row)
        lines.append(_line(name, found.library, row))
    lines.append(_line("**mean**", "", np.mean(rows, axis=0).tolist()))
    return "\n".join(lines)


def _line(name: str, library: str, row: Sequence[float]) -> str:
    digits = (1, 1, 1, 2, 1, 1, 1, 2, 2, 1)
    return (
        f"| {name} | {library} | " + " | ".join(f"{v:.{d}f}" for v, d in zip(row, digits, strict=True)) + " |"
    )


def main(arguments: list[str]) -> int:
    """Measure, print and write the results."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("takes", nargs="*", metavar="TAKE", help="names or folders of takes with truth")
    parser.add_argument(
        "--keypoints", action="store_true", help="compare evidence on takes with a detector's keypoints"
    )
    options = parser.parse_args(arguments)
    libraries = {path.stem: read_library(path) for path in sorted(SHIPPED.glob("*.json"))}
    measured: dict[str, Measured] = {}
    compared: dict[str, dict[str, tuple[Score, Score]]] = {}
    for name, folder in chosen_takes(options.takes).items():
        if name not in FITTING or (options.keypoints and not (folder / KEYPOINTS).is_file()):
            continue
        print(f"{name} ...", file=sys.stderr, flush=True)
        trial, library = read_unposed(folder), libraries[FITTING[name]]
        if options.keypoints:
            compared[name] = compare(name, with_keypoints(trial, folder), library)
        else:
            measured[name] = measure(name, trial, library)
    if options.keypoints:
        if not compared:
            raise SystemExit(f"none of the takes has both {KEYPOINTS} and a fitting library")
        by_take = {
            name: {title: [asdict(score) for score in pair] for title, pair in found.items()}
            for name, found in compared.items()
        }
        write_results("matching_keypoints", keypoint_table(compared), json.dumps(by_take, indent=1))
        return 0
    if not measured:
        raise SystemExit("none of the takes has a fitting library")
    as_dictionaries = {name: asdict(one) for name, one in measured.items()}
    write_results("matching", accuracy_table(measured), json.dumps(as_dictionaries, indent=1))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
