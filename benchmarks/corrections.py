"""Corrections: what the motion found without posing gains from the most doubtful frames put right.

In the picture only, where every point is seen where it truly is and keeps the depth that was found; and in
space.

Usage: corrections.py [TAKE ...] [--keypoints] with names or folders of takes. See README.md.
"""

import argparse
import json
import sys
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace

import numpy as np
from takes import load_project, write_results
from trials import Trial, unposed_trials

load_project()

from keymark.core.body.posture_fit import fit_posture  # noqa: E402
from keymark.core.estimate.reconstruct import reconstruct  # noqa: E402
from keymark.core.posing.found_poses import FoundPoses, with_found  # noqa: E402
from keymark.core.posing.picture_depth import seen_at, with_likely_depth  # noqa: E402
from keymark.core.posing.pose_clip import pose_clip  # noqa: E402
from keymark.core.prior.keyframes import Keyframe  # noqa: E402
from keymark.core.prior.library import Library  # noqa: E402
from keymark.core.prior.registry import SHIPPED, find_libraries  # noqa: E402
from keymark.core.prior.texts import EVERY_LIBRARY  # noqa: E402
from keymark.core.progress import run  # noqa: E402
from keymark.core.take.take import Take  # noqa: E402

COUNTS = (1, 2, 4, 10**6)
"""Numbers of frames corrected, the most doubtful first; the last stands for all keyframes."""
KINDS = ("picture", "space")


@dataclass(frozen=True)
class Error:
    """Errors of a motion."""

    rooted: float  # mean distance from the truth with the hips aligned [mm]
    mpjpe: float  # the same in place [mm]
    skate: float  # travel of ankles that stand [mm per frame]


def measure(trial: Trial, found: FoundPoses, libraries: Sequence[Library]) -> dict[str, Error]:
    """Errors as found, and after every number of corrections of each kind."""
    take = with_found(replace(trial.take, keyframes=()), found)
    doubtful = sorted(take.keyframes, key=lambda key: 0.0 if key.matched is None else key.matched.confidence)
    measured = {"found": error_of(trial, take)}
    for kind in KINDS:
        right = [
            in_the_picture(trial, take, key, libraries, found.floor_m)
            if kind == "picture"
            else in_space(trial, take, key)
            for key in doubtful
        ]
        for count in COUNTS:
            keyframes = sorted([*right[:count], *doubtful[count:]], key=lambda key: key.index)
            measured[f"{kind} {named(count)}"] = error_of(trial, replace(take, keyframes=tuple(keyframes)))
    return measured


def error_of(trial: Trial, take: Take) -> Error:
    """Errors of the default method's motion over all frames."""
    motion = run(reconstruct(take, "map", trial.reading)).motion
    score = trial.score(motion.points, motion.sigma_m)
    return Error(score.rooted, score.mpjpe_all, score.skate or 0.0)


def in_the_picture(
    trial: Trial, take: Take, found: Keyframe, libraries: Sequence[Library], floor_m: float | None
) -> Keyframe:
    """A keyframe whose points are dragged to where they are seen; lengths stay, so depths give way.

    As the panel does it, its depth is then the likeliest one.
    """
    frame, camera = found.index, take.camera
    posture = seen_at(take.body, camera, frame, found.posture, trial.truth[frame])
    sure = 0.0 if found.matched is None else found.matched.confidence
    likely = with_likely_depth(take.body, camera, frame, posture, found.posture, sure, libraries, floor_m)
    return Keyframe(frame, likely, depth_found=True)


def in_space(trial: Trial, take: Take, found: Keyframe) -> Keyframe:
    """A keyframe posed as in truth."""
    return Keyframe(found.index, fit_posture(take.body, trial.truth[[found.index]]).posture[0])


def named(count: int) -> str:
    """A number of corrected frames."""
    return "all" if count == COUNTS[-1] else str(count)


def table(results: Mapping[str, Mapping[str, Error]]) -> str:
    """Errors with the hips aligned / in place / skate, and how they changed."""
    columns = list(next(iter(results.values())))
    lines = ["| take | " + " | ".join(columns) + " |", "|---" + "|---:" * len(columns) + "|"]
    for name, row in results.items():
        cells = (f"{each.rooted:.0f} / {each.mpjpe:.0f} / {each.skate:.1f}" for each in row.values())
        lines.append(f"| {name} | {' | '.join(cells)} |")
    ratios = {
        column: [
            [
                getattr(row[column], field) / max(getattr(row["found"], field), 1e-9)
                for row in results.values()
            ]
            for field in ("rooted", "mpjpe", "skate")
        ]
        for column in columns
    }
    for title, chosen in (("median", np.median), ("worst", np.max)):
        cells = (" / ".join(f"{100.0 * (chosen(part) - 1.0):+.0f} %" for part in ratios[c]) for c in columns)
        lines.append(f"| **{title} change** | {' | '.join(cells)} |")
    return "\n".join(lines)


def main(arguments: Sequence[str]) -> int:
    """Measure, print and write the results."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("takes", nargs="*", metavar="TAKE", help="names or folders of takes with truth")
    parser.add_argument(
        "--keypoints", action="store_true", help="hold takes against a detector's keypoints as well"
    )
    options = parser.parse_args(arguments)
    libraries = find_libraries(EVERY_LIBRARY, [SHIPPED])
    results = {}
    for name, trial in unposed_trials(options.takes, options.keypoints, plain=options.keypoints):
        found = run(pose_clip(replace(trial.take, keyframes=()), trial.reading, libraries))
        results[name] = measure(trial, found, libraries)
    as_dictionaries = {
        name: {column: asdict(error) for column, error in row.items()} for name, row in results.items()
    }
    file = "corrections_keypoints" if options.keypoints else "corrections"
    write_results(
        file,
        "Distance from the truth with the hips aligned / in place [mm] / travel of standing ankles "
        "[mm a frame].\n\n" + table(results),
        json.dumps(as_dictionaries, indent=1),
    )
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
