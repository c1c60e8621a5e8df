"""Cost of wrong input: errors of interpolation and of `map`, with one error in the input at a time.

Usage: sensitivity.py [TAKE ...] with names or folders of takes. See README.md beside this file.
"""

import argparse
import json
import sys
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from keyframing import exact_postures, hand_posed, keyed, random_source
from mistakes import doubled_speed, hidden, mistimed, posed_through_lens, with_lens, with_segments
from takes import chosen_takes, write_results
from trials import Trial, read_trial

POSING_M = (0.012, 0.025, 0.050)
SHIFTS = (1, 2)
LENSES = (0.9, 1.1)
SEGMENTS = (0.95, 1.05)
HIDDEN_FRAMES = 15
PART = "-"
"""Prefix of rows whose errors are those of a few frames."""
MEASURES = ("mpjpe", "rooted")
METHODS = ("interpolation", "map")

Errors = dict[str, dict[str, float]]
"""Errors [mm] by measure and method."""


@dataclass(frozen=True, eq=False)
class Row:
    """An error of the input, and the trials whose mean is in the table."""

    wrong: str
    trials: tuple[Trial, ...]


def rows_of(trial: Trial) -> Iterator[Row]:
    """All rows of one take."""
    yield Row("nothing", (trial,))
    exact = exact_postures(trial)
    for rms_m in POSING_M:
        posed = keyed(trial, hand_posed(trial, exact, rms_m), trial.take.keyframe_indices)
        yield Row(f"posing error of {1e3 * rms_m:.0f} mm", (posed,))
    yield from _timing(trial)
    for factor in LENSES:
        share = _percent(factor)
        yield Row(f"focal length {share}, keyframes in place", (with_lens(trial, factor),))
        yield Row(f"focal length {share}, posed over it", (posed_through_lens(trial, factor),))
    yield from _segments(trial)
    yield from _markers(trial)
    yield Row("speed doubled, same keyframes", (doubled_speed(trial),))
    yield Row("speed doubled, half the keyframes", (doubled_speed(trial, every_keyframe=2),))


def _timing(trial: Trial) -> Iterator[Row]:
    count, random = len(trial.take.keyframes), random_source(trial)
    signs = random.choice((-1, 1), count)
    for shift in SHIFTS:
        frames = "1 frame" if shift == 1 else f"{shift} frames"
        yield Row(f"each keyframe {frames} early or late", (mistimed(trial, shift * signs),))
        both = tuple(mistimed(trial, np.full(count, way * shift)) for way in (-1, 1))
        yield Row(f"all keyframes {frames} early, all late", both)


def _segments(trial: Trial) -> Iterator[Row]:
    names, random = tuple(trial.take.body.actor.segments_m), random_source(trial)
    for factor in SEGMENTS:
        alike = with_segments(trial, dict.fromkeys(names, factor))
        yield Row(f"all segments {_percent(factor)}", (alike,))
    each = dict(zip(names, random.choice(SEGMENTS, len(names)), strict=True))
    yield Row(f"each segment +-{_percent(SEGMENTS[1])[1:]}", (with_segments(trial, each),))


def _markers(trial: Trial) -> Iterator[Row]:
    frames, markers = len(trial.truth), range(len(trial.tracks.names))
    first = (frames - HIDDEN_FRAMES) // 2
    gap = slice(first, first + HIDDEN_FRAMES)
    outside = set(range(frames)) - set(range(frames)[gap])
    there = tuple(sorted(outside | set(trial.unscored)))
    short = tuple(hidden(trial, marker, gap) for marker in markers)
    yield Row(f"a marker hidden for {HIDDEN_FRAMES} frames", short)
    yield Row(f"{PART} in these frames alone", tuple(replace(one, unscored=there) for one in short))
    yield Row(f"{PART} there, with nothing hidden", (replace(trial, unscored=there),))
    yield Row("a marker hidden in all frames", tuple(hidden(trial, m, slice(None)) for m in markers))


def _percent(factor: float) -> str:
    return f"{100.0 * (factor - 1.0):+.0f} %"


def errors_of(trials: tuple[Trial, ...]) -> Errors:
    """Mean errors of some trials."""
    found: dict[str, list[dict[str, float | None]]] = {method: [] for method in METHODS}
    for trial in trials:
        found["interpolation"].append(trial.best_interpolation().to_dict())
        found["map"].append(trial.score(trial.estimated("map").points).to_dict())
    return {
        measure: {method: float(np.mean([one[measure] for one in found[method]])) for method in METHODS}
        for measure in MEASURES
    }


def mean_of(takes: dict[str, dict[str, Errors]]) -> dict[str, Errors]:
    """The mean over takes, each counting the same."""
    names = next(iter(takes.values()))
    return {
        row: {
            measure: {
                method: float(np.mean([errors[row][measure][method] for errors in takes.values()]))
                for method in METHODS
            }
            for measure in MEASURES
        }
        for row in names
    }


def table(mean: dict[str, Errors], takes: dict[str, dict[str, Errors]]) -> str:
    """The mean of all takes as Markdown, and each take's own `map` beside it."""
    first = mean["nothing"]["mpjpe"]["map"]
    titles = ["what is wrong", "interpolation", "map", "more", "rooted: interpolation", "rooted: map", *takes]
    lines = [
        f"Mean error [mm] of {len(takes)} takes; to the right, the mpjpe of map on each.",
        "",
        "| " + " | ".join(titles) + " |",
        "|---" + "|---:" * (len(titles) - 1) + "|",
    ]
    for row, errors in mean.items():
        values = [*(errors["mpjpe"][method] for method in METHODS)]
        more = "" if row.startswith(PART) else f"{errors['mpjpe']['map'] - first:+.1f}"
        cells = [row, *(f"{value:.1f}" for value in values), more]
        cells += [f"{errors['rooted'][method]:.1f}" for method in METHODS]
        cells += [f"{found[row]['mpjpe']['map']:.1f}" for found in takes.values()]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)


def main(arguments: list[str]) -> int:
    """Measure, print and write the results."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("takes", nargs="*", metavar="TAKE", help="names or folders of takes with truth")
    takes: dict[str, dict[str, Errors]] = {}
    for name, folder in chosen_takes(parser.parse_args(arguments).takes).items():
        print(f"{name} ...", file=sys.stderr, flush=True)
        takes[name] = {row.wrong: errors_of(row.trials) for row in rows_of(read_trial(folder))}
    mean = mean_of(takes)
    write_results("sensitivity", table(mean, takes), json.dumps({**takes, "**mean**": mean}, indent=1))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
