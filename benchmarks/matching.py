"""Keyframe libraries: accuracy without posed keyframes, and with two, by markers and by keypoints.

Usage: matching.py [TAKE ...] [--choose | --keypoints] with names or folders of takes. See README.md.
"""

import argparse
import json
import sys
import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from keyframing import exact_postures
from takes import chosen_takes, load_project, write_results

load_project()

from keymark.core.estimate.reconstruct import reconstruct  # noqa: E402
from keymark.core.footage.keypoints.keypoint_file import read_keypoints  # noqa: E402
from keymark.core.footage.reading import Reading  # noqa: E402
from keymark.core.library.library import Library  # noqa: E402
from keymark.core.library.library_file import read_library  # noqa: E402
from keymark.core.library.registry import SHIPPED  # noqa: E402
from keymark.core.matching.match_take import LibraryChoice, match_take, with_matches  # noqa: E402
from keymark.core.prior.keyframes import Keyframe  # noqa: E402
from keymark.core.progress import run  # noqa: E402
from keymark.core.review.score import Score, read_truth  # noqa: E402
from keymark.core.take import evidence_kinds as kinds  # noqa: E402
from keymark.core.take.evidence import with_evidence  # noqa: E402
from keymark.core.take.read_footage import read_footage  # noqa: E402
from keymark.core.take.take import Take  # noqa: E402
from keymark.core.take.take_file import read_take  # noqa: E402
from trials import Trial  # noqa: E402

FITTING: dict[str, tuple[str, ...]] = {
    "walk": ("walking",),
    "reach": ("reaching",),
    "aerobic": ("aerobic",),
    "demo/aerobic": ("aerobic",),
    "real_balance": ("balance",),
    "stroll": ("walking", "waving"),
    "jog": ("running",),
    "jump": ("jumping",),
    "kick": ("kicking",),
    "box": ("punching",),
    "lift": ("squatting_lifting",),
    "spin": ("turning",),
    "star_jumps": ("aerobic", "jumping"),
}
"""Fitting libraries by take: the first is measured, any is a right choice. Other takes fit none."""
ON_THE_FLOOR = 0.0
RAISED = ("real_balance",)
"""Takes whose performer stands on something other than the floor z = 0; their floor is not given."""
NONE = "none"
KEYPOINTS = "keypoints_mediapipe.json"
"""File of a detector's keypoints in a take's folder, for `--keypoints`."""
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


@dataclass(frozen=True)
class Chosen:
    """The choice of `auto` for a take."""

    ranking: tuple[tuple[str, float], ...]
    chosen: str
    right: bool | None
    """Whether the choice is right; None where no shipped library fits and none was chosen."""
    reason: str
    matching_ms: float


def read_unposed(folder: Path) -> Trial:
    """A take read without its keyframes, which then do not guide the tracking of markers either."""
    take = replace(read_take(folder), keyframes=())
    reading = run(read_footage(take))
    return Trial(
        take, reading, read_truth(folder / "truth.json", take.frame_start, reading.tracks.frame_count), ()
    )


def matched(
    name: str, take: Take, reading: Reading, libraries: Sequence[Library]
) -> tuple[LibraryChoice, float]:
    """The match, and its process time [ms a frame]."""
    begun = time.process_time()
    choice = run(match_take(take, reading, libraries, None if name in RAISED else ON_THE_FLOOR))
    return choice, 1e3 * (time.process_time() - begun) / reading.tracks.frame_count


def measure(name: str, trial: Trial, library: Library) -> Measured:
    """Measure a take with one library: without posed keyframes, and with the first and the last frame."""
    choice, matching_ms = matched(name, trial.take, trial.reading, [library])
    match = choice.match
    if match is None:
        raise RuntimeError(f"{library.identifier}, the only one, was not matched with {name}")
    if choice.reading is not None:
        trial = replace(trial, reading=choice.reading)
    body = trial.take.body
    unposed = replace(trial, take=with_matches(trial.take, match))
    ends = (0, len(trial.truth) - 1)
    exact = exact_postures(trial)
    posed = tuple(Keyframe(index, exact[index]) for index in ends)
    two = replace(trial, take=replace(trial.take, keyframes=posed), unscored=ends)
    known, _ = matched(name, two.take, trial.reading, [library])  # posed keyframes constrain the match
    both = replace(two, take=with_matches(two.take, known.match or match))
    if known.reading is not None:
        both = replace(both, reading=known.reading)
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
        choice, _ = matched(name, take, held.reading, [library])
        if choice.match is None:
            raise RuntimeError(f"{library.identifier}, the only one, was not matched with {name}")
        held = replace(held, take=with_matches(take, choice.match), reading=choice.reading or held.reading)
        points = take.body.points(take.body.pose(choice.match.postures))
        found[title] = held.score(points), estimated(held)
    return found


