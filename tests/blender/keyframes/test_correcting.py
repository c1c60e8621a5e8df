"""Correcting the pose: flipped depth, turns, a neighbor's pose, a joint moved, as scripted operators."""

from collections.abc import Callable

import bpy
import numpy as np
import pytest
from _results import posture_of
from keymark.core.body.human import HUMAN
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture
from keymark.core.poses.turned import Facing, facing_of
from keymark.operators.bridge.actor_bones import joint_places
from keymark.operators.bridge.armature import read_body
from keymark.operators.bridge.keyframes import keyed_frames, unchanged_keyframes
from keymark.operators.bridge.keys import PICTURED
from keymark.operators.bridge.pose import write_posture
from keymark.operators.keyframes.corrections import camera_now, selected_limbs
from keymark.operators.shell.take_state import TakeState
from keymark.operators.shell.takes import active_take

pytestmark = pytest.mark.usefixtures("registered")


def select(scene: bpy.types.Scene, *names: str) -> None:
    armature_object = active_take(scene).armature
    bpy.context.view_layer.objects.active = armature_object
    if armature_object.mode != "POSE":
        bpy.ops.object.mode_set(mode="POSE")
    for bone in armature_object.pose.bones:
        target = bone if hasattr(bone, "select") else bone.bone
        target.select = bone.name in names


def reaching(scene: bpy.types.Scene) -> Posture:
    """The actor reaches forward with its left arm, bent, in the frame that is shown."""
    vector = posture_of(scene).to_vector()
    for name, value in {
        "shoulder.L.rotation_x": 0.0,
        "shoulder.L.rotation_y": 0.2,
        "shoulder.L.rotation_z": -0.5,
        "elbow.L.flexion": 0.5,
    }.items():
        vector[HUMAN.dof_names.index(name)] = value
    posture = Posture.from_vector(HUMAN, vector)
    write_posture(active_take(scene).armature, posture)
    return posture


def points_of(scene: bpy.types.Scene) -> np.ndarray:
    """The 13 points that the actor shows [m]."""
    body = read_body(active_take(scene).armature)
    return body.points(body.pose(posture_of(scene)))


def test_flipping_keeps_the_image_and_sets_no_key_in_an_unposed_frame(opened: bpy.types.Scene) -> None:
    take = active_take(opened)
    opened.frame_set(4)
    before = reaching(opened)
    keys = keyed_frames(take.armature, take.keyframe_action)
    seen, camera = points_of(opened), camera_now(opened, take)
    select(opened, "forearm.L")
    assert selected_limbs(take) == ["arm.L"]
    assert bpy.ops.keymark.flip_depth() == {"FINISHED"}
    flipped = points_of(opened)
    elbow = HUMAN.point_names.index("elbow.L")
    assert np.linalg.norm(flipped[elbow] - seen[elbow]) > 0.05
    np.testing.assert_allclose(camera.project(flipped)[0], camera.project(seen)[0], atol=1.0)
    assert keyed_frames(take.armature, take.keyframe_action) == keys
    shown = [posture_of(opened)]
    for _ in range(3):
        bpy.ops.keymark.flip_depth()
        shown.append(posture_of(opened))
    assert min(float(np.abs(each.minus(before)).max()) for each in shown) < 1e-4


def test_flipping_in_a_posed_frame_changes_its_keyframe_at_once(opened: bpy.types.Scene) -> None:
    take = active_take(opened)
    opened.frame_set(7)
    reaching(opened)
    bpy.ops.keymark.store_keyframe()
    frames = TakeState(take).posed
    select(opened, "upper_arm.L")
    bpy.ops.keymark.flip_depth()
    flipped = posture_of(opened)
    opened.frame_set(1)
    first = posture_of(opened)
    opened.frame_set(7)
    np.testing.assert_allclose(posture_of(opened).minus(flipped), 0.0, atol=1e-4)
    assert TakeState(take).posed == frames
    opened.frame_set(1)
    np.testing.assert_allclose(posture_of(opened).minus(first), 0.0, atol=1e-6)


