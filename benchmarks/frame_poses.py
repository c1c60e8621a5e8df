"""One frame alone: how often the postures found from nothing but that frame are right, and are said to be.

Usage: frame_poses.py [TAKE ...] [--step FRAMES] with names or folders of takes. See README.md.
"""

import argparse
import json
import sys
from collections.abc import Iterable
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import numpy as np
from clock import processor_time
from takes import chosen_takes, load_project, write_results

load_project()

from keymark.core.arrays import Array  # noqa: E402
from keymark.core.body.posture import Posture  # noqa: E402
from keymark.core.detect.keypoint_file import read_keypoints  # noqa: E402
from keymark.core.detect.keypoints import Keypoints  # noqa: E402
from keymark.core.errors import InputError  # noqa: E402
from keymark.core.estimate.clip_problem import uncalibrated  # noqa: E402
from keymark.core.estimate.keypoint_evidence import KeypointEvidence  # noqa: E402
from keymark.core.markers.region_tracks import RegionTracks  # noqa: E402
from keymark.core.poses.frame import find_frame_poses  # noqa: E402
from keymark.core.poses.frame_search import FrameShown  # noqa: E402
from keymark.core.poses.part_pools import part_pools  # noqa: E402
from keymark.core.prior.library import Library  # noqa: E402
from keymark.core.prior.registry import SHIPPED, find_libraries  # noqa: E402
from keymark.core.prior.texts import EVERY_LIBRARY  # noqa: E402
from keymark.core.progress import run  # noqa: E402
from keymark.core.review.score import read_truth  # noqa: E402
from keymark.core.take.performer_keypoints import performer_keypoints  # noqa: E402
from keymark.core.take.read_footage import read_footage  # noqa: E402
from keymark.core.take.take import Take  # noqa: E402
from keymark.core.take.take_file import read_take  # noqa: E402
from keymark.core.terms.keypoints import ObservedKeypoints  # noqa: E402
from keymark.core.terms.region_model import MarkerPlacement, RegionModel  # noqa: E402

KEYPOINT_FILES = ("keypoints_mediapipe.json", "keypoints.json")
MARKERS, KEYPOINTS, BOTH = "markers", "keypoints", "both"
RIGHT_M = 0.08  # mean distance of the points, hips aligned, within which a posture is right
ABOUT_RIGHT_M = 0.10  # the same for what a confidence is the probability of
STEP = 9  # frames from one that is posed to the next
BINS = ((0.0, 0.4), (0.4, 0.6), (0.6, 0.8), (0.8, 1.0))


@dataclass(frozen=True)
class Found:
    """One frame."""

    frame: int
    error_mm: tuple[float, ...]  # of each candidate, hips aligned
    confidence: tuple[float, ...]
    contradictions: tuple[str, ...]
    cpu_ms: float


def measure(folder: Path, libraries: tuple[Library, ...], step: int) -> dict[str, list[Found]]:
    """Pose every so many frames of a take from nothing, by what is followed."""
    take = replace(read_take(folder), keyframes=())
    tracks = run(read_footage(replace(take, contours=False))).tracks
    truth = read_truth(folder / "truth.json", take.frame_start, tracks.frame_count)
    file = next((folder / name for name in KEYPOINT_FILES if (folder / name).is_file()), None)
    nothing = Keypoints.none(tracks.frame_count)
    keypoints = nothing
    if file is not None:
        people = read_keypoints(file, tracks.frame_count, take.camera.resolution)
        keypoints = performer_keypoints(replace(take, keypoints=(people,)), tracks)
    bare = RegionTracks.unmarked(tracks.time_s, tracks.size)
    kinds = {MARKERS: (tracks, nothing), KEYPOINTS: (bare, keypoints), BOTH: (tracks, keypoints)}
    part_pools(libraries, take.body)
    found: dict[str, list[Found]] = {}
    for kind, (seen, points) in kinds.items():
        if (kind != KEYPOINTS and not take.markers) or (kind != MARKERS and file is None):
            continue
        found[kind] = []
        for frame in range(0, tracks.frame_count, step):
            shown = frame_shown(take, seen, points, frame)
            if not shown.is_empty:
                found[kind].append(posed(take, shown, libraries, truth[frame], frame))
    return found


def frame_shown(take: Take, tracks: RegionTracks, keypoints: Keypoints, frame: int) -> FrameShown:
    """One frame, before any keyframe is posed."""
    segments = take.marker_segments if tracks.names else ()
    model = RegionModel(take.body, take.camera, tuple(MarkerPlacement.usual(each) for each in segments))
    usual = KeypointEvidence.usual(take.body, take.camera, keypoints.names, keypoints.sources)
    points = ObservedKeypoints.of(keypoints)[np.array([frame])]
    evidence = replace(uncalibrated(model), keypoints=usual)
    return FrameShown(evidence, frame, tracks.frame(frame), keypoints.frame(frame), points)


