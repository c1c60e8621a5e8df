"""Points clicked on by hand, who the performer is, and the camera from a performer seen upright."""

from collections.abc import Callable
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
from keymark.operators.follow.evidence import clicked_here, clicks_at, keypoints_at, scene_evidence
from keymark.operators.shell.takes import active_take, footage_of

FRAMES = 13


def click(scene: bpy.types.Scene, frame: int, point: str, pixel: tuple[float, float]) -> None:
    scene.frame_set(frame)
    assert bpy.ops.keymark.click_point(point=point, pixel=pixel) == {"FINISHED"}


def test_clicks_are_kept_by_frame_and_point(plain: bpy.types.Scene) -> None:
    click(plain, 3, "wrist.L", (40.0, 50.0))
    click(plain, 3, "head", (80.0, 20.0))
    click(plain, 9, "wrist.L", (70.0, 50.0))
    click(plain, 3, "wrist.L", (44.0, 52.0))
    take = active_take(plain)
    plain.frame_set(3)
    assert sorted(clicked_here(take)) == ["head", "wrist.L"]
    seen = clicks_at(take, 3)
    assert seen.pixel[0, seen.names.index("wrist.L")].tolist() == [44.0, 52.0]
    (people,) = scene_evidence(take).people(footage_of(plain, take), 1.0 + np.arange(FRAMES))
    column = people.names.index("wrist.L")
    assert people.by_hand
    assert [index for index, frame in enumerate(people.frames) if len(frame.pixel)] == [2, 8]
    assert people.frames[8].pixel[0, column].tolist() == [70.0, 50.0]
    assert np.isnan(people.frames[8].pixel[0, people.names.index("head")]).all()


def test_clicks_stay_with_the_picture_where_the_clip_is_moved(plain: bpy.types.Scene) -> None:
    click(plain, 3, "head", (80.0, 20.0))
    take = active_take(plain)
    take.clip.frame_start = 101
    assert clicks_at(take, 103).names == ("head",) and clicks_at(take, 3).names == ()
    assert [each.source for each in keypoints_at(take, 3)] == ["clicks"], "sources keep their colors"
    (people,) = scene_evidence(take).people(footage_of(plain, take), 101.0 + np.arange(FRAMES))
    assert [index for index, frame in enumerate(people.frames) if len(frame.pixel)] == [2]
    assert scene_evidence(take).people(footage_of(plain, take), 101.0 + np.arange(2)) == ()


def test_clicks_are_removed_one_by_one_and_by_frame(plain: bpy.types.Scene) -> None:
    for point in ("head", "knee.L", "knee.R"):
        click(plain, 3, point, (40.0, 50.0))
    click(plain, 4, "head", (40.0, 50.0))
    plain.frame_set(3)
    assert bpy.ops.keymark.remove_clicks(point="head") == {"FINISHED"}
    assert clicked_here(active_take(plain)) == ["knee.L", "knee.R"]
    assert bpy.ops.keymark.remove_clicks() == {"FINISHED"}
    assert bpy.ops.keymark.remove_clicks() == {"CANCELLED"}
    assert [(each.point, each.frame) for each in active_take(plain).follow.clicks] == [("head", 3)]


def test_a_click_outside_the_picture_is_refused(plain: bpy.types.Scene) -> None:
    with pytest.raises(RuntimeError, match=r"\(500, 3\) lies outside the footage, which is 160 x 120"):
        bpy.ops.keymark.click_point(point="head", pixel=(500.0, 3.0))
    assert len(active_take(plain).follow.clicks) == 0


def test_a_click_says_who_the_performer_is(
    plain: bpy.types.Scene, keypoint_file: Path, plain_take: Take, wave_motion: Motion, seen_by: Callable
) -> None:
    people = seen_by(plain_take, wave_motion, others=1)
    write_keypoints(keypoint_file, people, 1, plain_take.fps)
    with pytest.raises(RuntimeError, match="Load keypoints first"):
        bpy.ops.keymark.click_performer(pixel=(80.0, 60.0))
    bpy.ops.keymark.load_keypoints(filepath=str(keypoint_file))
    plain.frame_set(4)
    other = people.frames[3].pixel[1]
    wrist = people.names.index("wrist.L")
    assert bpy.ops.keymark.click_performer(pixel=tuple(other[wrist] + 1.0)) == {"FINISHED"}
    seen = clicks_at(active_take(plain), 4)
    assert seen.names == ("wrist.L",)
    assert seen.pixel[0, 0] == pytest.approx(other[wrist], abs=0.1)
    plain.frame_set(90)
    with pytest.raises(RuntimeError, match="No detector sees anybody in frame 90"):
        bpy.ops.keymark.click_performer(pixel=(80.0, 60.0))


WALKED = 64
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
    for _ in range(WALKED):
        writer.write(noise.integers(80, 100, (*plain_take.camera.resolution[::-1], 3), np.uint8))
    writer.release()
    bpy.ops.keymark.load_footage(filepath=str(clip))
    take = active_take(bpy.context.scene)
    take.camera.data.lens, take.stature = plain_take.camera.lens_mm, plain_take.body.actor.stature_m
    bpy.ops.keymark.load_keypoints(filepath=str(walking_file(plain_take, WALKED, tmp_path / "walk.json")))
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
