"""People as detectors see them, and their files in every format that is read."""

import json
from pathlib import Path
from typing import Any

import numpy as np
from keymark.core.arrays import Array
from keymark.core.detect.layouts import LAYOUTS, Layout

SIZE = (320, 240)
FRAMES = 12


def moving_person(layout: Layout, frames: int = FRAMES, seed: int = 0) -> Array:
    """(F, N, 3) x, y and score of all points of a layout, well inside the picture, drifting to the right."""
    generator = np.random.default_rng(seed)
    points = generator.uniform([60.0, 40.0, 0.5], [220.0, 200.0, 1.0], size=(layout.count, 3))
    moved = np.repeat(points[None], frames, axis=0)
    moved[:, :, 0] += np.arange(frames)[:, None]
    return np.round(moved, 3)


def openpose_frame(people: list[Array]) -> dict[str, Any]:
    """One frame's file; people are (N, 3)."""
    entries = [{"person_id": [-1], "pose_keypoints_2d": one.ravel().tolist()} for one in people]
    return {"version": 1.3, "people": entries}


def write_openpose(folder: Path, person: Array, first: int = 0, holes: tuple[int, ...] = ()) -> Path:
    """A folder of one person's files, numbered from `first`."""
    folder.mkdir(parents=True, exist_ok=True)
    for index, points in enumerate(person):
        if index not in holes:
            path = folder / f"clip_{first + index:012d}_keypoints.json"
            path.write_text(json.dumps(openpose_frame([points])), encoding="utf-8")
    return folder


def mmpose_value(person: Array, first: int = 1) -> dict[str, Any]:
    """A result of MMPose."""
    rows = []
    for index, points in enumerate(person):
        instance = {
            "keypoints": points[:, :2].tolist(),
            "keypoint_scores": points[:, 2].tolist(),
            "bbox": [[1]],
        }
        rows.append({"frame_id": first + index, "instances": [instance]})
    return {"meta_info": {"dataset_name": "coco"}, "instance_info": rows}


def coco_value(person: Array, names: str = "{}.jpg") -> list[dict[str, Any]]:
    """A result in COCO's form."""
    return [
        {
            "image_id": names.format(index),
            "category_id": 1,
            "keypoints": points.ravel().tolist(),
            "score": 2.9,
        }
        for index, points in enumerate(person)
    ]


def mediapipe_value(person: Array, size: tuple[int, int] = SIZE) -> list[Any]:
    """Landmarks of MediaPipe and its guess in space, which is the pixel's offset in decimeters."""
    width, height = size
    frames = []
    for points in person:
        image = [{"x": x / width, "y": y / height, "z": 0.1, "visibility": score} for x, y, score in points]
        world = [
            {"x": x / 100.0 - 1.0, "y": y / 100.0 - 1.0, "z": 0.2, "visibility": s} for x, y, s in points
        ]
        frames.append({"landmarks": image, "worldLandmarks": world})
    return frames


def own_value(person: Array, layout: str = "coco17") -> dict[str, Any]:
    """Our own file."""
    return {"layout": layout, "size": list(SIZE), "frame_start": 1, "frames": person.tolist()}


def write(path: Path, value: Any) -> Path:
    """A value as a JSON file."""
    path.write_text(json.dumps(value), encoding="utf-8")
    return path


COCO17, BODY25, HALPE26, BLAZEPOSE33 = (
    LAYOUTS[name] for name in ("coco17", "body25", "halpe26", "blazepose33")
)
