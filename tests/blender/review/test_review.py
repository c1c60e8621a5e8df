"""Being told how good a motion is: list, curves, going to weak frames and posing there."""

from collections.abc import Callable
from dataclasses import replace
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from _performances import made_up_review
from keymark.core.body.human import HUMAN
from keymark.core.review.compared_keypoints import ComparedKeypoints
from keymark.core.review.weak_frames import Reason, WeakFrame
from keymark.core.take.motion import Motion
from keymark.core.take.take import Take
from keymark.operators.bridge.actions import existing_channelbag
from keymark.operators.bridge.extremity_curves import posed_extremities
from keymark.operators.bridge.fcurves import moved_paths, write_motion
from keymark.operators.bridge.keyframes import keyed_frames
from keymark.operators.bridge.review_curves import GROUP, SUFFIX, curve_path, write_review_curves
from keymark.operators.reconstruct.live_preview import show_review
from keymark.operators.review.weak_frames import look_from_side, reason_words
from keymark.operators.shell.results import clear_review, review_of
from keymark.operators.shell.take_state import TakeState
from keymark.operators.shell.takes import active_take
from mathutils import Matrix, Quaternion, Vector

NO_KEYPOINTS = ComparedKeypoints.none(13)
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
    keys = curve(take, "Confidence").keyframe_points
    assert [key.co[1] for key in keys] == pytest.approx(review.confidence, abs=1e-5)
    take.method = "interpolation"
    bpy.ops.keymark.reconstruct()
    assert take.review.confidence < 0.0 and curve(take, "Confidence") is None


def curve(take: bpy.types.PropertyGroup, name: str) -> bpy.types.FCurve | None:
    return existing_channelbag(take.motion_action, take.armature).fcurves.find(curve_path(name))


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
    assert curve(take, "Confidence") is None and curve(take, "Sigma head mm") is None
    assert "Confidence" + SUFFIX not in take.armature
    assert curve(take, "Nearness") is not None


def test_curves_hold_the_reviews_numbers(take: bpy.types.PropertyGroup) -> None:
    review = made_up_review()
    keypoints = review.keypoints
    distances = np.concatenate(
        [review.reprojection_px, np.where(keypoints.thrown_out, np.nan, keypoints.distance_px)], axis=1
    )
    expected = {
        "Confidence": review.confidence,
        "Nearness": review.nearness,
        "Reprojection px": np.nanmean(distances, axis=1),
        "Sigma wrist.L mm": 1e3 * review.sigma_m[:, HUMAN.point_names.index("wrist.L")],
    }
    for name, values in expected.items():
        found = curve(take, name)
        assert found.group.name == GROUP
        known = np.isfinite(values)
        assert [key.co[0] for key in found.keyframe_points] == pytest.approx(review.frames[known])
        assert [key.co[1] for key in found.keyframe_points] == pytest.approx(values[known], rel=1e-5)
        assert {key.type for key in found.keyframe_points} == {"GENERATED"}
    assert len(curve(take, "Reprojection px").keyframe_points) == 13


def test_frames_in_which_nothing_is_compared_have_no_key(take: bpy.types.PropertyGroup) -> None:
    write_review_curves(take.armature, take.motion_action, replace(made_up_review(), keypoints=NO_KEYPOINTS))
    assert len(curve(take, "Reprojection px").keyframe_points) == 12


def test_a_body_point_is_a_reason_by_its_name(take: bpy.types.PropertyGroup) -> None:
    weak = (WeakFrame(6, Reason.FOOTAGE, 1.0, point="wrist.L"), WeakFrame(3, Reason.HIDDEN, 0.5, marker=1))
    show_review(take, replace(made_up_review(), weak_frames=weak))
    assert [reason_words(item) for item in take.review.weak_frames] == [
        "Off: Wrist Left",
        "Hidden: Ärmel",
    ]


def test_curves_animate_properties_with_ranges_and_words(take: bpy.types.PropertyGroup) -> None:
    scene = bpy.context.scene
    scene.frame_set(7)
    shown = take.armature.evaluated_get(bpy.context.evaluated_depsgraph_get())
    assert shown["Confidence" + SUFFIX] == pytest.approx(0.4, abs=1e-5)
    interface = take.armature.id_properties_ui("Confidence" + SUFFIX).as_dict()
    assert (interface["min"], interface["soft_max"]) == (0.0, 1.0)
    assert "height" in interface["description"]


def test_curves_disturb_neither_pose_nor_keyframes(
    take: bpy.types.PropertyGroup, wave_motion: Motion, shown_points: Callable[[bpy.types.Object], np.ndarray]
) -> None:
    for frame in (1, 7, 13):
        bpy.context.scene.frame_set(frame)
        assert shown_points(take.armature) == pytest.approx(wave_motion.points[frame - 1], abs=1e-4)
    assert keyed_frames(take.armature, take.motion_action, HUMAN) == ()
    assert not any(path.startswith("[") for path in moved_paths(take.armature, HUMAN))


def test_a_second_review_replaces_the_first_but_not_the_animators_keys(take: bpy.types.PropertyGroup) -> None:
    own = curve(take, "Confidence").keyframe_points.insert(4.0, 0.123)
    own.type = "KEYFRAME"
    write_review_curves(take.armature, take.motion_action, made_up_review(frames=9))
    points = curve(take, "Confidence").keyframe_points
    assert [key.co[0] for key in points] == [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0]
    assert points[3].co[1] == pytest.approx(0.123)


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
    before = keyed_frames(take.armature, take.keyframe_action, HUMAN)
    scene.frame_set(1)
    take.review.active_weak_frame = 1
    scene.frame_set(2)
    assert bpy.ops.keymark.pose_from_motion(where="WEAK") == {"FINISHED"}
    assert scene.frame_current == 4
    assert take.armature.animation_data.action == take.keyframe_action
    assert keyed_frames(take.armature, take.keyframe_action, HUMAN) == tuple(sorted({*before, 4.0}))
    assert shown_points(take.armature) == pytest.approx(wave_motion.points[3], abs=1e-4)
    assert posed_extremities(take.armature, HUMAN, take.keyframe_action) == frozenset()
    assert [TakeState(take).is_posed(weak.frame) for weak in take.review.weak_frames] == [True, True]
    assert len(curve(take, "Confidence").keyframe_points) == 13


def test_the_pose_of_the_current_frame_can_be_taken_too(take: bpy.types.PropertyGroup) -> None:
    clear_review(take)
    take.keyframe_action = None
    bpy.context.scene.frame_set(5)
    assert bpy.ops.keymark.pose_from_motion() == {"FINISHED"}
    assert keyed_frames(take.armature, take.keyframe_action, HUMAN) == (5.0,)
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
