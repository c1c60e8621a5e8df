"""Make takes with truth: compose a performance, film it, and write its take, keyframe and truth files.

Usage: make_takes.py [--output FOLDER] [--threads N] [--keypoints] [NAME ...], with the Python of a virtual
environment that has `bpy`; by default all takes of studio/catalogue/ into out/takes. The one called
`aerobic` is the demonstration of presets/demo, `greeting` the example in plain clothes beside it. A take
needs some minutes; with --keypoints nothing is filmed, and only what the studio's detector sees is written
anew. Equal seeds give equal motion, keyframes, keypoints and, in one version of Blender, equal pictures.
"""

import argparse
import json
import sys
from pathlib import Path

import bpy
import cv2
import numpy as np

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "tests"), str(Path(__file__).resolve().parent)]
from _boot import load_package  # noqa: E402

load_package()

from keymark.core.arrays import Array, BoolArray  # noqa: E402
from keymark.core.body.posture import rounded  # noqa: E402
from keymark.core.detect.keypoint_file import write_keypoints  # noqa: E402
from keymark.core.files.json_file import write_json  # noqa: E402
from keymark.core.markers.region_tracks import MarkerStyle  # noqa: E402
from keymark.core.prior.keyframes import Keyframe  # noqa: E402
from keymark.core.take import evidence  # noqa: E402
from keymark.core.take.description import KEYPOINT_FILE  # noqa: E402
from keymark.core.take.keyframe_file import write_keyframes  # noqa: E402
from keymark.core.take.take import Take  # noqa: E402
from keymark.core.take.take_file import write_take  # noqa: E402
from studio.catalogue import TAKES  # noqa: E402
from studio.described import SHUTTER_FRAMES, Described  # noqa: E402
from studio.detector import detect  # noqa: E402
from studio.filming import (  # noqa: E402
    add_sensor_noise,
    encode,
    film,
    marker_masks,
    only_markers,
    place_camera,
    prepare_cycles,
)
from studio.look import MARKERS  # noqa: E402
from studio.performance import Performance, principal_points  # noqa: E402
from studio.performer import Performer, build_performer  # noqa: E402
from studio.posing import pose_by_hand  # noqa: E402
from studio.room import BuiltRoom, build_room  # noqa: E402

FRAME_START = 1
WORN = (evidence.MARKERS, evidence.CONTOURS)
"""Evidence that a take is held against where its keypoints are for comparison."""
SIDE_EXPOSURE = {"moments": 2, "shutter_frames": SHUTTER_FRAMES, "samples": 2}
LICENSE = (
    "The take in this folder (clip, camera, keyframes, truth) was made by\n"
    "tools/make_takes.py and is free under the project's own license,\n"
    "GPL-3.0-or-later; see LICENSE in the project's root folder.\n"
)


def main(arguments: list[str]) -> int:
    """Make the takes named, replacing every file in their folders."""
    parser = argparse.ArgumentParser(description="Make takes with truth.")
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(TAKES)}; by default all")
    parser.add_argument("--output", type=Path, default=ROOT / "out" / "takes")
    parser.add_argument("--threads", type=int, default=None, help="of rendering; by default one a core")
    parser.add_argument(
        "--keypoints",
        action="store_true",
        help="write the keypoints of takes that are there, without filming",
    )
    chosen = parser.parse_args(arguments)
    unknown = [name for name in chosen.names if name not in TAKES]
    if unknown:
        parser.error(f"no take is called {', '.join(unknown)}; there are {', '.join(TAKES)}")
    for name in chosen.names or TAKES:
        if not chosen.keypoints:
            make(TAKES[name], chosen.output / name, chosen.threads)
        elif TAKES[name].detected:
            detect_again(TAKES[name], chosen.output / name)
    return 0


def make(described: Described, output: Path, threads: int | None) -> None:
    """Make one take."""
    output.mkdir(parents=True, exist_ok=True)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    performance = described.perform(described.seed)
    room = build_room(described.surroundings(performance))
    performer = build_performer(performance.body, described.look)
    prepare_cycles(described.seed, threads)
    random = np.random.default_rng(described.seed)
    shadow = np.array(described.shadow_per_height)
    masks = None if described.plain else _masks(performer, performance, room, described)
    exposure = {
        "moments": described.moments,
        "shutter_frames": described.shutter_frames,
        "samples": described.samples,
    }
    images = film(performer, performance, room, described.camera, **exposure, shadow_per_height=shadow)
    noisy = [add_sensor_noise(image, random, described.noise) for image in images]
    encode(noisy, output / "clip.mp4", described.quality, performance.fps)
    _write_data(output, performance, masks, described)
    if described.side is not None:
        images = film(performer, performance, room, described.side, **SIDE_EXPOSURE, shadow_per_height=shadow)
        noisy = [add_sensor_noise(image, random, described.noise) for image in images]
        encode(noisy, output / "side.mp4", "MEDIUM", performance.fps)
        _write_json(output / "side.json", {"clip": "side.mp4", "camera": described.side.to_dict()})


