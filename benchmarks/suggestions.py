"""Suggested keyframes: the gain of one at a suggested frame, and the calibration of confidence.

Usage: suggestions.py [TAKE ...] with names or folders of takes; by default all found. See README.md.
"""

import argparse
import json
import sys
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from keyframing import exact_postures, hand_posed, keyed, random_source, spread_frames
from scipy.stats import spearmanr
from takes import GROUPS, chosen_takes, group_of, load_project, write_results
from trials import Trial, read_trial

load_project()

from keymark.core.arrays import IndexArray  # noqa: E402
from keymark.core.body.posture import Posture  # noqa: E402
from keymark.core.estimate.reconstruct import reconstruct  # noqa: E402
from keymark.core.progress import run  # noqa: E402
from keymark.core.review.confidence import TOLERANCE_SHARE  # noqa: E402
from keymark.core.review.review import review  # noqa: E402
from keymark.core.review.weak_frames import NEAREST_FRAMES  # noqa: E402

PER_100_FRAMES = (4, 8)
"""Sparse keyframes, where another helps much, and nearly those of a finished take."""
RANDOM_FRAMES = 3
"""Number of random frames averaged."""
PLACES = ("suggested", "widest gap", "random")
BINS = (0.0, 0.5, 0.7, 0.85, 1.0)
"""Bounds of the confidence bins."""


@dataclass(frozen=True, eq=False)
class Judged:
    """Claims of a reconstruction and their true values."""

    error_mm: float
    """Mean over all frames and points before another keyframe."""
    gains_mm: dict[str, float]
    """Decrease of that error by one more keyframe, by choice of frame; 0 where none is suggested."""
    suggested: int
    """Number of frames suggested for a keyframe."""
    rank: float
    """Rank correlation of doubt (1 - confidence) with error over the frames that are not keyframes."""
    confidence: list[float]
    """Confidence in each of these frames."""
    within: list[float]
    """Share of each frame's points that truly lie within the tolerance."""


def measure(folder: Path) -> dict[int, Judged]:
    """Judge a take for each number of keyframes per 100 frames."""
    trial = read_trial(folder)
    postures = hand_posed(trial, exact_postures(trial))
    counts = {density: max(2, round(len(trial.truth) * density / 100.0)) for density in PER_100_FRAMES}
    return {density: judge(trial, postures, count) for density, count in counts.items()}


def judge(trial: Trial, postures: Posture, count: int) -> Judged:
    """Judge the trial with keyframes at the proposed frames, and with one more."""
    frames = spread_frames(trial, count, snap=True)
    posed = keyed(trial, postures, frames)
    reconstruction = run(reconstruct(posed.take, "map", trial.reading))
    judged = run(review(posed.take, reconstruction, np.arange(len(trial.truth), dtype=np.float64)))
    distance = np.linalg.norm(reconstruction.motion.points - trial.truth, axis=-1)
    before = float(distance.mean())
    free = np.setdiff1d(np.arange(len(distance)), frames)
    tolerance_m = TOLERANCE_SHARE * trial.take.body.actor.stature_m
    gains = {
        place: float(np.mean([before - error_with(trial, postures, frames, index) for index in at]))
        if len(at)
        else 0.0
        for place, at in {
            "suggested": [weak.index for weak in judged.weak_frames[:1]],
            "widest gap": [middle_of_widest_gap(frames)],
            "random": random_frames(trial, frames),
        }.items()
    }
    doubt = 1.0 - judged.confidence[free]
    return Judged(
        1e3 * before,
        {place: 1e3 * gain for place, gain in gains.items()},
        len(judged.weak_frames),
        float(spearmanr(doubt, distance[free].mean(axis=1)).statistic),
        judged.confidence[free].tolist(),
        (distance[free] <= tolerance_m).mean(axis=1).tolist(),
    )


def error_with(trial: Trial, postures: Posture, frames: IndexArray, index: int) -> float:
    """Mean error [m] over all frames and points with one keyframe more."""
    more = keyed(trial, postures, np.union1d(frames, [index]))
    return float(np.linalg.norm(more.estimated("map").points - trial.truth, axis=-1).mean())


def middle_of_widest_gap(frames: IndexArray) -> int:
    """The frame in the middle of the first of the widest gaps."""
    widest = int(np.diff(frames).argmax())
    return int(frames[widest] + frames[widest + 1]) // 2


