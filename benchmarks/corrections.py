"""Corrections: what the motion found without posing gains from the most doubtful frames put right.

In the picture only, where every point is set where it truly is seen, or as a careful person sets it; and in
space. Lengths are the performer's, or the average ones of somebody as tall.

Usage: corrections.py [TAKE ...] [--keypoints] [--average] with names or folders of takes. See README.md.
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

from keymark.core.api import reconstruct  # noqa: E402
from keymark.core.arrays import Array  # noqa: E402
from keymark.core.body.actor import Actor  # noqa: E402
from keymark.core.body.kinematics import Body  # noqa: E402
from keymark.core.body.posture_fit import fit_posture  # noqa: E402
from keymark.core.poses.clip import pose_clip  # noqa: E402
from keymark.core.poses.found_poses import FoundPoses, with_found  # noqa: E402
from keymark.core.poses.picture_depth import put_right  # noqa: E402
from keymark.core.prior.keyframes import Keyframe  # noqa: E402
from keymark.core.prior.library import Library  # noqa: E402
from keymark.core.prior.registry import SHIPPED, find_libraries  # noqa: E402
from keymark.core.prior.texts import EVERY_LIBRARY  # noqa: E402
from keymark.core.progress import run  # noqa: E402
from keymark.core.session.stages import seen_in  # noqa: E402
from keymark.core.take.take import Take  # noqa: E402

COUNTS = (1, 2, 4, 10**6)
"""Numbers of frames corrected, the most doubtful first; the last stands for all keyframes."""
KINDS = ("picture", "by hand", "space")
CARE_M, SEED = 0.01, 7
"""How far from a joint a careful person drags a point, along each axis [m]."""


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
    careless = np.random.default_rng(SEED).normal(0.0, CARE_M, trial.truth.shape)
    for kind in KINDS:
        seen = trial.truth + careless if kind == "by hand" else trial.truth
        right = [
            in_space(trial, take, key)
            if kind == "space"
            else in_the_picture(take, key, seen[key.index], libraries, found.floor_m)
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
    take: Take, found: Keyframe, seen: Array, libraries: Sequence[Library], floor_m: float | None
) -> Keyframe:
    """A keyframe whose points are dragged to where they are seen, as the panel does it."""
    frame, body = found.index, take.body
    places = dict(zip(body.skeleton.point_names, seen, strict=True))
    sure = 0.0 if found.matched is None else found.matched.confidence
    posture = put_right(
        body, take.camera, frame, found.posture, found.posture, places, sure, libraries, floor_m
    )
    return Keyframe(frame, posture, depth_found=True)


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
    parser.add_argument("--average", action="store_true", help="use lengths that follow from the height")
    options = parser.parse_args(arguments)
    libraries = find_libraries(EVERY_LIBRARY, [SHIPPED])
    results = {}
    for name, trial in unposed_trials(options.takes, options.keypoints, plain=options.keypoints):
        if options.average:
            body = Body(Actor.from_stature(trial.take.body.actor.stature_m))
            trial = replace(trial, take=replace(trial.take, body=body))
        found = run(pose_clip(seen_in(replace(trial.take, keyframes=()), trial.reading), libraries))
        results[name] = measure(trial, found, libraries)
    as_dictionaries = {
        name: {column: asdict(error) for column, error in row.items()} for name, row in results.items()
    }
    file = "corrections" + "_keypoints" * options.keypoints + "_average" * options.average
    write_results(
        file,
        "Distance from the truth with the hips aligned / in place [mm] / travel of standing ankles "
        "[mm a frame].\n\n" + table(results),
        json.dumps(as_dictionaries, indent=1),
    )
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
