"""Blender's motion tracks as keypoints, and posing and measuring by keypoints where no marker is worn."""

import json
from collections.abc import Callable
from pathlib import Path

import bpy
import numpy as np
import pytest
from _results import posture_of
from keymark.core.detect.keypoints import People
from keymark.core.take.motion import Motion
from keymark.core.take.take import Take
from keymark.operators.bridge.pose import write_posture
from keymark.operators.bridge.scene_evidence import AssignedTrack, people_of_tracks
from keymark.operators.follow.evidence import clear_readings, keypoints_at
from keymark.operators.shell.take_state import TakeState
from keymark.operators.shell.takes import active_take, assigned_tracks, footage_of

FRAMES = 13
WIDTH, HEIGHT = 160, 120
STILL = ("elbow.R", "wrist.R", "knee.L", "ankle.L", "ankle.R")


def add_track(
    clip: bpy.types.MovieClip, name: str, places: dict[int, tuple[float, float]], owner: str = ""
) -> bpy.types.MovieTrackingTrack:
    """A track with markers at clip frames, from 1, at pixels from the top left corner."""
    tracks = clip.tracking.objects[owner].tracks if owner else clip.tracking.tracks
    first = min(places)
    track = tracks.new(name=name, frame=first)
    for frame, (x, y) in places.items():
        track.markers.insert_frame(frame, co=(x / WIDTH, 1.0 - y / HEIGHT))
    return track


def people(scene: bpy.types.Scene, frames: np.ndarray | None = None) -> tuple[People, ...]:
    take = active_take(scene)
    footage = footage_of(scene, take)
    shown = footage.first_frame + np.arange(FRAMES, dtype=float) if frames is None else frames
    return people_of_tracks(footage, shown, assigned_tracks(take))


def places(source: People, point: str) -> np.ndarray:
    column = source.names.index(point)
    rows = [seen.pixel[0, column] if len(seen.pixel) else (np.nan, np.nan) for seen in source.frames]
    return np.array(rows)


def test_a_track_is_seen_where_it_has_an_enabled_marker(plain: bpy.types.Scene) -> None:
    clip = active_take(plain).clip
    track = add_track(clip, "Left Wrist", {2: (40.0, 30.0), 3: (50.0, 35.0), 7: (90.0, 70.0)})
    track.markers.find_frame(3, exact=True).mute = True
    (source,) = people(plain)
    found = places(source, "wrist.L")
    assert np.flatnonzero(np.isfinite(found[:, 0])).tolist() == [1, 6]
    assert found[[1, 6]] == pytest.approx(np.array([(40.0, 30.0), (90.0, 70.0)]), abs=1e-4)
    assert source.by_hand and source.most_people == 1 and source.size == (WIDTH, HEIGHT)


def test_the_offset_of_a_track_counts_and_its_weight_is_the_score(plain: bpy.types.Scene) -> None:
    clip = active_take(plain).clip
    track = add_track(clip, "knee.R", {4: (80.0, 60.0)})
    track.offset, track.weight = (0.1, -0.05), 0.4
    add_track(clip, "knee.L", {4: (20.0, 20.0)}).weight = 0.0
    (source,) = people(plain)
    assert places(source, "knee.R")[3] == pytest.approx((96.0, 66.0), abs=1e-4)
    assert np.isnan(places(source, "knee.L")).all()
    assert source.frames[3].score[0].tolist() == pytest.approx([0.4, 0.0])


def test_tracks_stay_with_the_picture_where_the_clip_is_moved_or_trimmed(plain: bpy.types.Scene) -> None:
    clip = active_take(plain).clip
    add_track(clip, "head", {2: (40.0, 30.0)})
    for start, offset, index in ((1, 0, 1), (101, 0, 1), (101, 3, 4), (-20, 0, 1)):
        clip.frame_start, clip.frame_offset = start, offset
        (source,) = people(plain)
        found = places(source, "head")
        assert np.flatnonzero(np.isfinite(found[:, 0])).tolist() == [index], (start, offset)
        shown = [keypoints_at(active_take(plain), frame)[0].names for frame in (start, start + 1)]
        assert shown == [(), ("head",)]


def test_frames_of_a_variable_rate_are_those_that_blender_shows(plain: bpy.types.Scene) -> None:
    clip = active_take(plain).clip
    add_track(clip, "head", {1: (10.0, 10.0), 3: (30.0, 30.0), 5: (50.0, 50.0), 40: (60.0, 60.0)})
    frames = np.concatenate([[1.0, 2.4, 3.0, 4.7], 7.0 + np.arange(FRAMES - 4)])
    (source,) = people(plain, frames)
    found = places(source, "head")
    assert np.flatnonzero(np.isfinite(found[:, 0])).tolist() == [0, 2, 3]
    assert found[3] == pytest.approx((50.0, 50.0), abs=1e-4)


def test_names_assign_tracks_and_choices_change_that(plain: bpy.types.Scene) -> None:
    take = active_take(plain)
    take.clip.tracking.objects.new("Body")
    add_track(take.clip, "l_wrist", {1: (10.0, 10.0)})
    add_track(take.clip, "Track", {1: (20.0, 10.0)})
    add_track(take.clip, "Right Knee", {1: (30.0, 10.0)}, "Body")
    named = {AssignedTrack("Camera", "l_wrist", "wrist.L"), AssignedTrack("Body", "Right Knee", "knee.R")}
    assert set(assigned_tracks(take)) == named
    assert bpy.ops.keymark.assign_track(owner="Camera", track="Track", point="nose") == {"FINISHED"}
    assert bpy.ops.keymark.assign_track(owner="Camera", track="l_wrist", point="NONE") == {"FINISHED"}
    points = {each.track: each.point for each in assigned_tracks(take)}
    assert points == {"Track": "nose", "Right Knee": "knee.R"}
    bpy.ops.keymark.assign_track(owner="Camera", track="l_wrist", point="wrist.L")
    assert len(take.follow.tracks) == 1, "what the name says needs no choice"
    with pytest.raises(RuntimeError, match="has no track 'Nothing' of object 'Camera'"):
        bpy.ops.keymark.assign_track(owner="Camera", track="Nothing", point="nose")


