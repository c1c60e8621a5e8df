"""Small takes and shoots made on the spot: a figure of thick lines, filmed as numbered images."""

import json
import shutil
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from keymark.core.body.actor import Actor
from keymark.core.body.body_volume import standing_posture
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture
from keymark.core.body.rotations import exponential
from keymark.core.camera.camera import Camera
from keymark.core.camera.camera_motion import moved
from keymark.core.video.clip import Clip

SIZE = (160, 120)
COLORS = {
    "trunk": (40, 150, 70),
    "forearm.L": (220, 50, 50),
    "forearm.R": (50, 80, 220),
    "shin.L": (220, 190, 40),
    "shin.R": (190, 50, 150),
}
BODY = Body(Actor.from_stature(1.75))
MATRIX_WORLD = [[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, -1.0, -4.0], [0.0, 1.0, 0.0, 1.0], [0.0, 0.0, 0.0, 1.0]]
CAMERA = {"lens_mm": 40.0, "sensor_width_mm": 36.0, "resolution": list(SIZE), "matrix_world": MATRIX_WORLD}


def true_postures(frames: int) -> Posture:
    """The performer sways, waves both arms and bends a knee."""
    names = BODY.skeleton.dof_names
    vector = np.zeros((frames, len(names)))
    phase = np.linspace(0.0, 2.0 * np.pi, frames)
    vector[:, names.index("pelvis.location_x")] = 0.1 * np.sin(phase)
    vector[:, names.index("pelvis.location_z")] = 0.95
    for side, out in (("L", 1.0), ("R", -1.0)):
        vector[:, names.index(f"shoulder.{side}.rotation_y")] = out * (0.9 + 0.4 * np.sin(phase))
        vector[:, names.index(f"elbow.{side}.flexion")] = 0.3 + 0.2 * np.cos(phase)
    vector[:, names.index("hip.L.rotation_x")] = -0.4 * (1.0 - np.cos(phase))
    vector[:, names.index("knee.L.flexion")] = 0.6 * (1.0 - np.cos(phase))
    return Posture.from_vector(BODY.skeleton, vector)


def write_synthetic_take(folder: Path, frames: int = 24, keyframe_every: int = 8) -> Path:
    """Write clip, take.json, keyframes.json and truth.json; returns the folder."""
    posture = true_postures(frames)
    points = BODY.points(BODY.pose(posture))
    (folder / "frames").mkdir(parents=True)
    for frame, content in enumerate(_true_files(frames)):
        (folder / "frames" / f"{frame + 1:04d}.png").write_bytes(content)
    take = {
        "fps": 30,
        "frame_start": 1,
        "frame_count": frames,
        "clip": "frames",
        "camera": CAMERA,
        "markers": {name: {"color_srgb": list(color)} for name, color in COLORS.items()},
        "actor": {"segments_m": dict(BODY.actor.segments_m)},
    }
    write_json(folder / "take.json", take)
    write_keyframes(folder / "keyframes.json", points, keyframe_every)
    write_json(
        folder / "truth.json",
        {"frames": list(range(1, frames + 1)), "points": named(np.swapaxes(points, 0, 1))},
    )
    return folder


def write_keyframes(path: Path, points: np.ndarray, every: int) -> None:
    """Write the points (F, 13, 3) of every so many frames, and of the last."""
    posed = sorted({*range(0, len(points), every), len(points) - 1})
    rows = [{"frame": index + 1, "points": named(points[index])} for index in posed]
    write_json(path, {"keyframes": rows})


def write_keypoints(path: Path, posture: Posture, **changes: Any) -> Path:
    """Write what a perfect detector of the principal points would see; `changes` are other fields."""
    pixel, _ = Camera.from_dict(CAMERA).project(BODY.points(BODY.pose(posture)))
    frames = [[[round(x, 2), round(y, 2), 0.9] for x, y in frame] for frame in pixel.tolist()]
    fields = {"detector": "drawn", "layout": "own", "names": list(BODY.skeleton.point_names)}
    write_json(path, {**fields, "size": list(SIZE), "frame_start": 1, "frames": frames, **changes})
    return path


def named(rows: np.ndarray) -> dict[str, Any]:
    """Rows by name of principal point."""
    return dict(zip(BODY.skeleton.point_names, rows.tolist(), strict=True))


def write_json(path: Path, value: Any) -> None:
    """Write without any of the product's own code."""
    path.write_text(json.dumps(value), encoding="utf-8")


def edit_json(path: Path, change: Callable[[Any], object] | None = None, **fields: Any) -> Path:
    """Change a JSON file, which may be new, by a function or by fields; returns the file."""
    value = json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}
    if change is not None:
        change(value)
    write_json(path, {**value, **fields} if fields else value)
    return path


