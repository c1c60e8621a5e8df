"""Corrections of found keyframes, the most doubtful first, until the motion is as good as with all posed.

Usage: posing_economy.py [TAKE ...] [--keypoints] with names or folders of takes. See README.md.
"""

import argparse
import json
import sys
import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace

import numpy as np
from keyframing import exact_postures, hand_posed
from takes import load_project, write_results
from trials import Trial, unposed_trials

load_project()

from keymark.core.body.posture import Posture  # noqa: E402
from keymark.core.library.library import Library  # noqa: E402
from keymark.core.library.registry import SHIPPED, find_libraries  # noqa: E402
from keymark.core.library.several_libraries import EVERY_LIBRARY  # noqa: E402
from keymark.core.posing.found_poses import with_found  # noqa: E402
from keymark.core.posing.pose_clip import pose_clip  # noqa: E402
from keymark.core.posing.section import section_around, take_around  # noqa: E402
from keymark.core.prior.keyframes import Keyframe  # noqa: E402
from keymark.core.progress import run  # noqa: E402
from keymark.core.review.score import Score  # noqa: E402
from keymark.core.take.take import Take  # noqa: E402

GOOD_RATIO = 1.2
"""Error relative to that with all keyframes posed within which a motion needs no more corrections."""
COLUMNS = (
    "frames", "keyframes", "doubtful", "found", "hips aligned", "coverage", "doubtful posed", "all posed",
    "corrections", "s to find", "s a correction",
)  # fmt: skip


@dataclass(frozen=True)
class Measured:
    """Errors [mm] of one take while its found keyframes are posed one after the other."""

    frames: int
    doubtful: int
    """Number of found keyframes that were doubtful before any correction."""
    scores: tuple[Score, ...]
    """By the number of corrections: of the motion without posed keyframes, to that with all posed."""
    first_sure: int
    """Number of corrections after which no doubtful keyframe was left for the first time."""
    finding_s: float
    """Process time of finding all keyframes, without reading the footage."""
    correcting_s: float
    """Mean process time of finding those around a corrected one anew."""

    @property
    def corrections(self) -> int:
        """Number of corrections from which on the error stays within `GOOD_RATIO` of that with all posed."""
        limit = GOOD_RATIO * self.scores[-1].mpjpe
        beyond = [count for count, score in enumerate(self.scores) if score.mpjpe > limit]
        return beyond[-1] + 1 if beyond else 0


def measure(trial: Trial, libraries: Sequence[Library]) -> Measured:
    """Find keyframes, then pose them as by hand, the most doubtful first, each improving those around it."""
    posed = hand_posed(trial, exact_postures(trial))
    begun = time.process_time()
    found = run(pose_clip(trial.take, trial.reading, libraries))
    finding_s = time.process_time() - begun
    take = with_found(trial.take, found)
    trial = replace(trial, unscored=take.keyframe_indices)
    scores, doubtful, correcting_s = [score(trial, take)], [doubtful_in(take)], []
    while any(keyframe.matched is not None for keyframe in take.keyframes):
        index = least_sure(take)
        take = corrected(take, index, posed)
        begun = time.process_time()
        take = improved(take, index, trial, libraries, found.floor_m)
        correcting_s.append(time.process_time() - begun)
        scores.append(score(trial, take))
        doubtful.append(doubtful_in(take))
    frames = len(trial.truth)
    mean_s = float(np.mean(correcting_s))
    return Measured(frames, doubtful[0], tuple(scores), doubtful.index(0), finding_s, mean_s)


def score(trial: Trial, take: Take) -> Score:
    """Score of the default method's motion over all frames that are no keyframes."""
    motion = replace(trial, take=take).estimated("map")
    return trial.score(motion.points, motion.sigma_m)


def doubtful_in(take: Take) -> int:
    """Number of doubtful keyframes."""
    return sum(keyframe.matched is not None and keyframe.matched.is_doubtful for keyframe in take.keyframes)


def least_sure(take: Take) -> int:
    """Frame of the found keyframe of the least confidence, the earliest of several."""
    found = [(keyframe.matched.confidence, keyframe.index) for keyframe in take.keyframes if keyframe.matched]
    return min(found)[1]


def corrected(take: Take, index: int, posed: Posture) -> Take:
    """The take with one keyframe posed by hand."""
    keyframes = (Keyframe(index, posed[index]) if one.index == index else one for one in take.keyframes)
    return replace(take, keyframes=tuple(keyframes))


def improved(take: Take, index: int, trial: Trial, libraries: Sequence[Library], floor_m: float) -> Take:
    """The take with those around a corrected keyframe found anew, as *Improve Neighbors* does it."""
    section = section_around(trial.tracks.time_s, index, take.keyframes)
    if not section.changed:
        return take
    ends = section.first, section.last
    around = take_around(take, section)
    job = pose_clip(around, trial.reading, libraries, floor_m, between=ends, frames=section.changed)
    found = run(job)
    anew = {frame.index: found.keyframe(frame) for frame in found.frames}
    keyframes = (anew.get(one.index, one) if one.matched is not None else one for one in take.keyframes)
    return replace(take, keyframes=tuple(keyframes))


def table(takes: dict[str, Measured]) -> str:
    """The results as Markdown, with their mean and median."""
    lines = [
        "Mean distance from the truth [mm] of the motion, frames of keyframes left out: all of them found, "
        "the doubtful ones posed by hand, all posed by hand; and the corrections, the most doubtful first, "
        f"until it is within {GOOD_RATIO:g} times the last.",
        "",
        "| take | " + " | ".join(COLUMNS) + " |",
        "|---" + "|---:" * len(COLUMNS) + "|",
    ]
    rows = {name: _cells(found) for name, found in takes.items()}
    values = list(rows.values())
    rows |= {"**mean**": np.mean(values, axis=0).tolist(), "**median**": np.median(values, axis=0).tolist()}
    digits = (0, 1, 1, 1, 1, 2, 1, 1, 1, 1, 1)
    for name, row in rows.items():
        shown = (f"{value:.{count}f}" for value, count in zip(row, digits, strict=True))
        lines.append(f"| {name} | " + " | ".join(shown) + " |")
    return "\n".join(lines)


def _cells(found: Measured) -> list[float]:
    first, last = found.scores[0], found.scores[-1]
    return [
        found.frames, len(found.scores) - 1, found.doubtful, first.mpjpe, first.rooted,
        first.coverage95 or 0.0, found.scores[found.first_sure].mpjpe, last.mpjpe, found.corrections,
        found.finding_s, found.correcting_s,
    ]  # fmt: skip


def main(arguments: list[str]) -> int:
    """Measure, print and write the results."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("takes", nargs="*", metavar="TAKE", help="names or folders of takes with truth")
    parser.add_argument(
        "--keypoints", action="store_true", help="with a detector's keypoints beside the markers, where any"
    )
    options = parser.parse_args(arguments)
    libraries = find_libraries(EVERY_LIBRARY, [SHIPPED])
    trials = unposed_trials(options.takes, options.keypoints)
    takes = {name: measure(trial, libraries) for name, trial in trials}
    results = {name: {**asdict(found), "corrections": found.corrections} for name, found in takes.items()}
    name = "posing_economy_keypoints" if options.keypoints else "posing_economy"
    write_results(name, table(takes), json.dumps(results, indent=1))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
