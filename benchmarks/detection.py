"""What the network that finds keypoints is off by, beside a take's own file of a detector.

Usage: detection.py [--wrong] [TAKE ...]; see README.md beside this file.
"""

import json
import sys
import time
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from takes import chosen_takes, load_project, write_results

load_project()

from keymark.core.arrays import Array  # noqa: E402
from keymark.core.detect.keypoint_file import read_keypoints  # noqa: E402
from keymark.core.detect.keypoints import People  # noqa: E402
from keymark.core.detect.picture_check import check_by_pictures  # noqa: E402
from keymark.core.detect.pose_network import PoseNetwork  # noqa: E402
from keymark.core.detect.pose_tracking import find_people  # noqa: E402
from keymark.core.progress import run  # noqa: E402
from keymark.core.take.take_file import read_take  # noqa: E402
from keymark.core.video.album import Glimpses  # noqa: E402
from keymark.core.video.clip import Clip  # noqa: E402
from wrong_keypoints import NOT_OF_THE_PICTURE  # noqa: E402

LIMBS = ("shoulder", "elbow", "wrist", "hip", "knee", "ankle")
POINTS = tuple(f"{limb}.{side}" for limb in LIMBS for side in "LR")
APART_PX = 4.0
"""Sides that are nearer to each other in the picture cannot be told apart."""
OWN, OTHER = "network", "the take's file"
FILES = ("keypoints_mediapipe.json", "keypoints.json")


@dataclass(frozen=True)
class Row:
    """What one source is off by in a take."""

    take: str
    source: str
    median_px: float
    mean_px: float
    seen: float
    """Share of the frames."""
    exchanged: float
    """Share of the pairs that are nearer to the other side's place."""
    ms: float | None = None
    """Processor time a frame, on one thread."""


def true_pixel(folder: Path) -> Array:
    """(F, 12, 2) places of `POINTS` [px]."""
    points = json.loads((folder / "truth.json").read_text(encoding="utf-8"))["points"]
    place = np.array([[point or [np.nan] * 3 for point in points[name]] for name in POINTS], dtype=float)
    place = place.transpose(1, 0, 2)
    pixel, _ = read_take(folder, whole=False).camera.project(place, np.arange(len(place))[:, None])
    return pixel


def scored(take: str, source: str, people: People, truth: Array, ms: float | None = None) -> Row:
    """What people are off by; of several, the nearest counts."""
    found = np.full(truth.shape, np.nan)
    number = [people.names.index(name) for name in POINTS]
    for index, frame in enumerate(people.frames[: len(truth)]):
        if len(frame.pixel):
            off = np.linalg.norm(frame.pixel[:, number] - truth[index], axis=-1)
            found[index] = frame.pixel[int(np.nan_to_num(np.nanmean(off, axis=1), nan=1e9).argmin()), number]
    off = np.linalg.norm(found - truth, axis=-1)
    pairs, true_pairs = found.reshape(-1, 6, 2, 2), truth.reshape(-1, 6, 2, 2)
    straight = np.linalg.norm(pairs - true_pairs, axis=-1).sum(axis=-1)
    crossed = np.linalg.norm(pairs - true_pairs[:, :, ::-1], axis=-1).sum(axis=-1)
    counted = (np.linalg.norm(true_pairs[:, :, 0] - true_pairs[:, :, 1], axis=-1) > APART_PX) & np.isfinite(
        straight
    )
    seen = float(np.isfinite(off).any(axis=1).mean())
    exchanged = float((crossed < straight)[counted].mean())
    return Row(take, source, float(np.nanmedian(off)), float(np.nanmean(off)), seen, exchanged, ms)


def rows_of(name: str, folder: Path, network: PoseNetwork) -> list[Row]:
    """The network and the take's own file."""
    truth = true_pixel(folder)
    clip = Clip.open(read_take(folder, whole=False).clip)
    rows = []
    file = next((folder / one for one in FILES if (folder / one).is_file()), None)
    if file is not None:
        rows.append(scored(name, OTHER, read_keypoints(file, None, clip.size), truth))
    began = time.process_time()
    people = run(find_people(clip, network))
    ms = 1000.0 * (time.process_time() - began) / len(people.frames)
    return [*rows, scored(name, OWN, people, truth, ms)]


def table(rows: list[Row]) -> str:
    """The rows in Markdown."""
    lines = ["| take | source | median px | mean px | seen | sides exchanged | ms a frame |"]
    lines.append("|---|---|--:|--:|--:|--:|--:|")
    for row in rows:
        cost = "" if row.ms is None else f"{row.ms:.0f}"
        lines.append(
            f"| {row.take} | {row.source} | {row.median_px:.2f} | {row.mean_px:.2f} | {row.seen:.2f} "
            f"| {row.exchanged:.3f} | {cost} |"
        )
    return "\n".join(lines)


def checked(folder: Path, network: PoseNetwork) -> dict[str, str]:
    """What the pictures say of a take's own file with one thing wrong each."""
    clip = Clip.open(read_take(folder, whole=False).clip)
    glimpses = Glimpses.of(clip)
    for index, _, picture in clip.frames():
        glimpses.add(index, picture)
    file = next(folder / one for one in FILES if (folder / one).is_file())
    people = read_keypoints(file, None, clip.size)
    found = {}
    for wrong, change in NOT_OF_THE_PICTURE.items():
        finding = run(check_by_pictures(change(people), glimpses, network, clip.fps))
        away = [frame for frame, there in finding.looked.items() if not there]
        said = [f"elsewhere in {len(away)} of {len(finding.looked)}"] if away else []
        said += ["mirrored"] if finding.mirrored else []
        said += (
            [f"scaled by {finding.scale[0]:.3f}, {finding.scale[1]:.3f}"]
            if finding.scale != (1.0, 1.0)
            else []
        )
        found[wrong] = finding.refusal or ", ".join(said) or "believed"
    return found


def main(wanted: list[str]) -> int:
    """Measure, print and write the results."""
    cv2.setNumThreads(1)
    network = PoseNetwork()
    if "--wrong" in wanted:
        for name, folder in chosen_takes([one for one in wanted if one != "--wrong"], plain=True).items():
            for wrong, said in checked(folder, network).items():
                print(f"| {name} | {wrong} | {said} |", flush=True)
        return 0
    rows: list[Row] = []
    for name, folder in chosen_takes(wanted, plain=True).items():
        rows += rows_of(name, folder, network)
        print("\n".join(table(rows).splitlines()[-2:]), file=sys.stderr, flush=True)
    write_results("detection", table(rows), json.dumps([vars(row) for row in rows], indent=1))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
