"""No posing at all: accuracy of the keyframes that are found, and of the motion that follows from them.

Usage: posing_all.py [TAKE ...] [--keypoints] with names or folders of takes. See README.md.
"""

import argparse
import json
import sys
import time
from dataclasses import asdict, dataclass, replace

import numpy as np
from takes import chosen_takes, load_project, write_results
from trials import KEYPOINTS, Trial, read_unposed, with_keypoints

load_project()

from keymark.core.body.human import HUMAN  # noqa: E402
from keymark.core.estimate.reconstruct import reconstruct  # noqa: E402
from keymark.core.library.library import Library  # noqa: E402
from keymark.core.library.registry import SHIPPED, find_libraries  # noqa: E402
from keymark.core.library.several_libraries import EVERY_LIBRARY  # noqa: E402
from keymark.core.posing.found_poses import with_found  # noqa: E402
from keymark.core.posing.pose_clip import pose_clip  # noqa: E402
from keymark.core.progress import run  # noqa: E402

WRONG_SIDE_M = 0.15
"""A limb's end this much off in depth beside its own root, and nearer to its mirror image in depth."""
LIMBS = tuple((f"{root}.{side}", f"{end}.{side}") for side in "LR" for root, end in
              (("shoulder", "elbow"), ("elbow", "wrist"), ("hip", "knee"), ("knee", "ankle")))  # fmt: skip
COLUMNS = (
    "found, hips aligned", "found", "motion, hips aligned", "motion", "coverage", "wrong depth side",
    "confidence", "within 100 mm", "s a 100 frames",
)  # fmt: skip


@dataclass(frozen=True)
class Measured:
    """Errors [mm] of one take that nobody posed."""

    found_rooted: float
    """Mean over the found keyframes, the hips aligned."""
    found: float
    rooted: float
    """Mean over the frames of the motion of method `map`, the hips aligned."""
    mpjpe: float
    coverage: float
    wrong_side: float
    """Share of limbs' segments that lean away from the camera instead of toward it or the other way round."""
    confidence: float
    """Mean of the chosen candidates'."""
    right: float
    """Share of found keyframes within 100 mm, the hips aligned: what the confidence should be."""
    seconds: float
    """Process time of posing 100 frames."""


def measure(trial: Trial, libraries: tuple[Library, ...]) -> Measured:
    """Pose a take without a person, and reconstruct it."""
    take, truth = replace(trial.take, keyframes=()), trial.truth
    begun = time.process_time()
    found = run(pose_clip(take, trial.reading, libraries))
    seconds = 100.0 * (time.process_time() - begun) / len(truth)
    index = [frame.index for frame in found.frames]
    points = take.body.points(take.body.pose(found.postures))[index]
    off = points - truth[index]
    hips = [HUMAN.point_names.index(f"hip.{side}") for side in "LR"]
    rooted = np.linalg.norm(off - off[:, hips].mean(axis=1, keepdims=True), axis=-1).mean(axis=1)
    motion = run(reconstruct(with_found(take, found), "map", found.reading or trial.reading)).motion
    score = replace(trial, unscored=()).score(motion.points, motion.sigma_m)
    return Measured(
        1e3 * float(rooted.mean()),
        1e3 * float(np.linalg.norm(off, axis=-1).mean()),
        score.rooted,
        score.mpjpe,
        score.coverage95 or 0.0,
        _wrong_side(trial, motion.points),
        float(np.mean([frame.candidates[0].confidence for frame in found.frames])),
        float((rooted < 0.1).mean()),
        seconds,
    )


def _wrong_side(trial: Trial, points: np.ndarray) -> float:
    """Share of segments that lean the wrong way in depth, of those that truly lean and are clearly off."""
    frame = np.arange(len(points))
    sight = trial.take.camera.sight(trial.truth.mean(axis=1), frame)
    wrong = []
    for root, end in LIMBS:
        pair = [HUMAN.point_names.index(name) for name in (end, root)]
        true, seen = (np.einsum("fi,fi->f", np.subtract(*each[:, pair].swapaxes(0, 1)), sight)
                      for each in (trial.truth, points))  # fmt: skip
        wrong.append((np.abs(true - seen) > WRONG_SIDE_M) & (np.abs(true + seen) < np.abs(true - seen)))
    return float(np.mean(wrong))


def table(results: dict[str, Measured]) -> str:
    """The measures as Markdown, with their medians."""
    lines = [
        "Distance from the truth [mm] without a posed keyframe and without a named library.",
        "",
        "| take | " + " | ".join(COLUMNS) + " |",
        "|---" + "|---:" * len(COLUMNS) + "|",
    ]
    rows = {name: list(asdict(found).values()) for name, found in results.items()}
    rows["**median**"] = np.median(list(rows.values()), axis=0).tolist()
    digits = (0, 0, 0, 0, 2, 2, 2, 2, 1)
    for name, row in rows.items():
        values = " | ".join(f"{value:.{digit}f}" for value, digit in zip(row, digits, strict=True))
        lines.append(f"| {name} | {values} |")
    return "\n".join(lines)


def main(arguments: list[str]) -> int:
    """Measure, print and write the results."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("takes", nargs="*", metavar="TAKE", help="names or folders of takes with truth")
    parser.add_argument(
        "--keypoints", action="store_true", help="hold takes against a detector's keypoints as well"
    )
    options = parser.parse_args(arguments)
    libraries = find_libraries(EVERY_LIBRARY, [SHIPPED])
    results: dict[str, Measured] = {}
    for name, folder in chosen_takes(options.takes, plain=options.keypoints).items():
        if options.keypoints and not (folder / KEYPOINTS).is_file():
            continue
        print(f"{name} ...", file=sys.stderr, flush=True)
        trial = read_unposed(folder)
        results[name] = measure(with_keypoints(trial, folder) if options.keypoints else trial, libraries)
    as_dictionaries = {name: asdict(found) for name, found in results.items()}
    file = "posing_all_keypoints" if options.keypoints else "posing_all"
    write_results(file, table(results), json.dumps(as_dictionaries, indent=1))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