def posed(take: Take, shown: FrameShown, libraries: tuple[Library, ...], truth: Array, frame: int) -> Found:
    """The candidates of a frame, compared with its true points (13, 3)."""
    results = []
    seconds = processor_time(lambda: results.append(find_frame_poses(shown, libraries)))
    found, body = results[0], take.body
    hips = [body.skeleton.point_names.index(f"hip.{side}") for side in "LR"]
    points = body.points(body.pose(Posture.stack([each.posture for each in found.candidates])))
    points = points - points[:, hips].mean(axis=1, keepdims=True)
    error = np.linalg.norm(points - (truth - truth[hips].mean(axis=0)), axis=-1).mean(axis=-1)
    return Found(
        frame,
        tuple(float(each) for each in 1e3 * error),
        tuple(each.confidence for each in found.candidates),
        found.contradictions,
        1e3 * seconds,
    )


def summary(found: Iterable[Found]) -> dict[str, float]:
    """Shares and medians over frames."""
    rows = list(found)
    first = np.array([row.error_mm[0] for row in rows])
    best = np.array([min(row.error_mm) for row in rows])
    return {
        "frames": len(rows),
        "first_mm": float(np.median(first)),
        "first_right": float((first < 1e3 * RIGHT_M).mean()),
        "best_mm": float(np.median(best)),
        "best_right": float((best < 1e3 * RIGHT_M).mean()),
        "contradicted": float(np.mean([bool(row.contradictions) for row in rows])),
        "cpu_ms": float(np.mean([row.cpu_ms for row in rows])),
    }


def reliability(found: Iterable[Found]) -> list[tuple[str, int, float, float]]:
    """Of the first candidates by confidence: how many, the mean confidence, and the share about right."""
    rows = [(row.confidence[0], row.error_mm[0] < 1e3 * ABOUT_RIGHT_M) for row in found]
    lines = []
    for low, high in BINS:
        own = [row for row in rows if low <= row[0] < high or row[0] == high == 1.0]
        if own:
            said, right = np.mean(np.array(own, dtype=float), axis=0)
            lines.append((f"{low:.0%} to {high:.0%}", len(own), float(said), float(right)))
    return lines


def table(takes: dict[str, dict[str, list[Found]]]) -> str:
    """Results as Markdown."""
    lines = [
        "Isolated frames posed from nothing: median error, hips aligned [mm], and the share within 80 mm, of",
        "the first candidate and of the best of up to four; share of frames that something contradicts.",
        "",
        "| take | followed | frames | first | < 80 | best of four | < 80 | contradicted | CPU [ms] |",
        "|---|---|---:|---:|---:|---:|---:|---:|---:|",
    ]
    kinds = (MARKERS, KEYPOINTS, BOTH)
    everything = {kind: [one for found in takes.values() for one in found.get(kind, ())] for kind in kinds}
    for name, found in (takes | {"**all**": everything}).items():
        for kind, rows in found.items():
            if not rows:
                continue
            one = summary(rows)
            lines.append(
                f"| {name} | {kind} | {one['frames']:.0f} | {one['first_mm']:.0f} | "
                f"{one['first_right']:.2f} | "
                f"{one['best_mm']:.0f} | {one['best_right']:.2f} | {one['contradicted']:.2f} | "
                f"{one['cpu_ms']:.0f} |"
            )
    lines += ["", "| confidence | frames | said | about right |", "|---|---:|---:|---:|"]
    for span, count, said, right in reliability(one for rows in everything.values() for one in rows):
        lines.append(f"| {span} | {count} | {said:.2f} | {right:.2f} |")
    return "\n".join(lines)


def main(arguments: list[str]) -> int:
    """Measure, print and write the results."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("takes", nargs="*", metavar="TAKE", help="names or folders of takes with truth")
    parser.add_argument("--step", type=int, default=STEP, help="frames from one posed to the next")
    options = parser.parse_args(arguments)
    libraries = find_libraries(EVERY_LIBRARY, (SHIPPED,))
    takes: dict[str, dict[str, list[Found]]] = {}
    for name, folder in chosen_takes(options.takes, plain=True).items():
        print(f"{name} ...", file=sys.stderr, flush=True)
        try:
            takes[name] = measure(folder, libraries, options.step)
        except InputError as error:
            print(error, file=sys.stderr)
    as_lists = {
        name: {kind: [asdict(one) for one in rows] for kind, rows in found.items()}
        for name, found in takes.items()
    }
    write_results("frame_poses", table(takes), json.dumps(as_lists, indent=1))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