def drawn_frames(posture: Posture, seed: int = 7) -> Iterator[np.ndarray]:
    """Yield a picture of every posture, (120, 160, 3) uint8 blue, green, red."""
    camera = Camera.from_dict(CAMERA)
    pose = BODY.pose(posture)
    ends = {
        segment.name: [camera.project(end)[0] for end in BODY.segment_ends(pose, segment.name)]
        for segment in BODY.skeleton.segments
    }
    ends["trunk"] = [ends["pelvis"][0], ends["chest"][1]]
    noise = np.random.default_rng(seed)
    for frame in range(posture.batch[0]):
        image = np.full((SIZE[1], SIZE[0], 3), 170, dtype=np.uint8)
        for name, (start, end) in ends.items():
            red, green, blue = COLORS.get(name, (90, 80, 75))
            if name in ("pelvis", "chest"):
                continue
            width = 13 if name == "trunk" else 5
            tips = [tuple(int(round(16 * (value - 0.5))) for value in tip[frame]) for tip in (start, end)]
            cv2.line(image, tips[0], tips[1], (blue, green, red), width, cv2.LINE_AA, 4)
        grain = noise.normal(0.0, 1.5, image.shape)
        yield np.clip(image + grain, 0, 255).astype(np.uint8)


@cache
def _true_files(frames: int) -> tuple[bytes, ...]:
    """The image files of the true postures, drawn once however many tests film them."""
    return tuple(cv2.imencode(".png", image)[1].tobytes() for image in drawn_frames(true_postures(frames)))


def write_images(folder: Path, posture: Posture) -> None:
    """Film postures as numbered images."""
    folder.mkdir(parents=True)
    for frame, image in enumerate(drawn_frames(posture)):
        cv2.imwrite(str(folder / f"{frame + 1:04d}.png"), image)


# --- A small shoot: clips of one performer, described by one file


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


# --- The demonstration with a panel of a sleeve's color on its wall, which nobody wears


PANEL = (8, 60, 60, 150)
"""Left, top, right, bottom in pixels of the demonstration, beside the performer."""
SLEEVE = "forearm.L"


def panelled_take(demo: Path, folder: Path) -> Path:
    """Write the demonstration anew as images; returns the take's folder."""
    fields = json.loads((demo / "take.json").read_text(encoding="utf-8"))
    (folder / "frames").mkdir(parents=True)
    left, top, right, bottom = PANEL
    for index, _, image in Clip.open(demo / "clip.mp4").frames():
        image[top:bottom, left:right] = fields["markers"][SLEEVE]["color_srgb"][::-1]
        cv2.imwrite(str(folder / "frames" / f"{index + 1:04d}.png"), image)
    for name in ("keyframes.json", "truth.json"):
        shutil.copy(demo / name, folder)
    fields["clip"] = "frames"
    (folder / "take.json").write_text(json.dumps(fields), encoding="utf-8")
    return folder


def write_shaken(clip: Path, posture: Posture, turn_rad: float) -> None:
    """Film postures before a wall of blotches, by hands that turn the camera so far; with keypoints."""
    focal_px = CAMERA["lens_mm"] / CAMERA["sensor_width_mm"] * SIZE[0]
    matrix = np.array([[focal_px, 0.0, SIZE[0] / 2], [0.0, focal_px, SIZE[1] / 2], [0.0, 0.0, 1.0]])
    noise = np.random.default_rng(5).uniform(110.0, 230.0, (SIZE[1] // 8, SIZE[0] // 8, 3))
    wall = cv2.resize(noise.astype(np.float32), SIZE, interpolation=cv2.INTER_CUBIC).clip(0.0, 255.0)
    phase = 2.0 * np.pi * np.arange(posture.batch[0]) / posture.batch[0]
    turns = turn_rad * np.stack([np.sin(phase), np.cos(phase), 0.5 * np.sin(2.0 * phase)], axis=1)
    moved_by = [matrix @ exponential(turn) @ np.linalg.inv(matrix) for turn in turns]
    images = []
    for image, homography in zip(drawn_frames(posture), moved_by, strict=True):
        before = np.abs(image.astype(int) - 170).max(axis=2) < 12
        image[before] = wall.astype(np.uint8)[before]
        images.append(cv2.warpPerspective(image, homography, SIZE, borderMode=cv2.BORDER_REPLICATE))
    write_frames(clip, images)
    file = write_keypoints(clip.with_suffix(".keypoints.json"), posture)
    fields = json.loads(file.read_text(encoding="utf-8"))
    for frame, homography in zip(fields["frames"], moved_by, strict=True):
        for point in frame:
            point[:2] = moved(homography, np.array(point[:2])).tolist()
    write_json(file, fields)