def test_flipping_asks_for_a_selected_bone(opened: bpy.types.Scene) -> None:
    select(opened)
    with pytest.raises(RuntimeError, match="Select a bone of an arm, a leg or the trunk"):
        bpy.ops.keymark.flip_depth()


def test_with_all_bones_selected_the_active_one_counts(opened: bpy.types.Scene) -> None:
    take = active_take(opened)
    select(opened, *take.armature.pose.bones.keys())
    take.armature.data.bones.active = take.armature.data.bones["shin.R"]
    assert selected_limbs(take) == ["leg.R"]


@pytest.mark.parametrize("facing", ["CAMERA", "LEFT", "RIGHT", "AWAY"])
def test_the_performer_turns_in_place(opened: bpy.types.Scene, facing: str) -> None:
    take = active_take(opened)
    opened.frame_set(4)
    before = posture_of(opened).translation
    assert bpy.ops.keymark.turn_performer(facing=facing, fit=False) == {"FINISHED"}
    assert facing_of(posture_of(opened), camera_now(opened, take)) is Facing[facing]
    np.testing.assert_allclose(posture_of(opened).translation, before, atol=1e-4)


def test_a_turned_pose_is_fitted_to_the_footage(opened: bpy.types.Scene) -> None:
    opened.frame_set(4)
    true = points_of(opened)
    bpy.ops.keymark.turn_performer(facing="AWAY", sides="TURN", fit=False)
    turned = np.linalg.norm(points_of(opened) - true, axis=-1).mean()
    bpy.ops.keymark.turn_performer(facing="CAMERA")
    assert np.linalg.norm(points_of(opened) - true, axis=-1).mean() < 0.6 * turned


def test_turning_outside_the_footage_needs_no_fit(opened: bpy.types.Scene) -> None:
    opened.frame_set(40)
    assert bpy.ops.keymark.turn_performer(facing="RIGHT") == {"FINISHED"}
    camera = camera_now(opened, active_take(opened))
    assert facing_of(posture_of(opened), camera) is Facing.RIGHT


@pytest.mark.parametrize(("direction", "frame"), [("PREVIOUS", 7), ("NEXT", 13)])
def test_a_neighbors_pose_is_copied_to_the_place_of_this_frame(
    opened: bpy.types.Scene, direction: str, frame: int
) -> None:
    take = active_take(opened)
    opened.frame_set(frame)
    there = posture_of(opened)
    opened.frame_set(10)
    here = posture_of(opened)
    keys = TakeState(take).posed
    assert bpy.ops.keymark.copy_neighbor(direction=direction) == {"FINISHED"}
    copied = posture_of(opened)
    np.testing.assert_allclose(copied.translation, here.translation, atol=1e-5)
    np.testing.assert_allclose(copied.minus(there)[3:], 0.0, atol=1e-4)
    assert opened.frame_current == 10 and TakeState(take).posed == keys


def test_beyond_the_last_keyframe_there_is_no_neighbor(opened: bpy.types.Scene) -> None:
    opened.frame_set(13)
    before = posture_of(opened)
    assert bpy.ops.keymark.copy_neighbor(direction="NEXT") == {"CANCELLED"}
    np.testing.assert_allclose(posture_of(opened).minus(before), 0.0, atol=1e-9)


def test_a_moved_joint_lies_where_it_was_moved_to(opened: bpy.types.Scene) -> None:
    opened.frame_set(7)
    place = points_of(opened)[HUMAN.point_names.index("wrist.R")] + [0.05, 0.0, 0.08]
    bpy.ops.keymark.move_joint(joint="wrist.R", place=place, sight=(0.0, 1.0, 0.0))
    opened.frame_set(1)
    opened.frame_set(7)
    moved = points_of(opened)[HUMAN.point_names.index("wrist.R")]
    np.testing.assert_allclose(moved[[0, 2]], place[[0, 2]], atol=2e-3)


