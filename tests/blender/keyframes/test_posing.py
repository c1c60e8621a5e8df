"""Posing the actor over the footage: fitting, storing and proposing keyframes, as scripted operators."""

from collections.abc import Iterator
from dataclasses import replace

import bpy
import numpy as np
import pytest
from _results import posture_of
from keymark.core.errors import InputError
from keymark.core.take.motion import Motion
from keymark.core.take.take import Take
from keymark.operators.bridge.armature import read_body
from keymark.operators.bridge.keyframes import keyed_frames, read_keyframes
from keymark.operators.bridge.pose import write_posture
from keymark.operators.bridge.take_from_scene import fit_to_frame, frame_in_footage
from keymark.operators.follow.evidence import scene_evidence
from keymark.operators.shell.notes import note_contradictions
from keymark.operators.shell.results import reading_of
from keymark.operators.shell.take_state import TakeState
from keymark.operators.shell.takes import active_take, footage_of

pytestmark = pytest.mark.usefixtures("registered")


def off_m(scene: bpy.types.Scene, motion: Motion, frame: int) -> float:
    body = motion.body
    return float(
        np.linalg.norm(body.points(body.pose(posture_of(scene))) - motion.points[frame - 1], axis=-1).mean()
    )


@pytest.mark.parametrize("start", ["KEYFRAMES", "POSE", "ANEW"])
def test_fitting_brings_the_pose_to_the_markers(
    opened: bpy.types.Scene, wave_motion: Motion, start: str
) -> None:
    take = active_take(opened)
    opened.frame_set(4)
    rough = wave_motion.posture[3].plus(np.where(np.arange(34) < 6, 0.0, 0.25))
    write_posture(take.armature, rough)
    before = off_m(opened, wave_motion, 4)
    keys = keyed_frames(take.armature, take.keyframe_action)
    assert bpy.ops.keymark.fit_pose(start=start) == {"FINISHED"}
    fitted = posture_of(opened)
    assert off_m(opened, wave_motion, 4) < (0.25 if start == "ANEW" else 0.8 * before)
    bpy.context.view_layer.update()
    bpy.context.evaluated_depsgraph_get().update()
    np.testing.assert_allclose(posture_of(opened).minus(fitted), 0.0, atol=1e-5)
    assert keyed_frames(take.armature, take.keyframe_action) == keys
    assert take.armature.animation_data.action == take.keyframe_action


def test_what_was_fitted_is_stored_and_read_back(opened: bpy.types.Scene) -> None:
    take = active_take(opened)
    opened.frame_set(4)
    bpy.ops.keymark.fit_pose()
    fitted = posture_of(opened)
    bpy.ops.keymark.store_keyframe()
    opened.frame_set(1)
    opened.frame_set(4)
    np.testing.assert_allclose(posture_of(opened).minus(fitted), 0.0, atol=1e-4)
    assert 4.0 in TakeState(take).posed


def test_the_first_keyframe_is_fitted_from_standing(
    unposed_scene: bpy.types.Scene, wave_motion: Motion
) -> None:
    unposed_scene.frame_set(5)
    bpy.ops.keymark.build_actor(stature=1.72)
    before = off_m(unposed_scene, wave_motion, 5)
    bpy.ops.keymark.fit_pose()
    assert off_m(unposed_scene, wave_motion, 5) < 0.95 * before


def test_fitting_outside_the_footage_says_where_it_is(opened: bpy.types.Scene) -> None:
    opened.frame_set(40)
    before = posture_of(opened)
    with pytest.raises(RuntimeError, match="whose frames are 1 to 13"):
        bpy.ops.keymark.fit_pose()
    np.testing.assert_allclose(posture_of(opened).minus(before), 0.0, atol=1e-9)


def test_storing_while_the_motion_is_shown_goes_to_the_keyframes(opened: bpy.types.Scene) -> None:
    take = active_take(opened)
    take.method = "interpolation"
    bpy.ops.keymark.reconstruct()
    assert take.armature.animation_data.action == take.motion_action
    opened.frame_set(4)
    shown = posture_of(opened)
    bpy.ops.keymark.store_keyframe()
    assert take.armature.animation_data.action == take.keyframe_action
    assert 4.0 in keyed_frames(take.armature, take.keyframe_action)
    assert keyed_frames(take.armature, take.motion_action) == ()
    np.testing.assert_allclose(posture_of(opened).minus(shown), 0.0, atol=1e-4)


