"""The demonstration's motion seen from the side: a figure of thick lines before its camera."""

import json
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from keymark.core.body.human import HUMAN
from keymark.core.camera.camera import Camera

TURNED_DEG = 80.0
"""The demonstration begins facing the camera; about as far as this a performer is called in profile."""
LIMBS = {
    "thigh.{side}": ("hip.{side}", "knee.{side}", 0.15),
    "shin.{side}": ("knee.{side}", "ankle.{side}", 0.11),
    "upper_arm.{side}": ("shoulder.{side}", "elbow.{side}", 0.10),
    "forearm.{side}": ("elbow.{side}", "wrist.{side}", 0.08),
}
"""Ends and thickness [m] of what is drawn besides head and trunk."""
TRUNK_M, HEAD_M = 0.24, 0.2
DARK, SKIN, WALL = (60, 62, 66), (120, 160, 215), (170, 176, 180)
"""Blue, green, red of clothes without a marker, of the head, and of the wall behind."""


def profile_take(demo: Path, folder: Path) -> Path:
    """Write the take as numbered images; returns its folder."""
    fields = json.loads((demo / "take.json").read_text(encoding="utf-8"))
    truth = json.loads((demo / "truth.json").read_text(encoding="utf-8"))
    points = _turned(np.array([truth["points"][name] for name in HUMAN.point_names]))
    camera = Camera.from_dict(fields["camera"])
    colors = {name: tuple(marker["color_srgb"][::-1]) for name, marker in fields["markers"].items()}
    (folder / "frames").mkdir(parents=True)
    noise = np.random.default_rng(7)
    for index in range(points.shape[1]):
        named = dict(zip(HUMAN.point_names, points[:, index], strict=True))
        image = _drawn(named, camera, colors)
        image = np.clip(image + noise.normal(0.0, 1.5, image.shape), 0, 255).astype(np.uint8)
        cv2.imwrite(str(folder / "frames" / f"{index + 1:04d}.png"), image)
    posed = json.loads((demo / "keyframes.json").read_text(encoding="utf-8"))["keyframes"]
    frames = [keyframe["frame"] for keyframe in posed]
    rows = [{"frame": frame, "points": _named(points[:, frame - fields["frame_start"]])} for frame in frames]
    _write(folder / "keyframes.json", {"keyframes": rows})
    _write(folder / "truth.json", {**truth, "points": _named(points)})
    _write(folder / "take.json", {**fields, "clip": "frames"})
    return folder


def _turned(points: np.ndarray) -> np.ndarray:
    """Points (13, F, 3) turned about the vertical through the middle of the first frame's hips."""
    angle = np.radians(TURNED_DEG)
    turn = np.array([[np.cos(angle), -np.sin(angle), 0.0], [np.sin(angle), np.cos(angle), 0.0], [0, 0, 1]])
    hips = [HUMAN.point_names.index(f"hip.{side}") for side in "LR"]
    middle = points[hips, 0].mean(axis=0) * [1.0, 1.0, 0.0]
    return (points - middle) @ turn.T + middle


def _drawn(points: dict[str, np.ndarray], camera: Camera, colors: dict[str, Any]) -> np.ndarray:
    """A picture (rows, columns, 3) of blue, green, red: what is farther is drawn first."""
    neck, hips = (
        np.mean([points[f"{joint}.{side}"] for side in "LR"], axis=0) for joint in ("shoulder", "hip")
    )
    parts = [("trunk", neck, hips, TRUNK_M), ("head", points["head"], neck, HEAD_M)]
    for side in "LR":
        for name, (start, end, thick) in LIMBS.items():
            ends = (points[each.format(side=side)] for each in (start, end))
            parts.append((name.format(side=side), *ends, thick))
    width, height = camera.resolution
    eye = np.array(camera.matrix_world)[:3, 3]
    image = np.full((height, width, 3), WALL, dtype=np.uint8)
    scale = camera.lens_mm / camera.sensor_width_mm * width
    for name, start, end, thick in sorted(
        parts, key=lambda part: -np.linalg.norm(0.5 * (part[1] + part[2]) - eye)
    ):
        pixel = camera.project(np.array([start, end]))[0]
        away = float(np.linalg.norm(0.5 * (start + end) - eye))
        tips = [tuple(round(16.0 * (value - 0.5)) for value in tip) for tip in pixel.tolist()]
        color = colors.get(name, SKIN if name == "head" else DARK)
        cv2.line(image, tips[0], tips[1], color, max(1, round(scale * thick / away)), cv2.LINE_AA, 4)
    return image


def _named(rows: np.ndarray) -> dict[str, Any]:
    """Rows by name of principal point."""
    return dict(zip(HUMAN.point_names, rows.tolist(), strict=True))


def _write(path: Path, value: Any) -> None:
    path.write_text(json.dumps(value), encoding="utf-8")
