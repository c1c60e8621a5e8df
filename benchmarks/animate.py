"""From a bare clip and a height alone, against the same keypoints through the true camera.

Usage: animate.py [TAKE ...] with names or folders of takes. See README.md.
"""

import argparse
import json
import shutil
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import TypeVar

import numpy as np
from takes import OUTPUT, ROOT, chosen_takes, load_project, write_results

load_project()

from keymark.core.api import convert, reconstruct  # noqa: E402
from keymark.core.arrays import Array  # noqa: E402
from keymark.core.body.body_volume import standing_height_m  # noqa: E402
from keymark.core.body.human import HUMAN  # noqa: E402
from keymark.core.detect.keypoint_file import write_keypoints  # noqa: E402
from keymark.core.estimate.reconstruct import Reconstruction  # noqa: E402
from keymark.core.prior.library import Library  # noqa: E402
from keymark.core.prior.registry import find_libraries  # noqa: E402
from keymark.core.prior.texts import EVERY_LIBRARY  # noqa: E402
from keymark.core.progress import Job, Progress  # noqa: E402
from keymark.core.review.score import read_truth  # noqa: E402
from keymark.core.session.described import findings  # noqa: E402
from keymark.core.session.session import Session, Sight  # noqa: E402
from keymark.core.take.conversion_settings import ConversionSettings  # noqa: E402
from keymark.core.take.description import Description, describe  # noqa: E402
from keymark.core.take.motion import Motion  # noqa: E402
from keymark.core.take.take import Take  # noqa: E402
from keymark.core.take.take_file import read_take  # noqa: E402

Result = TypeVar("Result")
LIBRARIES = ROOT / "presets" / "keyframes"
COLUMNS = (
    "take", "similar, found camera [mm]", "true camera [mm]", "hips aligned, found [mm]", "true [mm]",
    "place drifts [cm]", "heading drifts [deg]", "skate [mm/frame]", "floor [cm]", "covered",
    "detect [s]", "pose [s]", "estimate [s]",
)  # fmt: skip
FEET = [HUMAN.point_names.index(f"ankle.{side}") for side in "LR"]
HIPS = [HUMAN.point_names.index(f"hip.{side}") for side in "LR"]
SHOULDERS = [HUMAN.point_names.index(f"shoulder.{side}") for side in "LR"]
STILL_M_PER_S = 0.15
"""Speed of a true ankle below which it stands."""


@dataclass(frozen=True)
class Errors:
    """Errors of a motion after one similarity transform of the whole clip."""

    similar_mm: float
    """Mean distance of the points."""
    rooted_mm: float
    """The same with the hips made to coincide in every frame."""
    place_cm: float
    """How far the error of the hips moves from the first quarter of the clip to the last."""
    heading_deg: float
    """The same of the heading of hips and shoulders."""
    skate_mm: float
    """Travel a frame of ankles that truly stand."""
    floor_cm: float
    """Deviation of their heights above the floor z = 0 from those of the truth."""
    covered: float
    """Share of the points within 1.96 sigma."""


