"""No posing at all: accuracy of the keyframes that are found, and of the motion that follows from them.

Usage: posing_all.py [TAKE ...] [--keypoints | --wrong] with names or folders of takes. See README.md.
"""

import argparse
import json
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass, replace

import numpy as np
from takes import load_project, write_results
from trials import Trial, unposed_trials

load_project()

from keymark.core.api import reconstruct  # noqa: E402
from keymark.core.arrays import Array, BoolArray  # noqa: E402
from keymark.core.body.actor import Actor  # noqa: E402
from keymark.core.body.human import HUMAN  # noqa: E402
from keymark.core.body.kinematics import Body  # noqa: E402
from keymark.core.body.rotations import exponential  # noqa: E402
from keymark.core.detect.keypoints import People  # noqa: E402
from keymark.core.errors import InputError  # noqa: E402
from keymark.core.poses.clip import pose_clip  # noqa: E402
from keymark.core.poses.found_poses import FoundPoses, with_found  # noqa: E402
from keymark.core.prior.keyframes import Keyframe  # noqa: E402
from keymark.core.prior.library import Library  # noqa: E402
from keymark.core.prior.registry import SHIPPED, find_libraries  # noqa: E402
from keymark.core.prior.texts import EVERY_LIBRARY  # noqa: E402
from keymark.core.progress import run  # noqa: E402
from keymark.core.review.score import Score  # noqa: E402
from keymark.core.session.stages import seen_in  # noqa: E402
from keymark.core.take.motion import Motion  # noqa: E402
from keymark.core.take.read_footage import read_footage  # noqa: E402
from keymark.core.take.take import Take  # noqa: E402
from wrong_keypoints import NOT_OF_THE_PICTURE, WRONG  # noqa: E402

WRONG_SIDE_M = 0.15
"""A limb's end this much off in depth beside its own root, and nearer to its mirror image in depth."""
LIMBS = tuple((f"{root}.{side}", f"{end}.{side}") for side in "LR" for root, end in
              (("shoulder", "elbow"), ("elbow", "wrist"), ("hip", "knee"), ("knee", "ankle")))  # fmt: skip
COLUMNS = (
    "found, hips aligned", "found", "motion, hips aligned", "motion", "coverage", "wrong depth side",
    "frames with one", "confidence", "within 100 mm", "s a 100 frames", "s between",
)  # fmt: skip
DIGITS = (0, 0, 0, 0, 2, 2, 2, 2, 2, 1, 1)
BETWEEN_S = 1.0  # time between two posed frames in the middle of a clip between which poses are found anew


@dataclass(frozen=True)
class Measured:
    """Errors [mm] of one take that nobody posed."""

    found_rooted: float  # mean over the found keyframes, the hips aligned
    found: float
    rooted: float  # mean over the frames of the motion of method `map`, the hips aligned
    mpjpe: float
    coverage: float
    wrong_side: float
    """Share of limbs' segments that lean away from the camera instead of toward it or the other way round."""
    wrong_frames: float  # share of frames in which some limb's segment does
    confidence: float  # mean of the chosen candidates'
    right: float  # share of found keyframes within 100 mm, the hips aligned: what the confidence should be
    seconds: float  # process time of posing 100 frames
    between_s: float  # process time of posing anew what lies between two posed frames


def measure(trial: Trial, libraries: Sequence[Library]) -> Measured:
    """Pose a take without a person, and reconstruct it."""
    take, truth = replace(trial.take, keyframes=()), trial.truth
    begun = time.process_time()
    found = run(pose_clip(seen_in(take, trial.reading), libraries))
    seconds = 100.0 * (time.process_time() - begun) / len(truth)
    index = [frame.index for frame in found.frames]
    points = take.body.points(take.body.pose(found.postures))[index]
    off = points - truth[index]
    hips = [HUMAN.point_names.index(f"hip.{side}") for side in "LR"]
    rooted = np.linalg.norm(off - off[:, hips].mean(axis=1, keepdims=True), axis=-1).mean(axis=1)
    motion, score = estimated(trial, take, found)
    wrong = wrong_sides(trial, motion.points)
    return Measured(
        1e3 * float(rooted.mean()),
        1e3 * float(np.linalg.norm(off, axis=-1).mean()),
        score.rooted,
        score.mpjpe,
        score.coverage95 or 0.0,
        float(wrong.mean()),
        float(wrong.any(axis=0).mean()),
        float(np.mean([frame.candidates[0].confidence for frame in found.frames])),
        float((rooted < 0.1).mean()),
        seconds,
        between_seconds(trial, take, found, libraries),
    )


