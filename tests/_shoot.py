"""A small shoot: clips of one performer, described by one file."""

from pathlib import Path
from typing import Any

import cv2
import numpy as np
from _synthetic_take import (
    BODY,
    CAMERA,
    COLORS,
    SIZE,
    drawn_frames,
    true_postures,
    write_images,
    write_json,
    write_keyframes,
)
from keymark.core.body.body_volume import standing_posture
from keymark.core.body.posture import Posture

FPS = 30.0


def shoot_fields() -> dict[str, Any]:
    """Fields that all takes inherit; rate and size come from their clips."""
    return {
        "schema_version": 1,
        "root": True,
        "camera": {name: value for name, value in CAMERA.items() if name != "resolution"},
        "markers": {name: {"color_srgb": list(color)} for name, color in COLORS.items()},
        "actor": {"height_m": 1.75},
        "method": "interpolation",
        "pictures": False,
    }


def write_shoot(folder: Path, takes: int = 3, frames: int = 8) -> Path:
    """Write a shoot whose takes are `day1/take01`, `day1/take02` and so on; returns the folder.

    Every third take is a folder with `take.json` and images; the others are bare videos with their keyframe
    files. Each shows another part of the same movement, so that no two give the same motion.
    """
    day = folder / "day1"
    day.mkdir(parents=True)
    write_json(folder / "shoot.json", shoot_fields())
    every = true_postures(frames + takes)
    for take in range(takes):
        posture = every[take : take + frames]
        points = BODY.points(BODY.pose(posture))
        name = f"take{take + 1:02d}"
        if take % 3 == 2:
            write_images(day / name / "frames", posture)
            write_json(day / name / "take.json", {"clip": "frames", "fps": FPS, "frame_count": frames})
            write_keyframes(day / name / "keyframes.json", points, 4)
        else:
            write_video(day / f"{name}.mp4", posture, seed=take)
            write_keyframes(day / f"{name}.keyframes.json", points, 4)
    return folder


def write_video(path: Path, posture: Posture, seed: int = 7) -> None:
    """Film postures as a video."""
    write_frames(path, list(drawn_frames(posture, seed)))


def gliding(frames: int = 40) -> Posture:
    """Somebody glides toward the camera, upright."""
    ways = np.linspace(-0.2, 0.3, frames), np.linspace(0.9, -0.2, frames)
    return Posture.stack([standing_posture(BODY, np.array([x, y, 0.0])) for x, y in zip(*ways, strict=True)])


def write_frames(path: Path, images: list[np.ndarray]) -> None:
    """Write pictures as a video of 30 frames per second."""
    size = (images[0].shape[1], images[0].shape[0]) if images else SIZE
    video = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*"mp4v"), FPS, size)
    assert video.isOpened()
    for image in images:
        video.write(image)
    video.release()