def test_correcting_the_shown_motion_goes_on_with_the_keyframes(opened: bpy.types.Scene) -> None:
    take = active_take(opened)
    take.method = "interpolation"
    bpy.ops.keymark.reconstruct()
    opened.frame_set(4)
    place = points_of(opened)[HUMAN.point_names.index("wrist.L")] + [0.0, 0.0, 0.05]
    bpy.ops.keymark.move_joint(joint="wrist.L", place=place, sight=(0.0, 1.0, 0.0))
    assert take.armature.animation_data.action == take.keyframe_action
    np.testing.assert_allclose(points_of(opened)[HUMAN.point_names.index("wrist.L")][2], place[2], atol=2e-3)
    assert 4.0 not in TakeState(take).posed


def test_joints_are_read_from_bones(
    opened: bpy.types.Scene, body: Body, random_posture: Callable[[int], Posture]
) -> None:
    write_posture(active_take(opened).armature, random_posture(4))
    np.testing.assert_allclose(joint_places(active_take(opened).armature), points_of(opened), atol=1e-4)


def test_undo_takes_a_correction_back(opened: bpy.types.Scene) -> None:
    opened.frame_set(7)
    before = posture_of(opened)
    bpy.ops.ed.undo_push(message="before")
    place = points_of(opened)[HUMAN.point_names.index("ankle.L")] + [0.1, 0.0, 0.1]
    bpy.ops.keymark.move_joint(joint="ankle.L", place=place, sight=(0.0, 1.0, 0.0))
    bpy.ops.ed.undo_push(message="moved")
    bpy.ops.ed.undo()
    scene = bpy.context.scene
    scene.frame_set(1)
    scene.frame_set(7)
    np.testing.assert_allclose(posture_of(scene).minus(before), 0.0, atol=1e-5)


def pictured(take: bpy.types.PropertyGroup) -> tuple[float, ...]:
    """Frames that count as put right in the picture alone."""
    return unchanged_keyframes(take.armature, take.keyframe_action, PICTURED)


@pytest.mark.usefixtures("still_neighbors")
def test_a_drag_in_the_cameras_view_vouches_for_the_picture_and_one_in_depth_for_more(
    found: bpy.types.PropertyGroup,
) -> None:
    scene = bpy.context.scene
    (frame, *_) = TakeState(found).matched
    scene.frame_set(int(frame))

    def drag(pushed: bool = False, aside: bool = False) -> None:
        wrist = points_of(scene)[HUMAN.point_names.index("wrist.R")]
        sight = camera_now(scene, found).sight(wrist)
        sight = np.array([sight[1], -sight[0], 0.0]) if aside else sight
        place = wrist + [0.0, 0.0, 0.03]
        bpy.ops.keymark.move_joint(joint="wrist.R", place=place, sight=sight, pushed=pushed)

    drag()
    assert pictured(found) == (frame,) and frame not in TakeState(found).matched
    bpy.ops.keymark.store_keyframe()  # as it is
    assert pictured(found) == (frame,)
    drag(aside=True)
    assert pictured(found) == ()
    drag()  # its depth stays vouched for
    assert pictured(found) == () and frame in TakeState(found).posed


@pytest.mark.usefixtures("still_neighbors")
def test_a_found_keyframe_that_is_accepted_keeps_its_depth_as_sure_as_it_was(
    found: bpy.types.PropertyGroup,
) -> None:
    (frame, *_) = TakeState(found).matched
    bpy.context.scene.frame_set(int(frame))
    bpy.ops.keymark.accept_match()
    assert pictured(found) == (frame,) and frame in TakeState(found).posed
    reaching(bpy.context.scene)
    bpy.ops.keymark.store_keyframe()  # posed by hand
    assert pictured(found) == ()