def estimated(trial: Trial, take: Take, found: FoundPoses) -> tuple[Motion, Score]:
    """The default method's motion from found keyframes, and its score over all frames."""
    motion = run(reconstruct(with_found(take, found), "map", trial.reading)).motion
    return motion, replace(trial, unscored=()).score(motion.points, motion.sigma_m)


def between_seconds(trial: Trial, take: Take, found: FoundPoses, libraries: Sequence[Library]) -> float:
    """Process time of posing anew what lies between two of the found frames, once those count as posed."""
    time_s = trial.tracks.time_s
    middle = 0.5 * (time_s[0] + time_s[-1])
    ends = tuple(int(np.abs(time_s - middle - side * BETWEEN_S).argmin()) for side in (-0.5, 0.5))
    posed = replace(take, keyframes=tuple(Keyframe(index, found.postures[index]) for index in ends))
    begun = time.process_time()
    run(pose_clip(seen_in(posed, trial.reading), libraries, found.floor_m, between=ends))
    return time.process_time() - begun


def wrong_sides(trial: Trial, points: Array) -> BoolArray:
    """(L, F) which limbs' segments lean the other way in depth than in truth, and are clearly off.

    Args:
        trial: The take with its truth.
        points: (F, 13, 3) the points of a motion [m].
    """
    frame = np.arange(len(points))
    sight = trial.take.camera.sight(trial.truth.mean(axis=1), frame)
    wrong = []
    for root, end in LIMBS:
        pair = [HUMAN.point_names.index(name) for name in (end, root)]
        true, seen = (np.einsum("fi,fi->f", np.subtract(*each[:, pair].swapaxes(0, 1)), sight)
                      for each in (trial.truth, points))  # fmt: skip
        wrong.append((np.abs(true - seen) > WRONG_SIDE_M) & (np.abs(true + seen) < np.abs(true - seen)))
    return np.array(wrong)


# --- Whether the confidence of a motion can be believed


USABLE_ROOTED_MM, USABLE_MM = 100.0, 500.0  # what `core/poses/agreement.py` means by usable
COVERED_LEGS = ("hip", "knee", "ankle", "heel", "toe")


def of_height(factor: float) -> Callable[[Take], Take]:
    """The take with a height that is wrong by a factor."""

    def changed(take: Take) -> Take:
        lengths = {name: factor * length for name, length in take.body.actor.segments_m.items()}
        return replace(take, body=Body(Actor(lengths)))

    return changed


def tilted(take: Take) -> Take:
    """The take with a camera that looks 12 degrees too high."""
    turn = np.eye(4)
    turn[:3, :3] = exponential(np.radians([12.0, 0.0, 0.0]))
    return replace(take, camera=replace(take.camera, matrix_world=take.camera.matrix_world @ turn))


def with_longer_lens(take: Take) -> Take:
    """The take with a lens said to be 1.4 times as long."""
    return replace(take, camera=replace(take.camera, lens_mm=1.4 * take.camera.lens_mm))


def without_legs(people: People) -> People:
    """Nothing is seen below the waist."""
    legs = [row for row, name in enumerate(people.names) if name.split(".")[0] in COVERED_LEGS]
    frames = []
    for seen in people.frames:
        pixel, score = seen.pixel.copy(), seen.score.copy()
        pixel[:, legs], score[:, legs] = np.nan, 0.0
        frames.append(replace(seen, pixel=pixel, score=score))
    return replace(people, frames=tuple(frames))


def by_detector(change: Callable[[People], People]) -> Callable[[Take], Take]:
    """The take with keypoints that are changed."""
    return lambda take: replace(take, keypoints=tuple(change(people) for people in take.keypoints))


INPUTS: dict[str, Callable[[Take], Take]] = {
    "right": lambda take: take,
    "height 1.25 times": of_height(1.25),
    "height 0.8 times": of_height(0.8),
    "lens 1.4 times": with_longer_lens,
    "camera tilted by 12 degrees": tilted,
    "legs covered": by_detector(without_legs),
    **{
        name: by_detector(change)
        for name, change in (WRONG | NOT_OF_THE_PICTURE).items()
        if name in ("half size", "mirrored copy", "ten frames late", "someone in between", "30 % at random")
    },
}
"""Right and wrong inputs of a take that nobody posed, by the name in tables."""


