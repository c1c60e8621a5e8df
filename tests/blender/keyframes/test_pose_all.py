"""Pose All in a scene: keys, stored candidates, libraries, what is said, and what stays."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from _panel import drawn_panels
from _results import shown, wave_library
from _scene_state import differences, scene_state
from keymark.core.errors import InputError
from keymark.core.prior.library import LibraryMotion, MotionStep, write_library
from keymark.core.prior.texts import COMPOSED
from keymark.core.take.motion import Motion
from keymark.core.take.take import Take
from keymark.operators.bridge.keyframes import candidate_posture
from keymark.operators.library import registry
from keymark.operators.shell import results
from keymark.operators.shell.take_state import TakeState
from keymark.operators.shell.takes import active_take

pytestmark = pytest.mark.usefixtures("registered")

Group = bpy.types.PropertyGroup


def test_every_proposed_frame_is_keyed_as_found(
    found: Group, given: SimpleNamespace, wave_motion: Motion
) -> None:
    assert (TakeState(found).keyed.all, TakeState(found).posed) == ((1.0, 7.0, 13.0), ())
    assert shown(found, 7).minus(wave_motion.posture[6]) == pytest.approx(0.0, abs=1e-5)
    state = found.matching
    assert (state.reason, state.fit, round(state.floor_found, 6)) == ("It is", 0.75, 0.02)
    match = state.matches[1]
    assert (match.frame, match.library, match.candidate.name) == (7.0, COMPOSED, "Wave 6")
    assert [(each.name, each.mirrored) for each in match.candidates] == [("Wave 6", False), ("Back", True)]
    again = candidate_posture(match.candidates[1])
    assert again.minus(wave_motion.posture[6]) == pytest.approx(0.0, abs=1e-6)
    assert (given.frames, given.libraries) == ([(0, 6, 12)], [["waves", "walking"]])


def test_doubtful_ones_are_said_and_shown(
    unposed: Group, given: SimpleNamespace, capfd: pytest.CaptureFixture[str]
) -> None:
    bpy.ops.keymark.pose_all()
    assert "3 keyframes found, 1 of them doubtful" in capfd.readouterr().out
    take = active_take(bpy.context.scene)
    assert (TakeState(take).found_count, len(TakeState(take).doubtful)) == (3, 1)
    assert bpy.context.scene.frame_current == 7 and take.matching.shown_match == 1
    given.confidences = dict.fromkeys((0, 6, 12), 0.9)
    results.clear_cache()
    bpy.context.scene.frame_set(3)
    bpy.ops.keymark.pose_all()
    assert "3 keyframes found, none of them doubtful" in capfd.readouterr().out
    assert bpy.context.scene.frame_current == 3


def test_what_contradicts_is_doubtful_and_shown_first(unposed: Group, given: SimpleNamespace) -> None:
    given.contradictions = {12: ("shin.L",)}
    bpy.ops.keymark.pose_all()
    take = active_take(bpy.context.scene)
    assert TakeState(take).doubtful == [2, 1]
    assert bpy.context.scene.frame_current == 13
    assert [TakeState(take).contradictions_at(frame) for frame in (7.0, 13.0)] == [(), ("shin.L",)]
    take.follow.use_markers = False
    assert TakeState(take).contradictions_at(13.0) == ()
    take.follow.use_markers = True
    bpy.ops.keymark.accept_match()
    assert TakeState(take).contradictions_at(13.0) == () and TakeState(take).doubtful == [1]


def test_frames_are_proposed_where_there_are_none(unposed: Group, given: SimpleNamespace) -> None:
    unposed.proposals.clear()
    bpy.ops.keymark.pose_all()
    take = active_take(bpy.context.scene)
    found = TakeState(take).proposed
    assert list(TakeState(take).matched) == found and len(found) >= 2


def test_what_is_posed_stays_and_is_handed_on(found: Group, given: SimpleNamespace) -> None:
    scene = bpy.context.scene
    scene.frame_set(7)
    bone = found.armature.pose.bones["forearm.L"]
    bone.rotation_euler[0] += 0.4
    bone.keyframe_insert("rotation_euler", frame=7)
    before = shown(found, 7)
    bpy.ops.keymark.pose_all()
    take = active_take(scene)
    (handed,) = given.takes[-1].keyframes
    assert (handed.index, handed.matched, given.frames[-1]) == (6, None, (0, 12))
    assert handed.posture.minus(before) == pytest.approx(0.0, abs=1e-5)
    assert shown(take, 7).minus(before) == pytest.approx(0.0, abs=1e-6)
    assert (TakeState(take).posed, TakeState(take).matched) == ((7.0,), (1.0, 13.0))
    assert [match.frame for match in take.matching.matches] == [1.0, 13.0]


@pytest.mark.usefixtures("still_neighbors")
def test_a_candidate_that_a_person_chose_stays(
    found: Group, given: SimpleNamespace, wave_motion: Motion
) -> None:
    found.matching.shown_match = 1
    bpy.ops.keymark.replace_match(candidate=1)
    found.matching.shown_match = 0
    bpy.ops.keymark.replace_match(candidate=1)
    bpy.ops.keymark.pose_all()
    take = active_take(bpy.context.scene)
    assert [each.index for each in given.takes[-1].keyframes] == [0, 6]
    assert [(match.frame, match.by_hand) for match in take.matching.matches] == [
        (1.0, True),
        (7.0, True),
        (13.0, False),
    ]
    assert shown(take, 1).minus(wave_motion.posture[12]) == pytest.approx(0.0, abs=1e-5)
    assert TakeState(take).matched == (1.0, 7.0, 13.0)


def test_where_all_is_posed_nothing_is_done(found: Group) -> None:
    for frame in (1, 7, 13):
        bpy.context.scene.frame_set(frame)
        bpy.ops.keymark.store_keyframe()
    before = scene_state()
    with pytest.raises(RuntimeError, match="Every proposed frame is posed"):
        bpy.ops.keymark.pose_all()
    assert differences(before, scene_state()) == ""


def test_a_frame_posed_while_the_job_runs_stays_posed(unposed: Group, given: SimpleNamespace) -> None:
    bpy.context.scene.frame_set(7)
    before = shown(unposed, 7)
    given.meanwhile = bpy.ops.keymark.store_keyframe
    bpy.ops.keymark.pose_all()
    take = active_take(bpy.context.scene)
    assert (TakeState(take).posed, TakeState(take).matched) == ((7.0,), (1.0, 13.0))
    assert shown(take, 7).minus(before) == pytest.approx(0.0, abs=1e-5)


def test_the_floor_is_handed_on(unposed: Group, given: SimpleNamespace) -> None:
    bpy.ops.keymark.pose_all(floor_height=0.4)
    bpy.ops.keymark.pose_all(floor="HEIGHT", floor_height=0.4)
    assert given.floors == [None, pytest.approx(0.4)]


def test_what_fails_leaves_the_scene_as_it_was(found: Group, given: SimpleNamespace) -> None:
    before = scene_state()
    given.error = InputError("no marker is seen in the footage")
    results.clear_cache()
    with pytest.raises(RuntimeError, match="No marker is seen"):
        bpy.ops.keymark.pose_all()
    assert differences(before, scene_state()) == ""


def test_a_reconstruction_may_follow_directly(unposed: Group, given: SimpleNamespace) -> None:
    assert TakeState(unposed).next[1] == "pose all keyframes"
    bpy.ops.keymark.pose_all()
    take = active_take(bpy.context.scene)
    assert TakeState(take).next[1] == "check the doubtful poses"
    for match in take.matching.matches:
        match.by_hand = True
    assert TakeState(take).next[1] == "reconstruct the motion"
    take.method = "interpolation"
    assert bpy.ops.keymark.reconstruct() == {"FINISHED"}


def test_without_an_actor_nothing_can_be_posed(tiny_take: Take) -> None:
    bpy.ops.keymark.load_footage(filepath=str(tiny_take.clip))
    with pytest.raises(RuntimeError, match="Build the actor first"):
        bpy.ops.keymark.pose_all()


def test_a_named_library_alone_is_asked(
    unposed: Group, given: SimpleNamespace, wave_motion: Motion, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(registry, "load_registered", lambda name: wave_library(wave_motion, name))
    unposed.matching.library_name = "jumping"
    for words, asked in (({}, ["jumping"]), ({"library": "waves"}, ["waves"])):
        assert bpy.ops.keymark.pose_all(**words) == {"FINISHED"}
        assert given.libraries[-1] == asked
    every = len(registry.all_libraries())
    bpy.ops.keymark.pose_all(library="auto")
    assert len(given.libraries[-1]) == every
    active_take(bpy.context.scene).matching.library = "auto"
    bpy.ops.keymark.pose_all()
    assert len(given.libraries[-1]) == every


def test_the_menu_holds_the_registry_and_what_was_chosen(unposed: Group) -> None:
    state = unposed.matching
    assert state.library == "auto" and state.library_name == ""
    state.library_name = "auto"
    assert state.library == "auto"
    state.library = "walking"
    assert state.library_name == "walking"
    state.library_name = "dragging a cart"
    assert state.library == "dragging a cart"
    with pytest.raises(RuntimeError, match="no keyframe library 'dragging a cart'"):
        bpy.ops.keymark.pose_all()
    state.library = "walking"
    assert state.library_name == "walking"


def test_poses_are_found_with_a_library_file(
    unposed: Group,
    wave_motion: Motion,
    tmp_path: Path,
    shown_points: Callable[[bpy.types.Object], np.ndarray],
) -> None:
    steps = tuple(MotionStep(f"Wave {i}", i / 25.0) for i in (0, 6, 12))
    waves = replace(wave_library(wave_motion), motions=(LibraryMotion("wave", steps, 12 / 25.0),))
    write_library(tmp_path / "waves.json", waves)
    assert bpy.ops.keymark.pose_all(library=str(tmp_path / "waves.json")) == {"FINISHED"}
    take = active_take(bpy.context.scene)
    assert len(TakeState(take).matched) >= 2 and take.matching.fit > 0.5
    for frame in (1, 13):
        bpy.context.scene.frame_set(frame)
        apart = np.linalg.norm(shown_points(take.armature) - wave_motion.points[frame - 1], axis=-1)
        assert apart.mean() < 0.15
    assert bpy.ops.keymark.reconstruct() == {"FINISHED"}
    take.review.confidence = 0.1  # of points; how sure poses are that nobody posed is said alike everywhere
    steps = bpy.context.window_manager.keymark_steps
    keyed = TakeState(take).keyed.all
    bpy.context.scene.frame_set(next(frame for frame in range(1, 14) if frame not in keyed))
    for step in ("keyframes", "reconstruct"):
        setattr(steps, step, True)
        words = " ".join(words for kind, _, words in drawn_panels() if kind == "label")
        assert f"{take.matching.fit:.0%} sure" in words.replace("\N{NO-BREAK SPACE}", " ")
    assert TakeState(take).next[1] != "pose the weak frames"
