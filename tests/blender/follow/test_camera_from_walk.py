"""The camera from the performer whom a detector's keypoints show upright."""

from dataclasses import replace
from pathlib import Path

import bpy
import cv2
import numpy as np
import pytest
from keymark.core.arrays import Array
from keymark.core.body.body_volume import standing_posture
from keymark.core.body.posture import Posture
from keymark.core.camera.camera_fields import CameraPlacement
from keymark.core.detect.keypoint_file import write_keypoints
from keymark.core.detect.keypoints import People, SeenPeople
from keymark.core.take.motion import Motion
from keymark.core.take.take import Take
from keymark.operators.shell.takes import active_take

FRAMES = 64
HEIGHT_M, TILT = 1.1, float(np.radians(-9.0))


def seen_file(take: Take, points: Array, path: Path) -> Path:
    """What a detector sees of principal points (F, 13, 3) in the take's pictures."""
    names = take.body.skeleton.point_names
    pixel = take.camera.project(points)[0] + np.random.default_rng(2).normal(0.0, 0.3, (*points.shape[:2], 2))
    score, unknown = np.full((1, len(names)), 0.9), np.full((1, len(names), 3), np.nan)
    frames = tuple(SeenPeople(places[None], score, unknown) for places in pixel)
    write_keypoints(path, People(names, "truth", take.camera.resolution, frames), 1, take.fps)
    return path


def walking_file(take: Take, frames: int, path: Path) -> Path:
    """Keypoints of someone who comes near, before a camera that looks down."""
    share = np.clip(np.linspace(-0.8, 1.8, frames), 0.0, 1.0)[:, None]
    places = (1.0 - share) * [-0.8, 7.0, 0.0] + share * [0.4, 3.6, 0.0]
    posture = Posture.stack([standing_posture(take.body, place) for place in places])
    pose = CameraPlacement(HEIGHT_M, TILT, 0.0).matrix()
    filmed = replace(take, camera=replace(take.camera, matrix_world=pose))
    return seen_file(filmed, take.body.points(take.body.pose(posture)), path)


@pytest.mark.usefixtures("registered")
def test_a_walk_sets_height_and_tilt(plain_take: Take, tmp_path: Path) -> None:
    clip = tmp_path / "room.mp4"
    writer = cv2.VideoWriter(
        str(clip), cv2.VideoWriter_fourcc(*"mp4v"), plain_take.fps, plain_take.camera.resolution
    )
    noise = np.random.default_rng(0)  # the same picture twice is one observation
    for _ in range(FRAMES):
        writer.write(noise.integers(80, 100, (*plain_take.camera.resolution[::-1], 3), np.uint8))
    writer.release()
    bpy.ops.keymark.load_footage(filepath=str(clip))
    take = active_take(bpy.context.scene)
    take.camera.data.lens, take.stature = plain_take.camera.lens_mm, plain_take.body.actor.stature_m
    bpy.ops.keymark.load_keypoints(filepath=str(walking_file(plain_take, FRAMES, tmp_path / "walk.json")))
    assert bpy.ops.keymark.camera_from_lines(kind="HEIGHT") == {"FINISHED"}
    take = active_take(bpy.context.scene)
    assert take.camera_height == pytest.approx(HEIGHT_M, abs=0.15)
    assert take.camera_tilt == pytest.approx(TILT, abs=np.radians(2.5))
    with pytest.raises(RuntimeError, match="has no lines"):
        bpy.ops.keymark.camera_from_lines(kind="VERTICAL")
    assert take.camera.data.lens == pytest.approx(plain_take.camera.lens_mm) and take.camera_findings


def test_who_never_stands_is_no_measure(
    plain: bpy.types.Scene, plain_take: Take, wave_motion: Motion
) -> None:
    with pytest.raises(RuntimeError, match="has no lines"):
        bpy.ops.keymark.camera_from_lines(kind="HEIGHT")
    lying = np.array(wave_motion.points)[..., [2, 1, 0]]
    path = seen_file(plain_take, lying, plain_take.folder / "lying.json")
    bpy.ops.keymark.load_keypoints(filepath=str(path))
    before = active_take(plain).camera_height
    with pytest.raises(RuntimeError, match="has no lines"):
        bpy.ops.keymark.camera_from_lines(kind="HEIGHT")
    assert active_take(plain).camera_height == before
