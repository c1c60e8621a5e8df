"""Every file format that is read: a valid value, and its reader as the commands use it."""

import json
import shutil
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from _characters import full_map, full_record
from _libraries import small_library
from _synthetic_take import BODY, SIZE, true_postures, write_json, write_keypoints, write_synthetic_take
from keymark.core.body.fingers import Hands
from keymark.core.body.posture import posture_to_json
from keymark.core.detect.keypoint_file import read_keypoints
from keymark.core.detect.keypoints import HAND_NUMBERS
from keymark.core.prior.library import read_library
from keymark.core.retarget.maps.character_map import read_character_map
from keymark.core.retarget.retarget_record import read_retarget_record
from keymark.core.review.score import read_truth
from keymark.core.shoot.discovery import read_take_list
from keymark.core.take.conversion_record import read_record
from keymark.core.take.keyframe_file import read_keyframes
from keymark.core.take.motion import Motion, read_motion, write_motion
from keymark.core.take.read_footage import check_in_front
from keymark.core.take.take_file import read_described, read_take

FRAMES = 8
SHARED = ("fps", "frame_start", "camera", "markers", "ignored_regions", "actor")
CHARACTER = {
    "file": "characters/anna.blend",
    "object": "rig",
    "map": "anna.json",
    "root_motion": "in-place",
    "place": "character",
    "arms": "fk",
    "legs": "both",
    "plant_feet": False,
    "reach_hands": True,
    "tolerance_mm": 2.5,
    "//": "a comment",
}


@dataclass(frozen=True)
class Format:
    """A file format."""

    name: str
    """Also that of its schema."""
    valid: dict[str, Any]
    """A value with every optional field."""
    read: Callable[[bytes], object]
    """Reads a file of these bytes; the files around it are valid."""
    whole: bool = False
    """Whether the schema's part `complete` applies: nothing is inherited."""


def formats(folder: Path) -> dict[str, Format]:
    """All formats by name; the files around them are written into `folder`."""
    take = write_synthetic_take(folder / "take", FRAMES, 4)
    write_keypoints(take / "keypoints.json", true_postures(FRAMES))
    said = _said(take)
    all_formats = [
        Format("take", said, _take(take), whole=True),
        Format("keyframes", _keyframes(take), _keyframe_file(folder)),
        Format("shoot", _shoot(said), _in_shoot(folder, take)),
        Format("takes", _line(said), _listed(folder, take)),
        Format("library", small_library().to_json(), _plain(folder, "library.json", read_library)),
        Format("character", full_map().to_json(), _plain(folder, "map.json", read_character_map)),
        Format("motion", _motion(folder), _plain(folder, "motion.json", read_motion)),
        Format(
            "conversion", _record(), _plain(folder, "conversion.json", lambda path: read_record(path.parent))
        ),
        Format(
            "retarget",
            full_record().to_json(),
            _plain(folder, "retarget.json", lambda path: read_retarget_record(path.parent)),
        ),
        Format("keypoints", _keypoints(), _plain(folder, "keypoints.json", _read_keypoints)),
        Format(
            "truth",
            _read(take / "truth.json"),
            _plain(folder, "truth.json", lambda p: read_truth(p, 1, FRAMES)),
        ),
    ]
    return {one.name: one for one in all_formats}


def _read(path: Path) -> dict[str, Any]:
    value: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    return value


def _said(take: Path) -> dict[str, Any]:
    said = _read(take / "take.json")
    said["camera"] |= {"distortion": [0.01, 0.0, 0.0], "shift_x": 0.01, "//": "a comment"}
    said["markers"]["sleeve"] = {"segment": "head", "color_srgb": [1, 2, 3]}
    said["ignored_regions"] = [
        {"box": [1, 2.5, 30, 40]},
        {"stroke": [[5, 5], [9.5, 7]], "radius_px": 4, "frames": [1, 3]},
    ]
    said["actor"]["height_m"] = 1.75
    said |= {"library": "walking", "floor_m": 0.0, "method": "map", "pictures": True, "hands": True}
    said["character"] = dict(CHARACTER)
    said |= {"keypoints": ["keypoints.json"], "evidence": ["markers", "keypoints", "contours"]}
    return said | {"keyframes": "keyframes.json", "note": "of no meaning"}


def _keyframes(take: Path) -> dict[str, Any]:
    value = _read(take / "keyframes.json")
    posture = {name: numbers[4] for name, numbers in posture_to_json(true_postures(FRAMES)).items()}
    matched = {"library": "walking", "posture": "Left foot lands", "mirrored": False, "confidence": 0.5}
    value["keyframes"][1] = {"frame": 5, "posture": posture, "matched": matched}
    return value


def _shoot(said: dict[str, Any]) -> dict[str, Any]:
    settings = {"method": "ekf", "library": "mine.json", "pictures": False, "hands": False, "floor_m": 1.0}
    settings["keyframes"] = None  # auto beside a library is refused
    settings |= {"character": {"file": "anna.VRM"}, "keypoints": "keypoints.json", "evidence": ["markers"]}
    shared = {name: said[name] for name in SHARED}
    placed = {"height_m": 1.0, "tilt_deg": -0.5, "roll_deg": 0.5, "distance_m": 4.0}
    shared["camera"] = {
        name: shared["camera"][name] for name in shared["camera"] if name != "matrix_world"
    } | placed
    return {"schema_version": 1, "root": True, **shared, **settings, "// note": ["anything"]}


