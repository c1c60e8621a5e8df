"""Building, measuring and resizing the actor, as scripted operators."""

import bpy
import numpy as np
import pytest
from _results import posture_of
from keymark.core.body.body_volume import hip_height_m, standing_height_m
from keymark.core.take.motion import Motion
from keymark.core.take.take import Take
from keymark.operators.bridge.armature import read_body
from keymark.operators.bridge.keyframes import keyed_frames
from keymark.operators.shell.takes import active_take

pytestmark = pytest.mark.usefixtures("registered")


def test_one_click_stands_the_actor_at_the_performer(
    unposed_scene: bpy.types.Scene, wave_motion: Motion
) -> None:
    unposed_scene.frame_set(1)
    assert bpy.ops.keymark.build_actor(stature=1.72) == {"FINISHED"}
    true = wave_motion.posture.translation[0]
    found = posture_of(unposed_scene).translation
    assert abs(found[1] - true[1]) < 0.5
    assert np.linalg.norm((found - true)[[0, 2]]) < 0.12


def test_without_footage_the_actor_stands_at_the_origin() -> None:
    bpy.ops.keymark.build_actor(stature=1.6)
    scene = bpy.context.scene
    body = read_body(active_take(scene).armature)
    np.testing.assert_allclose(posture_of(scene).translation, [0.0, 0.0, hip_height_m(body)], atol=1e-5)
    assert active_take(scene).lengths.trunk == pytest.approx(0.285 * 1.6)


def test_building_again_changes_the_actor_and_keeps_its_keyframes(opened: bpy.types.Scene) -> None:
    take = active_take(opened)
    armature_object, action = take.armature, take.keyframe_action
    opened.frame_set(7)
    before, keys = posture_of(opened), keyed_frames(armature_object, action)
    objects = len(bpy.data.objects)
    bpy.ops.keymark.build_actor(stature=1.9)
    assert (take.armature, take.keyframe_action, len(bpy.data.objects)) == (armature_object, action, objects)
    assert keyed_frames(armature_object, action) == keys
    assert read_body(armature_object).actor.stature_m == pytest.approx(1.9, rel=1e-4)
    opened.frame_set(7)
    np.testing.assert_allclose(posture_of(opened).minus(before), 0.0, atol=1e-4)


def test_lengths_of_the_panel_reach_the_bones(opened: bpy.types.Scene) -> None:
    take = active_take(opened)
    take.lengths.symmetric = True
    take.lengths.forearm_L = 0.31
    assert take.lengths.forearm_R == pytest.approx(0.31)
    take.lengths.symmetric = False
    take.lengths.shin_R = 0.5
    assert take.lengths.shin_L != pytest.approx(0.5)
    bpy.ops.keymark.apply_lengths()
    segments = read_body(take.armature).actor.segments_m
    assert (segments["forearm.R"], segments["shin.R"]) == pytest.approx((0.31, 0.5), rel=1e-4)


def test_lengths_shown_are_those_of_the_armature_that_is_chosen(opened: bpy.types.Scene) -> None:
    from keymark.core.body.actor import Actor
    from keymark.core.body.kinematics import Body
    from keymark.operators.bridge.armature import build_armature

    take = active_take(opened)
    other = build_armature(opened, Body(Actor.from_stature(1.2)))
    take.armature = other
    assert take.lengths.trunk == pytest.approx(0.285 * 1.2, rel=1e-4)
    bpy.ops.keymark.apply_lengths()
    assert read_body(other).actor.stature_m == pytest.approx(1.2, rel=1e-4)


def test_a_standing_performer_is_measured_from_two_pixels(
    unposed_scene: bpy.types.Scene, wave_motion: Motion, tiny_take: Take
) -> None:
    unposed_scene.frame_set(1)
    body = wave_motion.body
    hips = wave_motion.posture.translation[0]
    ground = hips - [0.0, 0.0, hip_height_m(body)]
    height = standing_height_m(body)
    head, floor = tiny_take.camera.project(np.stack([ground + [0.0, 0.0, height], ground]))[0]
    result = bpy.ops.keymark.measure_actor(stature=height, head_pixel=head, floor_pixel=floor)
    assert result == {"FINISHED"}
    found = posture_of(unposed_scene).translation
    assert np.linalg.norm(found - hips) < 0.12
    assert standing_height_m(read_body(active_take(unposed_scene).armature)) == pytest.approx(height)
    with pytest.raises(RuntimeError, match="below the ground"):
        bpy.ops.keymark.measure_actor(stature=height, head_pixel=floor, floor_pixel=head)