def with_keypoints(trial: Trial, folder: Path) -> Trial:
    """The same take with the keypoints in its folder."""
    take, tracks = trial.take, trial.reading.tracks
    people = read_keypoints(folder / KEYPOINTS, tracks.frame_count, tracks.size, take.fps, take.frame_start)
    return replace(trial, take=replace(take, keypoints=(people,)))


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


def choose(name: str, trial: Trial, libraries: Sequence[Library]) -> Chosen:
    """Run the choice of `auto` on a take."""
    choice, matching_ms = matched(name, trial.take, trial.reading, libraries)
    ranking = tuple((library.identifier, round(share, 4)) for library, share in choice.ranking)
    taken = NONE if choice.match is None else choice.match.library.identifier
    return Chosen(ranking, taken, is_right(name, taken), choice.reason, matching_ms)


def is_right(name: str, chosen: str) -> bool | None:
    """Whether the chosen library fits the take; None where no shipped one does and none was chosen."""
    if name in FITTING:
        return chosen in FITTING[name]
    return None if chosen == NONE else False


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


def choice_table(results: dict[str, Chosen]) -> str:
    """The choices as Markdown."""
    lines = [
        "The library chosen among all that are shipped.",
        "",
        "| take | shows | chosen | likeliest | next | ms a frame |",
        "|---|---|---|---|---|---:|",
    ]
    for name, found in results.items():
        shown = [f"{identifier} {share:.2f}" for identifier, share in found.ranking[:2]]
        mark = {True: "", False: " (wrong)", None: ""}[found.right]
        lines.append(
            f"| {name} | {' or '.join(FITTING.get(name, (NONE,)))} | {found.chosen}{mark} | "
            + " | ".join(shown)
            + f" | {found.matching_ms:.1f} |"
        )
    return "\n".join(lines)


def main(arguments: list[str]) -> int:
    """Measure, print and write the results."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("takes", nargs="*", metavar="TAKE", help="names or folders of takes with truth")
    parser.add_argument("--choose", action="store_true", help="only see which library is chosen")
    parser.add_argument(
        "--keypoints", action="store_true", help="compare evidence on takes with a detector's keypoints"
    )
    options = parser.parse_args(arguments)
    libraries = {path.stem: read_library(path) for path in sorted(SHIPPED.glob("*.json"))}
    measured: dict[str, Measured] = {}
    chosen: dict[str, Chosen] = {}
    compared: dict[str, dict[str, tuple[Score, Score]]] = {}
    for name, folder in chosen_takes(options.takes).items():
        print(f"{name} ...", file=sys.stderr, flush=True)
        trial = read_unposed(folder)
        if options.keypoints:
            if name in FITTING and (folder / KEYPOINTS).is_file():
                compared[name] = compare(name, with_keypoints(trial, folder), libraries[FITTING[name][0]])
            continue
        chosen[name] = choose(name, trial, list(libraries.values()))
        if name in FITTING and not options.choose:
            measured[name] = measure(name, trial, libraries[FITTING[name][0]])
    if options.keypoints:
        if not compared:
            raise SystemExit(f"none of the takes has both {KEYPOINTS} and a fitting library")
        by_take = {
            name: {title: [asdict(score) for score in pair] for title, pair in found.items()}
            for name, found in compared.items()
        }
        write_results("matching_keypoints", keypoint_table(compared), json.dumps(by_take, indent=1))
        return 0
    tables = choice_table(chosen)
    if measured:
        tables = f"{accuracy_table(measured)}\n\n{tables}"
    as_dictionaries: dict[str, Any] = {
        "accuracy": {name: asdict(one) for name, one in measured.items()},
        "choice": {name: asdict(one) for name, one in chosen.items()},
    }
    write_results("matching", tables, json.dumps(as_dictionaries, indent=1))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