def test_fitting_while_the_motion_is_shown_shows_the_keyframes(opened: bpy.types.Scene) -> None:
    take = active_take(opened)
    take.method = "interpolation"
    bpy.ops.keymark.reconstruct()
    opened.frame_set(4)
    bpy.ops.keymark.fit_pose(start="ANEW")
    fitted = posture_of(opened)
    assert take.armature.animation_data.action == take.keyframe_action
    bpy.context.view_layer.update()
    np.testing.assert_allclose(posture_of(opened).minus(fitted), 0.0, atol=1e-5)
    opened.frame_set(4)
    assert np.abs(posture_of(opened).minus(fitted)).max() > 0.01


def test_posed_proposals_are_counted_wherever_keys_are_moved(opened: bpy.types.Scene) -> None:
    take = active_take(opened)
    take.proposals.clear()
    for frame in (1, 4, 7, 10, 13):
        take.proposals.add().frame = frame
    assert TakeState(take).posed == (1.0, 7.0, 13.0)
    assert TakeState(take).unposed == [4, 10]
    opened.frame_set(4)
    bpy.ops.keymark.jump_to_proposal(direction="NEXT", skip_posed=True)
    assert opened.frame_current == 10
    bpy.ops.keymark.jump_to_proposal(direction="NEXT", skip_posed=True)
    assert opened.frame_current == 4
    for fcurve in take.keyframe_action.layers[0].strips[0].channelbags[0].fcurves:
        fcurve.keyframe_points[1].co.x = 4.0
        fcurve.update()
    take.keyframe_action.update_tag()
    bpy.context.view_layer.update()
    assert TakeState(take).posed == (1.0, 4.0, 13.0)
    assert TakeState(take).unposed == [7, 10]


def test_a_moving_camera_sees_the_pose_from_where_it_is(opened: bpy.types.Scene, wave_motion: Motion) -> None:
    take = active_take(opened)
    camera = take.camera
    for frame, aside in ((1, 0.6), (4, 0.0), (13, 0.9)):
        camera.location.x = camera.location.x + aside
        camera.keyframe_insert("location", frame=frame)
        camera.location.x = camera.location.x - aside
    opened.frame_set(4)
    write_posture(take.armature, wave_motion.posture[3].plus(np.where(np.arange(34) < 6, 0.0, 0.25)))
    before = off_m(opened, wave_motion, 4)
    bpy.ops.keymark.fit_pose(start="POSE")
    assert off_m(opened, wave_motion, 4) < 0.8 * before


def test_a_moving_camera_is_read_without_losing_what_is_posed(opened: bpy.types.Scene) -> None:
    take = active_take(opened)
    opened.frame_set(5)
    camera = take.camera
    camera.keyframe_insert("location", frame=1)
    camera.location.x += 0.01
    camera.keyframe_insert("location", frame=13)
    take.armature.pose.bones["head"].rotation_quaternion = (0.8, 0.6, 0.0, 0.0)
    bpy.context.view_layer.update()
    before = [np.array(bone.matrix_basis) for bone in take.armature.pose.bones]
    frame = frame_in_footage(footage_of(opened, take), scene_evidence(take))
    fit_to_frame(frame, take.armature, take.keyframe_action, "POSE")
    bpy.context.view_layer.update()
    after = [np.array(bone.matrix_basis) for bone in take.armature.pose.bones]
    np.testing.assert_allclose(after, before, atol=1e-6)


def test_in_two_scenes_the_frame_of_the_one_worked_in_counts(opened: bpy.types.Scene) -> None:
    opened.frame_set(1)
    first = posture_of(opened)
    bpy.ops.scene.new(type="LINK_COPY")
    copy = bpy.context.scene
    assert copy != opened and opened in active_take(copy).armature.users_scene
    copy.frame_set(7)
    apart = np.abs(posture_of(copy).minus(first)).max()
    opened_again = read_keyframes(
        copy,
        active_take(copy).armature,
        active_take(copy).keyframe_action,
        read_body(active_take(copy).armature),
        np.arange(1.0, 14.0),
    ).keyframes
    assert apart > 0.01
    assert np.abs(opened_again[0].posture.minus(opened_again[1].posture)).max() > 0.01