def detect_again(described: Described, output: Path) -> None:
    """Let the studio's detector look at a take that was filmed before, whose clip stays as it is."""
    write_keypoint_file(output, described.perform(described.seed), described)
    if described.plain:
        return
    fields = json.loads((output / "take.json").read_text(encoding="utf-8"))
    actor = fields.pop("actor")
    write_json(output / "take.json", {**fields, "evidence": list(WORN), "actor": actor}, indent=1)


def write_keypoint_file(output: Path, performance: Performance, described: Described) -> None:
    """Write what the studio's detector sees."""
    people = detect(performance, described.camera, np.random.default_rng(described.seed))
    write_keypoints(output / KEYPOINT_FILE, people, FRAME_START, performance.fps)


def _masks(
    performer: Performer, performance: Performance, room: BuiltRoom, described: Described
) -> BoolArray:
    """(F, M, height, width) masks of each marker's visible pixels, at the middle of each exposure."""
    place_camera(described.camera)
    frames = []
    with only_markers(performer.thing, room) as grays:
        for frame, index in enumerate(performance.middles):
            performer.bend(performance, int(index))
            room.move(frame)
            frames.append(marker_masks(grays))
    return np.stack(frames)


def _write_data(
    output: Path, performance: Performance, masks: BoolArray | None, described: Described
) -> None:
    indices = performance.middles
    body = performance.body
    points = principal_points(performance, indices)
    truth = dict(zip(body.skeleton.point_names, rounded(np.swapaxes(points, 0, 1)), strict=True))
    frames = list(range(FRAME_START, FRAME_START + performance.frame_count))
    _write_json(output / "truth.json", {"frames": frames, "points": truth})
    if masks is not None:
        _write_json(output / "visibility.json", _visibility(masks))
    (output / "LICENSE.txt").write_text(LICENSE, encoding="utf-8")
    at = described.posed_frames(performance.frame_count)
    exact = performance.postures[indices[list(at)]]
    sight = -described.camera.matrix_world[:3, 2]
    noisy = pose_by_hand(body, exact, sight, np.random.default_rng(described.seed))
    take = Take(
        folder=output,
        clip=output / "clip.mp4",
        fps=performance.fps,
        frame_start=FRAME_START,
        frame_count=performance.frame_count,
        camera=described.camera,
        body=body,
        markers=() if masks is None else _eyedropper(output / "clip.mp4", masks),
        keyframes=tuple(Keyframe(index, exact[row]) for row, index in enumerate(at)),
    )
    if described.detected:
        write_keypoint_file(output, performance, described)
    write_take(take, output, WORN if described.detected and not described.plain else None)
    by_hand = [Keyframe(index, noisy[row]) for row, index in enumerate(at)]
    write_keyframes(output / "keyframes_noisy.json", by_hand, body, FRAME_START)
    if not described.postures:
        _keep_points_only(output / "keyframes.json", points[list(at)])
        _keep_points_only(output / "keyframes_noisy.json")


def _keep_points_only(path: Path, points: Array | None = None) -> None:
    """Remove the postures from a keyframe file: thirteen marked points do not determine twists.

    Args:
        path: The file.
        points: (K, 13, 3) the marked points [m] where they are not the postures' own.
    """
    keyframes = json.loads(path.read_text(encoding="utf-8"))["keyframes"]
    for row, keyframe in enumerate(keyframes):
        del keyframe["posture"]
        if points is not None:
            keyframe["points"] = dict(zip(keyframe["points"], rounded(points[row]), strict=True))
    _write_json(path, {"keyframes": keyframes})


def _visibility(masks: BoolArray) -> dict[str, dict[str, list]]:
    """Visible pixels and their centroid [px] by marker and frame; null where none is visible."""
    rows, columns = np.indices(masks.shape[2:]) + 0.5
    visible: dict[str, dict[str, list]] = {}
    for number, name in enumerate(MARKERS):
        seen = masks[:, number]
        centers = [
            [round(float(columns[m].mean()), 2), round(float(rows[m].mean()), 2)] if m.any() else None
            for m in seen
        ]
        visible[name] = {"pixels": [int(m.sum()) for m in seen], "centroid": centers}
    return visible


def _eyedropper(clip: Path, masks: BoolArray) -> tuple[MarkerStyle, ...]:
    """Color of each marker in the encoded footage: the median inside its region over the clip."""
    capture = cv2.VideoCapture(str(clip))
    images = np.stack([capture.read()[1] for _ in masks])[..., ::-1]
    styles = []
    for number, name in enumerate(MARKERS):
        inside = np.stack([cv2.erode(m.astype(np.uint8), np.ones((3, 3))) for m in masks[:, number]]) > 0
        red, green, blue = (int(round(value)) for value in np.median(images[inside], axis=0))
        styles.append(MarkerStyle(name=name, segment=name, color_srgb=(red, green, blue)))
    return tuple(styles)


def _write_json(path: Path, value: object) -> None:
    """Write JSON without spaces, for small files."""
    path.write_text(json.dumps(value, separators=(",", ":")) + "\n", encoding="utf-8")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