def test_two_tracks_of_one_point_are_two_sources(plain: bpy.types.Scene) -> None:
    clip = active_take(plain).clip
    add_track(clip, "wrist.L", {1: (10.0, 10.0)})
    add_track(clip, "wrist.L.001", {9: (30.0, 10.0)})
    add_track(clip, "knee.L", {1: (50.0, 90.0)})
    first, second = people(plain)
    assert set(first.names) == {"wrist.L", "knee.L"} and second.names == ("wrist.L",)
    assert first.source != second.source
    assert np.isfinite(places(first, "wrist.L")[0]).all() and np.isfinite(places(second, "wrist.L")[8]).all()


def test_the_switch_takes_all_tracks_away(plain: bpy.types.Scene) -> None:
    take = active_take(plain)
    add_track(take.clip, "head", {1: (10.0, 10.0)})
    assert TakeState(take).has_keypoints and keypoints_at(take, 1)
    take.follow.use_tracks = False
    assert not TakeState(take).has_keypoints and keypoints_at(take, 1) == ()
    assert len(assigned_tracks(take)) == 1


def test_the_motion_follows_the_tracks(
    plain: bpy.types.Scene, plain_take: Take, wave_motion: Motion, shown_points: Callable
) -> None:
    take = active_take(plain)
    names, waved = plain_take.body.skeleton.point_names, ("elbow.L", "wrist.L")
    pixel, _ = plain_take.camera.project(wave_motion.points)
    between = np.abs(np.sin(np.pi * np.arange(FRAMES) / 6.0))  # keyframes are at frames 0, 6 and 12
    for point, farthest in (*((point, 0.0) for point in STILL), *zip(waved, (3.0, 8.0), strict=True)):
        column = names.index(point)
        rise = farthest * between
        found = {f + 1: (pixel[f, column, 0], pixel[f, column, 1] - rise[f]) for f in range(FRAMES)}
        add_track(take.clip, point, found)
    take.follow.use_contours = False
    wrist, away = names.index("wrist.L"), {}
    for method in ("map", "interpolation"):
        active_take(plain).method = method
        assert bpy.ops.keymark.reconstruct() == {"FINISHED"}
        plain.frame_set(4)
        seen, _ = plain_take.camera.project(shown_points(active_take(plain).armature))
        away[method] = abs(seen[wrist, 1] - (pixel[3, wrist, 1] - 8.0))
    assert away["interpolation"] > 6.0 and away["map"] < 0.5 * away["interpolation"]


def load(path: Path) -> bpy.types.PropertyGroup:
    assert bpy.ops.keymark.load_keypoints(filepath=str(path)) == {"FINISHED"}
    clear_readings()
    return active_take(bpy.context.scene)


def off_m(scene: bpy.types.Scene, motion: Motion, frame: int) -> float:
    body = motion.body
    points = body.points(body.pose(posture_of(scene)))
    return float(np.linalg.norm(points - motion.points[frame - 1], axis=-1).mean())


@pytest.mark.parametrize("start", ["KEYFRAMES", "POSE", "ANEW"])
def test_fitting_brings_the_pose_to_the_keypoints(
    plain: bpy.types.Scene, keypoint_file: Path, wave_motion: Motion, start: str
) -> None:
    take = load(keypoint_file)
    plain.frame_set(4)
    write_posture(take.armature, wave_motion.posture[3].plus(np.where(np.arange(34) < 6, 0.0, 0.25)))
    before = off_m(plain, wave_motion, 4)
    assert bpy.ops.keymark.fit_pose(start=start) == {"FINISHED"}
    assert off_m(plain, wave_motion, 4) < (0.25 if start == "ANEW" else 0.6 * before)


def test_a_take_with_contours_alone_cannot_be_fitted(plain: bpy.types.Scene) -> None:
    with pytest.raises(RuntimeError, match="Load keypoints"):
        bpy.ops.keymark.fit_pose()


def test_a_frame_without_anybody_says_so(plain: bpy.types.Scene, keypoint_file: Path) -> None:
    value = json.loads(keypoint_file.read_text(encoding="utf-8"))
    value["frames"][3] = None
    if "world" in value:
        value["world"][3] = None
    keypoint_file.write_text(json.dumps(value), encoding="utf-8")
    load(keypoint_file)
    plain.frame_set(4)
    before = posture_of(plain)
    with pytest.raises(RuntimeError, match="None of the keypoints is seen in frame 4"):
        bpy.ops.keymark.fit_pose()
    np.testing.assert_allclose(posture_of(plain).minus(before), 0.0, atol=1e-9)


def test_a_new_actor_stands_where_the_keypoints_are(
    plain: bpy.types.Scene, keypoint_file: Path, wave_motion: Motion
) -> None:
    take = load(keypoint_file)
    bpy.data.objects.remove(take.armature)
    take.armature = take.keyframe_action = None
    plain.frame_set(1)
    assert bpy.ops.keymark.build_actor(stature=1.72) == {"FINISHED"}
    hips = posture_of(plain).translation
    assert np.linalg.norm(hips - wave_motion.posture[0].translation) < 0.6