def random_frames(trial: Trial, frames: IndexArray) -> list[int]:
    """Random frames no nearer to a keyframe than suggested ones may be, as far as any exist."""
    every = np.arange(len(trial.truth))
    distance = np.abs(every[:, None] - frames).min(axis=1)
    far = every[distance >= min(NEAREST_FRAMES, int(distance.max()))]
    return random_source(trial).choice(far, min(RANDOM_FRAMES, len(far)), replace=False).tolist()


def gain_table(takes: dict[str, dict[int, Judged]], groups: dict[str, list[str]]) -> str:
    """Gains and ranks as Markdown, by take and then by group."""
    lines = [
        "By how much one keyframe more lowers the mean error [mm], by where it is posed; frames named; rank "
        "correlation of doubt and error.",
        "",
        "| take | per 100 frames | error | " + " | ".join(PLACES) + " | named | rank |",
        "|---" + "|---:" * (len(PLACES) + 4) + "|",
    ]
    rows = [(name, [found]) for name, found in takes.items()]
    rows += [(f"**{group}**", [takes[name] for name in names]) for group, names in groups.items()]
    for name, several in rows:
        for density in PER_100_FRAMES:
            chosen = [found[density] for found in several]
            values = [np.mean([one.error_mm for one in chosen])]
            values += [np.mean([one.gains_mm[place] for one in chosen]) for place in PLACES]
            cells = [f"{density}", *(f"{value:.1f}" for value in values)]
            cells += [f"{np.mean([one.suggested for one in chosen]):.1f}"]
            cells += [f"{np.mean([one.rank for one in chosen]):.2f}"]
            lines.append(f"| {name} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def calibration(judged: list[Judged]) -> list[tuple[int, float, float]]:
    """Frames, mean confidence and mean true share of each confidence bin."""
    claimed = np.concatenate([one.confidence for one in judged])
    true = np.concatenate([one.within for one in judged])
    stretch = np.digitize(claimed, BINS[1:-1])
    return [
        (int(inside.sum()), float(claimed[inside].mean()), float(true[inside].mean()))
        if (inside := stretch == number).any()
        else (0, float("nan"), float("nan"))
        for number in range(len(BINS) - 1)
    ]


def calibration_table(groups: dict[str, list[Judged]]) -> str:
    """Claimed confidence and true share by group, as Markdown."""
    titles = [f"{low:g} to {high:g}" for low, high in zip(BINS[:-1], BINS[1:], strict=True)]
    lines = [
        f"Share of points within {100 * TOLERANCE_SHARE:g} % of the stature, claimed / true (frames), by "
        "what is claimed of a frame.",
        "",
        "| takes | " + " | ".join(titles) + " | all |",
        "|---" + "|---:" * (len(titles) + 1) + "|",
    ]
    for group, judged in groups.items():
        cells = [
            f"{claimed:.2f} / {true:.2f} ({frames})" if frames else ""
            for frames, claimed, true in calibration(judged)
        ]
        claimed, true = (np.concatenate([getattr(one, key) for one in judged]).mean() for key in MEASURED)
        lines.append(f"| {group} | " + " | ".join(cells) + f" | {claimed:.2f} / {true:.2f} |")
    return "\n".join(lines)


MEASURED = ("confidence", "within")


def main(arguments: list[str]) -> int:
    """Measure, print and write the results."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("takes", nargs="*", metavar="TAKE", help="names or folders of takes with truth")
    takes: dict[str, dict[int, Judged]] = {}
    members: dict[str, list[str]] = {group: [] for group in GROUPS}
    for name, folder in chosen_takes(parser.parse_args(arguments).takes).items():
        print(f"{name} ...", file=sys.stderr, flush=True)
        takes[name] = measure(folder)
        members[group_of(folder)].append(name)
    groups = {group: names for group, names in members.items() if names}
    judged = {
        group: [one for name in names for one in takes[name].values()] for group, names in groups.items()
    }
    tables = f"{gain_table(takes, groups)}\n\n{calibration_table(judged)}"
    as_dictionaries: dict[str, Any] = {
        name: {density: asdict(one) for density, one in found.items()} for name, found in takes.items()
    }
    write_results("suggestions", tables, json.dumps(as_dictionaries, indent=1))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
