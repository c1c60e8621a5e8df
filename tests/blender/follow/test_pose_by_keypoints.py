"""Posing and measuring by keypoints where no marker is worn."""

import json
from pathlib import Path

import bpy
import numpy as np
import pytest
from _results import posture_of
from keymark.core.take.motion import Motion
from keymark.operators.bridge.pose import write_posture
from keymark.operators.follow.evidence import clear_readings
from keymark.operators.shell.takes import active_take


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