def judged(name: str, trial: Trial, libraries: Sequence[Library]) -> Iterator[tuple[str, bool, float]]:
    """Row of the table, whether its motion is usable and the stated confidence, of each input."""
    whole = replace(trial.take, keyframes=(), markers=(), contours=False)
    reading = run(read_footage(whole))
    for kind, change in INPUTS.items():
        try:
            take = change(whole)
            found = run(pose_clip(seen_in(take, reading), libraries))
            job = reconstruct(with_found(take, found), "map", reading, floor_m=found.floor_m)
            motion = run(job).motion
        except InputError:
            yield f"| {name} | {kind} | refused | | | |", False, 0.0
            continue
        score = replace(trial, unscored=()).score(motion.points, motion.sigma_m)
        usable = score.rooted < USABLE_ROOTED_MM and score.mpjpe < USABLE_MM
        numbers = f"{score.rooted:.0f} | {score.mpjpe:.0f} | {score.coverage95 or 0.0:.2f} | {found.fit:.2f}"
        yield f"| {name} | {kind} | {numbers} |", usable, found.fit


def area_under_curve(usable: Array, confidence: Array) -> float:
    """Probability that a usable motion has more confidence than another (Mann & Whitney 1947)."""
    more = confidence[usable][:, None] - confidence[~usable]
    return float(((more > 0.0) + 0.5 * (more == 0.0)).mean()) if more.size else float("nan")


def judge(names: Sequence[str], libraries: Sequence[Library]) -> None:
    """Print and write the table of right and wrong inputs."""
    lines = [
        "| take | input | hips aligned | in place | coverage | confidence |",
        "|---|---|--:|--:|--:|--:|",
    ]
    told: list[tuple[bool, float]] = []
    for name, trial in unposed_trials(names, keypoints=True, plain=True):
        for row, usable, confidence in judged(name, trial, libraries):
            print(row, file=sys.stderr, flush=True)
            lines.append(row)
            told += [] if "refused" in row else [(usable, confidence)]
    usable, confidence = (np.array(column) for column in zip(*told, strict=True))
    area = area_under_curve(usable, confidence)
    lines += ["", f"Area under the ROC curve of {len(told)} motions: {area:.2f}"]
    write_results("posing_all_wrong", "\n".join(lines), json.dumps([[bool(u), c] for u, c in told]))


def table(results: dict[str, Measured]) -> str:
    """The measures as Markdown, with their medians."""
    lines = [
        "Distance from the truth [mm] without a posed keyframe.",
        "",
        "| take | " + " | ".join(COLUMNS) + " |",
        "|---" + "|---:" * len(COLUMNS) + "|",
    ]
    rows = {name: list(asdict(found).values()) for name, found in results.items()}
    rows["**median**"] = [float(np.median(column)) for column in zip(*rows.values(), strict=True)]
    for name, row in rows.items():
        cells = zip(row, DIGITS, strict=True)
        values = (f"{value:.{digit}f}" for value, digit in cells)
        lines.append(f"| {name} | {' | '.join(values)} |")
    return "\n".join(lines)


def main(arguments: list[str]) -> int:
    """Measure, print and write the results."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("takes", nargs="*", metavar="TAKE", help="names or folders of takes with truth")
    parser.add_argument(
        "--keypoints", action="store_true", help="hold takes against a detector's keypoints as well"
    )
    parser.add_argument("--wrong", action="store_true", help="confidence of right and of wrong inputs")
    options = parser.parse_args(arguments)
    libraries = find_libraries(EVERY_LIBRARY, [SHIPPED])
    if options.wrong:
        judge(options.takes, libraries)
        return 0
    trials = unposed_trials(options.takes, options.keypoints, plain=options.keypoints)
    results = {name: measure(trial, libraries) for name, trial in trials}
    as_dictionaries = {name: asdict(found) for name, found in results.items()}
    file = "posing_all_keypoints" if options.keypoints else "posing_all"
    write_results(file, table(results), json.dumps(as_dictionaries, indent=1))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
