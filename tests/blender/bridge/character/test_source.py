"""A source motion is read from an Action of an actor, hands and feet included."""

import bpy
import numpy as np
import pytest
from _armatures import build_character
from _characters import plain_character
from keymark.core.body.kinematics import Body
from keymark.core.errors import InputError
from keymark.core.progress import run
from keymark.core.take.motion import Motion
from keymark.operators.bridge.armature import build_armature
from keymark.operators.bridge.character.retarget import read_source
from keymark.operators.bridge.fcurves import write_motion
from mathutils import Quaternion


@pytest.fixture
def actor(body: Body, wave_motion: Motion) -> bpy.types.Object:
    """An actor with the waving motion."""
    made = build_armature(bpy.context.scene, body)
    write_motion(made, wave_motion)
    bpy.context.scene.render.fps = 25
    return made


def test_segments_are_where_the_actors_bones_are(actor: bpy.types.Object, wave_motion: Motion) -> None:
    source, frames = run(read_source(actor, actor.animation_data.action))
    assert frames == pytest.approx(wave_motion.scene_frames)
    assert source.time_s == pytest.approx(wave_motion.time_s)
    for number in (0, 5, len(frames) - 1):
        bpy.context.scene.frame_set(int(frames[number]))
        shown = actor.evaluated_get(bpy.context.evaluated_depsgraph_get())
        for name, starts in source.start.items():
            bone = shown.pose.bones[name]
            assert starts[number] == pytest.approx(np.array(shown.matrix_world @ bone.head), abs=1e-4)
            assert source.end[name][number] == pytest.approx(
                np.array(shown.matrix_world @ bone.tail), abs=1e-4
            )


def test_a_hand_that_the_animator_keyed_is_as_keyed(actor: bpy.types.Object) -> None:
    action = actor.animation_data.action
    before, frames = run(read_source(actor, action))
    bone = actor.pose.bones["hand.L"]
    bone.rotation_mode = "QUATERNION"
    bone.rotation_quaternion = Quaternion((1.0, 0.0, 0.0), 1.2)
    curves = action.layers[0].strips[0].channelbags[0].fcurves
    for curve in [one for one in curves if '"hand.L"' in one.data_path]:
        curves.remove(curve)
    bone.keyframe_insert("rotation_quaternion", frame=float(frames[0]))
    source, _ = run(read_source(actor, action))
    apart = source.end["hand.L"] - source.start["hand.L"]
    forearm = source.end["forearm.L"] - source.start["forearm.L"]
    cosine = (apart * forearm).sum(axis=1) / np.linalg.norm(apart, axis=1) / np.linalg.norm(forearm, axis=1)
    assert np.arccos(cosine) == pytest.approx(1.2, abs=1e-3)
    assert source.end["hand.R"] == pytest.approx(before.end["hand.R"], abs=1e-6)


def test_frames_between_two_stretches_are_left_out(body: Body, wave_motion: Motion) -> None:
    there = np.ones(len(wave_motion.time_s), dtype=bool)
    there[0] = there[4:8] = False
    made = build_armature(bpy.context.scene, body)
    action = write_motion(made, wave_motion.emptied(there))
    bpy.context.scene.render.fps = 4  # half a second is two frames
    assert len(action.layers[0].strips[0].channelbags[0].fcurves[0].keyframe_points) == there.sum()
    source, frames = run(read_source(made, action))
    assert frames == pytest.approx(wave_motion.scene_frames[there])
    assert source.time_s == pytest.approx((frames - frames[0]) / 4.0)


def test_what_is_no_actors_motion_is_refused(actor: bpy.types.Object) -> None:
    action = actor.animation_data.action
    with pytest.raises(InputError, match="lacks the bones"):
        run(read_source(build_character(plain_character()), action))
    with pytest.raises(InputError, match="has no motion of"):
        run(read_source(actor, bpy.data.actions.new("Empty")))
