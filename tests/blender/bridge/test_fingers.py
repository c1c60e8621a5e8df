"""Fingers of an actor: there once a motion shows them, read back, kept by few keys, posed by the animator."""

from dataclasses import replace
from pathlib import Path

import bpy
import numpy as np
import pytest
from keymark.core.body.fingers import FINGER_BONES, SHARES, Hands
from keymark.core.body.kinematics import Body
from keymark.core.body.skeleton import FINGERS
from keymark.core.progress import run
from keymark.core.take.motion import Motion
from keymark.operators.bridge.actions import assign_action, existing_channelbag
from keymark.operators.bridge.armature import has_fingers, read_body, set_lengths
from keymark.operators.bridge.body_mesh import build_body_mesh
from keymark.operators.bridge.character.retarget import read_source
from keymark.operators.bridge.export_formats import write_bvh
from keymark.operators.bridge.fcurves import write_motion
from keymark.operators.bridge.finish_motion import FinishOptions, finish_motion


@pytest.fixture
def closing(wave_motion: Motion) -> Motion:
    """Hands that open and close, each finger in its own time."""
    phase = 3.0 * wave_motion.time_s[:, None, None] + np.arange(2)[:, None] + 0.3 * np.arange(len(FINGERS))
    frames = len(wave_motion.time_s)
    hands = Hands(0.7 + 0.5 * np.sin(phase), np.full((frames, 2, 3), 0.1), np.ones((frames, 2)))
    return replace(wave_motion, hands=hands)


def curls(armature_object: bpy.types.Object, action: bpy.types.Action) -> np.ndarray:
    """(F, 2, 5) as a character would get them."""
    fingers = run(read_source(armature_object, action))[0].fingers
    rows = [[fingers[f"{finger}.{side}"].mean(axis=-1) for finger in FINGERS] for side in "LR"]
    return np.moveaxis(np.array(rows), -1, 0)


def test_a_motion_of_seen_hands_gives_an_actor_fingers(
    actor: bpy.types.Object, closing: Motion, tmp_path: Path
) -> None:
    write_motion(actor, replace(closing, hands=None))
    assert not has_fingers(actor)
    action = write_motion(actor, closing)
    assert has_fingers(actor)
    assert closing.hands is not None
    np.testing.assert_allclose(curls(actor, action), closing.hands.curls, atol=1e-5)
    index = actor.pose.bones["index.2.L"]
    bpy.context.scene.frame_set(closing.frame_start + 4)
    assert index.rotation_euler[0] == pytest.approx(SHARES[1] * closing.hands.curls[4, 0, 1], abs=1e-5)
    tip, wrist = actor.pose.bones["middle.3.R"].tail, actor.pose.bones["hand.R"].head
    before = (tip - wrist).length
    actor.pose.bones["middle.1.R"].rotation_euler[0] = 0.0
    bpy.context.view_layer.update()
    assert (actor.pose.bones["middle.3.R"].tail - actor.pose.bones["hand.R"].head).length > 1.02 * before
    write_bvh(actor, tmp_path / "motion.bvh")
    assert "JOINT index.3.L" in (tmp_path / "motion.bvh").read_text(encoding="utf-8")


def test_the_skin_closes_with_its_fingers(actor: bpy.types.Object, closing: Motion) -> None:
    write_motion(actor, closing)
    skin = build_body_mesh(actor, closing.body, ())
    reach = []
    for curl_rad in (0.0, 1.2):
        for bone in map(actor.pose.bones.get, FINGER_BONES):
            bone.rotation_euler[0] = curl_rad
        bpy.context.view_layer.update()
        shown = skin.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
        places = np.array([vertex.co[:] for vertex in shown.vertices])
        for side in "LR":
            hand = actor.pose.bones[f"hand.{side}"]
            ahead = (places - np.array(hand.head)) @ np.array(hand.vector.normalized()) / hand.length
            near = np.linalg.norm(places - np.array(hand.head), axis=1) < 1.2 * hand.length
            reach.append(ahead[near].max())
    assert min(reach[:2]) > 0.9 and max(reach[2:]) < 0.75
    total = [sum(group.weight for group in vertex.groups) for vertex in skin.data.vertices]
    np.testing.assert_allclose(total, 1.0, atol=1e-3)


def test_few_keys_keep_curls(actor: bpy.types.Object, closing: Motion) -> None:
    action = write_motion(actor, closing)
    options = FinishOptions(0.01, False, None)
    finished = run(finish_motion(actor, action, None, options, 1.0 / closing.fps))
    final = bpy.data.actions.new("Final")
    finished.write(actor, action, final)
    assign_action(actor, final)
    assert closing.hands is not None
    off = np.degrees(np.abs(curls(actor, final) - closing.hands.curls))
    assert off.max() < 3.0
    bag = existing_channelbag(final, actor)
    keys = [len(one.keyframe_points) for one in bag.fcurves if '"ring.2.L"' in one.data_path]
    assert max(keys) < 0.6 * len(closing.time_s)


def test_a_finger_that_is_posed_wins(actor: bpy.types.Object, closing: Motion) -> None:
    write_motion(actor, closing)
    keyframes = bpy.data.actions.new("Keyframes")
    assign_action(actor, keyframes)
    bone = actor.pose.bones["index.1.L"]
    bone.rotation_euler = (1.2, 0.0, 0.0)
    bone.keyframe_insert("rotation_euler", frame=3)
    action = write_motion(actor, closing, keyframe_action=keyframes)
    channelbag = existing_channelbag(action, actor)
    posed, other = (
        channelbag.fcurves.find(f'pose.bones["{name}"].rotation_euler', index=0) for name in FINGER_BONES[3:5]
    )
    assert posed.evaluate(3) == pytest.approx(1.2)
    assert len(posed.keyframe_points) == len(other.keyframe_points) == len(closing.time_s)


def test_fingers_go_with_the_hand_when_lengths_are_set(
    actor: bpy.types.Object, closing: Motion, body: Body
) -> None:
    write_motion(actor, closing)
    places = [np.array(actor.data.bones[name].head_local) for name in ("index.1.R", "hand.R")]
    lengths = dict(body.actor.segments_m)
    lengths["hand.R"] *= 2.0
    lengths["forearm.R"] += 0.1
    scaled = Body(type(body.actor)(lengths))
    set_lengths(actor, scaled)
    after = [np.array(actor.data.bones[name].head_local) for name in ("index.1.R", "hand.R")]
    np.testing.assert_allclose(after[0] - after[1], 2.0 * (places[0] - places[1]), atol=1e-5)
    assert read_body(actor).actor.segments_m["hand.R"] == pytest.approx(lengths["hand.R"])
