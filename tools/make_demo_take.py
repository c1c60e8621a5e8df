"""Make the demonstration take: compose a performance, film it from two sides, and write down the truth.

Usage: make_demo_take.py [OUTPUT], with the Python of a virtual environment that has `bpy`; by default into
presets/demo/aerobic. It takes some ten minutes on two cores. Equal seeds give equal motion, keyframes and, in
one version of Blender, equal pictures.
"""

import json
import sys
from pathlib import Path

import bpy
import cv2
import numpy as np
from numpy.typing import NDArray

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "tests"), str(Path(__file__).resolve().parent / "demo_take")]
from _boot import load_package  # noqa: E402

load_package()

from choreography import FRAME_COUNT, Performance, perform, principal_points  # noqa: E402
from filming import (  # noqa: E402
    FPS,
    add_sensor_noise,
    encode,
    film,
    look_at,
    marker_masks,
    only_markers,
    place_camera,
    prepare_cycles,
)
from keymark.core.footage.marker_style import MarkerStyle  # noqa: E402
from keymark.core.keyframe_file import rounded, write_keyframes  # noqa: E402
from keymark.core.prior.keyframes import Keyframe  # noqa: E402
from keymark.core.take import Take, write_take  # noqa: E402
from performer import MARKERS, Performer, build_performer  # noqa: E402
from posing import pose_by_hand  # noqa: E402
from room import build_room  # noqa: E402

SEED = 34
SIZE = (320, 240)
FRONT = look_at((0.75, -4.15, 1.32), (0.24, 0.05, 1.03), 47.0, SIZE)
SIDE = look_at((4.35, -0.25, 1.25), (0.1, -0.15, 1.03), 47.0, SIZE)
KEYFRAMES = (1, 9, 16, 24, 31, 43, 54, 67, 81, 95, 107, 118)
"""Scene frames an animator would pose: the ends of movements, and halfway where these are far apart."""
FRAME_START = 1
NOISE = 1.5
FRONT_EXPOSURE = {"moments": 3, "samples": 3}
SIDE_EXPOSURE = {"moments": 2, "samples": 2}
LICENSE = (
    "The take in this folder (clip, side view, camera, keyframes, truth) was made by\n"
    "tools/make_demo_take.py and is free under the project's own licence,\n"
    "GPL-3.0-or-later; see LICENSE in the project's root folder.\n"
)


def main(arguments: list[str]) -> int:
    """Make the take; the output folder gets every file anew."""
    output = Path(arguments[0]) if arguments else ROOT / "presets" / "demo" / "aerobic"
    output.mkdir(parents=True, exist_ok=True)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    performance = perform(SEED)
    build_room()
    performer = build_performer(performance.body)
    prepare_cycles(SEED)
    random = np.random.default_rng(SEED)
    masks = _masks(performer, performance)
    images = film(performer, performance, FRONT, **FRONT_EXPOSURE)
    encode([add_sensor_noise(image, random, NOISE) for image in images], output / "clip.mp4", "HIGH")
    _write_data(output, performance, masks)
    images = film(performer, performance, SIDE, **SIDE_EXPOSURE)
    encode([add_sensor_noise(image, random, NOISE) for image in images], output / "side.mp4", "MEDIUM")
    return 0


def _masks(performer: Performer, performance: Performance) -> NDArray[np.bool_]:
    """(F, M, height, width) where each marker is exactly visible in the middle of each exposure."""
    place_camera(FRONT)
    frames = []
    with only_markers(performer.thing) as greys:
        for index in performance.at(np.arange(float(FRAME_COUNT))):
            performer.bend(performance, int(index))
            frames.append(marker_masks(greys))
    return np.stack(frames)


def _write_data(output: Path, performance: Performance, masks: NDArray[np.bool_]) -> None:
    indices = performance.at(np.arange(float(FRAME_COUNT)))
    body = performance.body
    points = principal_points(performance, indices)
    truth = dict(zip(body.skeleton.point_names, rounded(np.swapaxes(points, 0, 1)), strict=True))
    frames = list(range(FRAME_START, FRAME_START + FRAME_COUNT))
    _write_json(output / "truth.json", {"frames": frames, "points": truth})
    _write_json(output / "visibility.json", _visibility(masks))
    _write_json(output / "side.json", {"clip": "side.mp4", "camera": SIDE.to_dict()})
    (output / "LICENSE.txt").write_text(LICENSE, encoding="utf-8")
    keyed = indices[np.array(KEYFRAMES) - FRAME_START]
    exact = performance.postures[keyed]
    sight = -FRONT.matrix_world[:3, 2]
    noisy = pose_by_hand(body, exact, sight, np.random.default_rng(SEED))
    at = [frame - FRAME_START for frame in KEYFRAMES]
    take = Take(
        folder=output,
        clip=output / "clip.mp4",
        fps=FPS,
        frame_start=FRAME_START,
        frame_count=FRAME_COUNT,
        camera=FRONT,
        body=body,
        markers=_eyedropper(output / "clip.mp4", masks),
        keyframes=tuple(Keyframe(index, exact[row]) for row, index in enumerate(at)),
    )
    write_take(take, output)
    by_hand = [Keyframe(index, noisy[row]) for row, index in enumerate(at)]
    write_keyframes(output / "keyframes_noisy.json", by_hand, body, FRAME_START)


def _visibility(masks: NDArray[np.bool_]) -> dict[str, dict[str, list]]:
    """Visible pixels and their centroid [px] by marker and frame; null where none is visible."""
    rows, columns = np.indices(SIZE[::-1]) + 0.5
    visible: dict[str, dict[str, list]] = {}
    for number, name in enumerate(MARKERS):
        seen = masks[:, number]
        centres = [
            [round(float(columns[m].mean()), 2), round(float(rows[m].mean()), 2)] if m.any() else None
            for m in seen
        ]
        visible[name] = {"pixels": [int(m.sum()) for m in seen], "centroid": centres}
    return visible


def _eyedropper(clip: Path, masks: NDArray[np.bool_]) -> tuple[MarkerStyle, ...]:
    """One colour a marker, as found in the encoded footage: the median inside its region over the clip."""
    capture = cv2.VideoCapture(str(clip))
    images = np.stack([capture.read()[1] for _ in range(FRAME_COUNT)])[..., ::-1]
    styles = []
    for number, name in enumerate(MARKERS):
        inside = np.stack([cv2.erode(m.astype(np.uint8), np.ones((3, 3))) for m in masks[:, number]]) > 0
        red, green, blue = (int(round(value)) for value in np.median(images[inside], axis=0))
        styles.append(MarkerStyle(name=name, segment=name, color_srgb=(red, green, blue)))
    return tuple(styles)


def _write_json(path: Path, value: object) -> None:
    """Write JSON without spaces, which the folder's size would feel."""
    path.write_text(json.dumps(value, separators=(",", ":")) + "\n", encoding="utf-8")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