def _line(said: dict[str, Any]) -> dict[str, Any]:
    return {"take": "listed"} | {name: value for name, value in said.items() if name != "note"}


def _keypoints() -> dict[str, Any]:
    """Two points of one person in all frames but the last, one of them not seen in the first, with hints."""
    frames = [[[10.0 + frame, 20.5, 0.9], [30.0, 40.0, 0.1 * frame]] for frame in range(FRAMES)]
    world = [[[0.1, -0.4, 0.01 * frame], [-0.1, None, 0.2]] for frame in range(FRAMES)]
    value = {"detector": "A detector", "layout": "own", "names": ["shoulder.L"], "by_hand": False}
    value |= {"size": list(SIZE), "frame_start": 1, "fps": 30.0, "note": "free text"}
    value |= {"second": {"detector": "Another", "names": ["heel.R"], "digest": "0a", "motion": False}}
    face = [[12.0, 22.0, 0.1 * frame, -0.2, 0.0, 0.99] for frame in range(FRAMES)]
    look = [0.1, -0.2, 0.3, 0.98, 0.9, 0.4, 0.5, 0.6, 0.7, 0.8]
    hands = [[[40.0, 22.0, *look, *look], [None] * HAND_NUMBERS] for _ in range(FRAMES)]
    last: dict[str, list[Any]] = {"frames": frames, "world": world, "face": face, "hands": hands}
    return value | {name: [*rows[:-1], None] for name, rows in last.items()}


def _read_keypoints(path: Path) -> object:
    return read_keypoints(path, FRAMES, SIZE, 30.0, 1)


def _truth(path: Path) -> object:
    return read_truth(path, 1, FRAMES)


def _recorded(path: Path) -> object:
    return read_record(path.parent)


def _motion(folder: Path) -> dict[str, Any]:
    posture = true_postures(FRAMES)
    motion = Motion(
        body=BODY,
        fps=30.0,
        frame_start=1,
        time_s=np.arange(FRAMES) / 30.0,
        posture=posture,
        points=BODY.points(BODY.pose(posture)),
        point_covariance=np.broadcast_to(1e-4 * np.eye(3), (FRAMES, 13, 3, 3)),
        keyframe_indices=(0, 4, 7),
        method="map",
        diagnostics={"cost": np.arange(8.0), "quality": np.full((FRAMES, 5), np.nan)},
        hands=Hands(np.full((FRAMES, 2, 5), 0.5), np.full((FRAMES, 2, 3), 0.1), np.full((FRAMES, 2), 0.9)),
    )
    write_motion(motion, folder / "valid_motion.json")
    return _read(folder / "valid_motion.json")


def _record() -> dict[str, Any]:
    value = {"schema_version": 1, "digest": "ab" * 16, "keymark": "1.0.0", "take": "walk", "method": "map"}
    value |= {
        "library": None,
        "frames": 8,
        "frame_start": 1,
        "fps": 30.0,
        "keyframes": [1, 5],
        "matched": [5],
    }
    value |= {"doubtful": [5], "libraries": {"walking": "ef" * 16}}
    value |= {"confidence": 0.5, "weakest": 0.2, "weak_frames": [3], "notes": ["A note."]}
    value["warnings"] = ["A warning."]
    value["evidence"] = {
        "markers": ["trunk"],
        "keypoints": [
            {"source": "a detector", "points": ["nose", "wrist.L"], "believed": 0.97, "swapped": 0.1}
        ],
        "depth_hints": False,
        "contours": True,
    }
    return value | {"files": {"motion.json": "ab" * 32, "report/overlay.png": "cd" * 32}}


def _plain(folder: Path, name: str, read: Callable[[Path], object]) -> Callable[[bytes], object]:
    def from_bytes(data: bytes) -> object:
        (folder / name).write_bytes(data)
        return read(folder / name)

    return from_bytes


def _take(take: Path) -> Callable[[bytes], object]:
    def from_bytes(data: bytes) -> object:
        (take / "take.json").write_bytes(data)
        found = read_take(take)
        check_in_front(found)
        return found

    return from_bytes


def _keyframe_file(folder: Path) -> Callable[[bytes], object]:
    return _plain(folder, "keyframes.json", lambda path: read_keyframes(path, BODY, 1, None))


def _in_shoot(folder: Path, take: Path) -> Callable[[bytes], object]:
    below = folder / "shoot" / "day" / "take"
    shutil.copytree(take, below)
    write_json(below / "take.json", {"clip": "frames", "frame_count": FRAMES})

    def from_bytes(data: bytes) -> object:
        (folder / "shoot" / "shoot.json").write_bytes(data)
        return read_take(below)

    return from_bytes


def _listed(folder: Path, take: Path) -> Callable[[bytes], object]:
    shutil.copytree(take, folder / "list" / "listed")
    write_json(folder / "list" / "listed" / "take.json", {})
    path = folder / "list" / "takes.jsonl"

    def from_bytes(data: bytes) -> object:
        path.write_bytes(data)
        (found,) = read_take_list(path).takes
        return read_described(found.describe())

    return from_bytes