def errors_of(motion: Motion, truth: Array) -> Errors:
    """Errors of a motion against true points (F, 13, 3) [m]."""
    points, fps = motion.points, motion.fps
    scale, turn, move = similarity(points.reshape(-1, 3), truth.reshape(-1, 3))
    there = scale * points @ turn.T + move
    hips, true_hips = there[:, HIPS].mean(axis=1), truth[:, HIPS].mean(axis=1)
    rooted = np.linalg.norm((there - hips[:, None]) - (truth - true_hips[:, None]), axis=-1)
    off = hips - true_hips
    turned = np.unwrap(heading(there) - heading(truth))
    quarter = max(len(points) // 4, 1)
    speed = np.linalg.norm(np.gradient(truth[:, FEET], axis=0), axis=-1) * fps
    stands = speed < STILL_M_PER_S
    travel = np.linalg.norm(np.gradient(points[:, FEET], axis=0), axis=-1)
    lower = points[:, FEET, 2] - truth[:, FEET, 2]
    return Errors(
        1000.0 * float(np.linalg.norm(there - truth, axis=-1).mean()),
        1000.0 * float(rooted.mean()),
        100.0 * float(np.linalg.norm(off[-quarter:].mean(axis=0) - off[:quarter].mean(axis=0))),
        float(np.degrees(abs(turned[-quarter:].mean() - turned[:quarter].mean()))),
        1000.0 * float(travel[stands].mean()) if stands.any() else np.nan,
        100.0 * float(np.sqrt(np.mean(lower[stands] ** 2))) if stands.any() else np.nan,
        float((np.linalg.norm(there - truth, axis=-1) <= 1.96 * motion.sigma_m).mean()),
    )


def similarity(points: Array, truth: Array) -> tuple[float, Array, Array]:
    """Scale, rotation and translation of points (N, 3) to others (Umeyama 1991)."""
    middle, true_middle = points.mean(axis=0), truth.mean(axis=0)
    left, values, right = np.linalg.svd((truth - true_middle).T @ (points - middle))
    sign = np.array([1.0, 1.0, np.sign(np.linalg.det(left @ right))])
    turn = left @ np.diag(sign) @ right
    scale = float((values * sign).sum() / ((points - middle) ** 2).sum())
    return scale, turn, true_middle - scale * turn @ middle


def heading(points: Array) -> Array:
    """(F,) heading of the line through hips and shoulders from right to left [rad]."""
    left = points[:, [HIPS[0], SHOULDERS[0]]].mean(axis=1)
    right = points[:, [HIPS[1], SHOULDERS[1]]].mean(axis=1)
    return np.arctan2(left[:, 1] - right[:, 1], left[:, 0] - right[:, 0])


def timed(job: Job[Result]) -> tuple[Result, dict[str, float]]:
    """Run a job; its result, and the process time of each stage [s]."""
    seconds: dict[str, float] = {}
    stage, since = "", time.process_time()
    while True:
        try:
            progress: Progress = next(job)
        except StopIteration as stop:
            return stop.value, seconds
        now = time.process_time()
        seconds[stage] = seconds.get(stage, 0.0) + now - since
        stage, since = progress.stage, now


def from_clip(
    take: Take, kept: Path, libraries: Sequence[Library]
) -> tuple[Description, Session, dict[str, float]]:
    """A take's clip converted by the performer's height alone, and by kept keypoints where there are some."""
    settings = ConversionSettings(library="auto")
    with tempfile.TemporaryDirectory() as place:
        clip = Path(place) / take.clip.name  # where nothing describes it
        shutil.copy(take.clip, clip)
        if kept.is_file():  # of an earlier run: detecting takes longest
            settings = replace(settings, keypoints=(kept,))
        height_m = round(standing_height_m(take.body), 2)
        description = describe(clip, {"actor": {"height_m": height_m}}, "--height")
        return description, *timed(convert(description, settings, libraries))


def measure(
    name: str, folder: Path, libraries: Sequence[Library]
) -> tuple[Errors, Errors, dict[str, float], list[str]]:
    """Errors without and with the true camera, process time of the stages, and what was found."""
    true = read_take(folder, keyframes_required=False, whole=True)
    kept = OUTPUT / "animate" / f"{name.replace('/', '_')}.keypoints.json"
    description, made, seconds = from_clip(true, kept, libraries)
    motion, take = made[Reconstruction].motion, made.inputs.take
    if not kept.is_file():
        kept.parent.mkdir(parents=True, exist_ok=True)
        write_keypoints(kept, made[Sight].people[0], take.frame_start, take.fps)
    body = take.body
    known = replace(true, keypoints=made[Sight].people, markers=(), keyframes=(), body=body, frame_count=None)
    by_true, _ = timed(reconstruct(known, "map", None, libraries, 0.0))
    count = len(motion.time_s)
    truth = read_truth(folder / "truth.json", true.frame_start, count)
    errors = [errors_of(one, truth) for one in (motion, by_true.motion)]
    return errors[0], errors[1], seconds, list(findings(made, description))


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("takes", nargs="*")
    names = parser.parse_args().takes
    libraries = find_libraries(EVERY_LIBRARY, [LIBRARIES])
    lines = ["| " + " | ".join(COLUMNS) + " |", "|" + "---|" * len(COLUMNS)]
    numbers: dict[str, object] = {}
    for name, folder in chosen_takes(names, plain=True).items():
        found, true, seconds, said = measure(name, folder, libraries)
        posing = sum(seconds.get(stage, 0.0) for stage in POSING)
        times = [seconds.get("Detecting keypoints", 0.0), posing, seconds.get("Estimating the motion", 0.0)]
        cells = [found.similar_mm, true.similar_mm, found.rooted_mm, true.rooted_mm]
        rest = [found.place_cm, found.heading_deg, found.skate_mm, found.floor_cm, found.covered, *times]
        words = [*(f"{cell:.0f}" for cell in cells), *(f"{cell:.2f}" for cell in rest)]
        lines.append(f"| {name} | {' | '.join(words)} |")
        print(lines[-1], *said, sep="\n  ", file=sys.stderr, flush=True)
        numbers[name] = {"found": asdict(found), "true": asdict(true), "seconds": seconds, "findings": said}
    ratios = [one["found"]["similar_mm"] / one["true"]["similar_mm"] for one in numbers.values()]
    lines.append(f"\nMedian ratio of the errors without and with the true camera: {np.median(ratios):.2f}.")
    write_results("animate", "\n".join(lines), json.dumps(numbers, indent=1))


POSING = ("Learning the parts of postures", "Composing postures", "Fitting the postures")

if __name__ == "__main__":
    main()
