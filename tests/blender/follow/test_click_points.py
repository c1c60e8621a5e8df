"""Points clicked on by hand, and the click that says who the performer is."""

from collections.abc import Callable
from pathlib import Path

import bpy
import numpy as np
import pytest
from keymark.core.detect.keypoint_file import write_keypoints
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