def test_posed_frames_are_those_of_this_very_action(opened: bpy.types.Scene, tiny_take: Take) -> None:
    take = active_take(opened)
    before, name = TakeState(take).posed, take.keyframe_action.name
    assert len(before) == len(tiny_take.keyframes)
    bpy.data.actions.remove(take.keyframe_action)
    take.keyframe_action = bpy.data.actions.new(name)
    assert take.keyframe_action.name == name and TakeState(take).posed == ()


def test_a_frame_between_those_of_a_varying_rate_says_which_to_go_to(opened: bpy.types.Scene) -> None:
    take = active_take(opened)
    bpy.ops.keymark.propose_keyframes()
    reading = reading_of(take)
    stretched = reading.tracks.time_s.copy()
    stretched[6:] += 2.0 / 25.0
    varying = replace(reading, tracks=replace(reading.tracks, time_s=stretched))
    opened.frame_set(7)
    with pytest.raises(InputError, match="no frame of its own at 7; go to frame 6"):
        frame_in_footage(footage_of(opened, take), scene_evidence(take), varying)
    opened.frame_set(40)
    with pytest.raises(InputError, match="lies outside the footage"):
        frame_in_footage(footage_of(opened, take), scene_evidence(take), varying)


@pytest.fixture
def fitted(opened: bpy.types.Scene) -> Iterator[bpy.types.Scene]:
    opened.frame_set(4)
    assert bpy.ops.keymark.fit_pose(start="ANEW") == {"FINISHED"}
    yield opened


def test_a_fitted_frame_offers_other_poses_and_keys_none(fitted: bpy.types.Scene) -> None:
    take = active_take(fitted)
    offered = TakeState(take).offered_at(4.0)
    assert offered is not None and offered.chosen == 0
    assert 4.0 not in TakeState(take).posed
    first = posture_of(fitted)
    assert bpy.ops.keymark.show_offered(candidate=1) == {"FINISHED"}
    assert np.abs(posture_of(fitted).minus(first)).max() > 0.05
    assert TakeState(take).offered_at(4.0).chosen == 1
    assert bpy.ops.keymark.show_offered(candidate=0) == {"FINISHED"}
    np.testing.assert_allclose(posture_of(fitted).minus(first), 0.0, atol=1e-4)
    assert TakeState(take).offered_at(5.0) is None
    with pytest.raises(RuntimeError, match="candidate must be 0 to"):
        bpy.ops.keymark.show_offered(candidate=9)


def test_storing_the_pose_ends_the_choice(fitted: bpy.types.Scene) -> None:
    take = active_take(fitted)
    note_contradictions(take, 4.0, ("trunk",))
    bpy.ops.keymark.store_keyframe()
    assert TakeState(take).offered_at(4.0) is None
    assert TakeState(take).contradictions_at(4.0) == ()
    with pytest.raises(RuntimeError, match="offers no poses"):
        bpy.ops.keymark.show_offered(candidate=0)


def test_what_contradicts_is_kept_until_the_frame_is_fitted_otherwise(fitted: bpy.types.Scene) -> None:
    take = active_take(fitted)
    name = take.markers[0].name
    note_contradictions(take, 4.0, (name,))
    bpy.ops.ed.undo_push(message="noted")
    fitted.frame_set(1)
    fitted.frame_set(4)
    assert TakeState(take).contradictions_at(4.0) == (name,)
    bpy.ops.keymark.fit_pose(start="ANEW")
    assert TakeState(active_take(fitted)).contradictions_at(4.0) == ()
    bpy.ops.ed.undo_push(message="fitted")
    bpy.ops.ed.undo()
    assert TakeState(active_take(bpy.context.scene)).contradictions_at(4.0) == (name,)


def test_a_pose_that_is_only_brought_nearer_offers_no_other(opened: bpy.types.Scene) -> None:
    opened.frame_set(4)
    bpy.ops.keymark.fit_pose(start="POSE")
    assert TakeState(active_take(opened)).offered_at(4.0) is None
