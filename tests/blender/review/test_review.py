"""Being told how good a motion is: list, going to weak frames and posing there."""

from collections.abc import Callable
from dataclasses import replace
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from _performances import made_up_review
from keymark.core.review.weak_frames import Reason, WeakFrame
from keymark.core.take.motion import Motion
from keymark.core.take.take import Take
from keymark.operators.bridge.fcurves import posed_extremities, write_motion
from keymark.operators.bridge.keyframes import keyed_frames
from keymark.operators.reconstruct.live_preview import show_review
from keymark.operators.review.weak_frames import look_from_side, reason_words
from keymark.operators.shell.results import clear_review, review_of
from keymark.operators.shell.take_state import TakeState
from keymark.operators.shell.takes import active_take
from mathutils import Matrix, Quaternion, Vector

pytestmark = pytest.mark.usefixtures("registered")


@pytest.fixture
def take(tiny_take: Take, wave_motion: Motion) -> bpy.types.PropertyGroup:
    """The tiny take opened, with the true motion as the reconstructed one, reviewed."""
    bpy.ops.keymark.open_take(filepath=str(tiny_take.folder / "take.json"))
    take = active_take(bpy.context.scene)
    take.motion_action = write_motion(take.armature, wave_motion)
    show_review(take, made_up_review())
    return take


def test_reconstructing_fills_the_review(tiny_take: Take) -> None:
    bpy.ops.keymark.open_take(filepath=str(tiny_take.folder / "take.json"))
    take = active_take(bpy.context.scene)
    assert bpy.ops.keymark.reconstruct() == {"FINISHED"}
    review = review_of(take)
    assert take.review.frame_count == len(review.frames) == 13
    assert take.review.confidence == pytest.approx(review.confidence.mean())
    assert [weak.frame for weak in take.review.weak_frames] == [
        review.frames[weak.index] for weak in review.weak_frames
    ]
    take.method = "interpolation"
    bpy.ops.keymark.reconstruct()
    assert take.review.confidence < 0.0


def test_the_list_tells_frame_reason_and_marker(take: bpy.types.PropertyGroup) -> None:
    shown = [(weak.frame, weak.reason, weak.marker) for weak in take.review.weak_frames]
    assert shown == [(7.0, "HIDDEN", "Ärmel"), (4.0, "FAR", "")]
    assert take.review.confidence == pytest.approx(made_up_review().confidence.mean())
    show_review(take, made_up_review())
    assert len(take.review.weak_frames) == 2
    clear_review(take)
    assert take.review.frame_count == len(take.review.weak_frames) == 0


def test_a_method_that_cannot_tell_says_so(take: bpy.types.PropertyGroup) -> None:
    unknown = np.full(13, np.nan)
    show_review(take, replace(made_up_review(), confidence=unknown, sigma_m=np.full((13, 13), np.nan)))
    assert take.review.confidence < 0.0


def test_a_body_point_is_a_reason_by_its_name(take: bpy.types.PropertyGroup) -> None:
    weak = (WeakFrame(6, Reason.FOOTAGE, 1.0, point="wrist.L"), WeakFrame(3, Reason.HIDDEN, 0.5, marker=1))
    show_review(take, replace(made_up_review(), weak_frames=weak))
    assert [reason_words(item) for item in take.review.weak_frames] == [
        "Left wrist is off",
        "Ärmel is hidden",
    ]


def test_going_through_weak_frames(take: bpy.types.PropertyGroup) -> None:
    scene = bpy.context.scene
    scene.frame_set(1)
    visited = []
    for _ in range(2):
        assert bpy.ops.keymark.jump_to_weak_frame(direction="NEXT") == {"FINISHED"}
        visited.append(scene.frame_current)
    assert visited == [7, 4]
    assert bpy.ops.keymark.jump_to_weak_frame(direction="NEXT") == {"CANCELLED"}
    assert bpy.ops.keymark.jump_to_weak_frame(direction="PREVIOUS") == {"FINISHED"}
    assert scene.frame_current == 7
    take.review.active_weak_frame = 1
    assert scene.frame_current == 4
    clear_review(take)
    with pytest.raises(RuntimeError, match="Reconstruct the motion first"):
        bpy.ops.keymark.jump_to_weak_frame(direction="NEXT")


def test_the_reconstructed_pose_becomes_a_keyframe(
    take: bpy.types.PropertyGroup, wave_motion: Motion, shown_points: Callable[[bpy.types.Object], np.ndarray]
) -> None:
    scene = bpy.context.scene
    before = keyed_frames(take.armature, take.keyframe_action)
    scene.frame_set(1)
    take.review.active_weak_frame = 1
    scene.frame_set(2)
    assert bpy.ops.keymark.pose_from_motion(where="WEAK") == {"FINISHED"}
    assert scene.frame_current == 4
    assert take.armature.animation_data.action == take.keyframe_action
    assert keyed_frames(take.armature, take.keyframe_action) == tuple(sorted({*before, 4.0}))
    assert shown_points(take.armature) == pytest.approx(wave_motion.points[3], abs=1e-4)
    assert posed_extremities(take.armature, take.keyframe_action) == frozenset()
    assert [TakeState(take).is_posed(weak.frame) for weak in take.review.weak_frames] == [True, True]


def test_the_pose_of_the_current_frame_can_be_taken_too(take: bpy.types.PropertyGroup) -> None:
    clear_review(take)
    take.keyframe_action = None
    bpy.context.scene.frame_set(5)
    assert bpy.ops.keymark.pose_from_motion() == {"FINISHED"}
    assert keyed_frames(take.armature, take.keyframe_action) == (5.0,)
    with pytest.raises(RuntimeError, match="No weak frame is chosen"):
        bpy.ops.keymark.pose_from_motion(where="WEAK")
    take.motion_action = None
    with pytest.raises(RuntimeError, match="Reconstruct the motion first"):
        bpy.ops.keymark.pose_from_motion()


@pytest.mark.parametrize("turn", [0.0, 0.7, 2.5])
def test_the_view_is_level_with_the_camera_on_the_left(opened: bpy.types.Scene, turn: float) -> None:
    take = active_take(opened)
    take.camera.matrix_world = Matrix.Rotation(turn, 4, "Z") @ take.camera.matrix_world
    bpy.context.view_layer.update()
    view = SimpleNamespace(view_perspective="CAMERA")
    look_from_side(SimpleNamespace(region_3d=view), take.camera, take.armature)
    axes = Quaternion(view.view_rotation).to_matrix()
    away = -take.camera.matrix_world.to_3x3().col[2]
    away.z = 0.0
    assert view.view_perspective == "ORTHO"
    assert np.array(axes.col[0]) == pytest.approx(np.array(away.normalized()), abs=1e-5)
    assert np.array(axes.col[1]) == pytest.approx([0.0, 0.0, 1.0], abs=1e-5)
    assert np.array(axes.col[2]) == pytest.approx(np.array(axes.col[0].cross(axes.col[1])), abs=1e-5)
    hips = take.armature.matrix_world @ take.armature.pose.bones["pelvis"].head
    assert (Vector(view.view_location) - hips).length < 0.3
    assert 2.0 < view.view_distance < 8.0
