"""Matching in a scene: keys, stored candidates, and the operators on them."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from _scene_state import differences, scene_state
from keymark.core.body.human import HUMAN
from keymark.core.body.posture import Posture
from keymark.core.errors import InputError
from keymark.core.library.library import Library, LibraryMotion, LibraryPosture, MotionStep
from keymark.core.library.library_file import write_library
from keymark.core.matching.candidates import Candidate, MatchedFrame
from keymark.core.posing import pose_clip as posing
from keymark.core.posing.found_poses import FoundPoses
from keymark.core.progress import Progress
from keymark.core.take.motion import Motion
from keymark.core.take.take import Take
from keymark.operators.bridge.actor_lengths import read_body
from keymark.operators.bridge.pose import read_posture
from keymark.operators.library import registry_files
from keymark.operators.matching.match_edits import candidate_posture
from keymark.operators.matching.matches import known_matches
from keymark.operators.overlays.picture import Fill, Stroke
from keymark.operators.overlays.timeline import ROOMY, Timeline, picture
from keymark.operators.shell import results
from keymark.operators.shell.keyed_frames import keyframes_of, matched_frames, posed_frames
from keymark.operators.shell.takes import active_take
from keymark.operators.takes.next_step import next_step

pytestmark = pytest.mark.usefixtures("registered")

VIEW = Timeline(origin=20.0, scale=10.0, width=200.0, height=60.0, pixel=1.0, sizes=ROOMY)
Group = bpy.types.PropertyGroup


def library(motion: Motion, identifier: str = "waves") -> Library:
    """A library of three postures of the tiny take's own motion."""
    postures = tuple(LibraryPosture(f"Wave {i}", motion.posture[i]) for i in (0, 6, 12))
    return Library(identifier, identifier.title(), 1, "Somebody", "CC0-1.0", motion.body.actor, postures)


def candidate(posture: Posture, name: str, confidence: float, mirrored: bool = False) -> Candidate:
    """A candidate of a frame."""
    return Candidate(posture, name, mirrored, confidence)


def found(motion: Motion, frames: dict[int, float]) -> FoundPoses:
    """The true postures at some frames, each of a confidence, and another one each may show."""
    return FoundPoses(
        frames=tuple(
            MatchedFrame(
                index,
                (
                    candidate(motion.posture[index], f"Wave {index}", confidence),
                    candidate(motion.posture[12 - index], "Back", 0.25, mirrored=True),
                ),
            )
            for index, confidence in frames.items()
        ),
        postures=motion.posture,
        fit=0.75,
        floor_m=0.02,
        reason="it is",
        library="waves",
    )


@pytest.fixture
def given(monkeypatch: pytest.MonkeyPatch, wave_motion: Motion) -> SimpleNamespace:
    """The result of matching in this test, and a record of its arguments; the job takes three steps."""
    waves, other = library(wave_motion), library(wave_motion, "walking")
    asked = SimpleNamespace(
        found=found(wave_motion, {0: 0.9, 6: 0.3, 12: 0.7}),
        takes=[],
        floors=[],
        error=None,
        meanwhile=lambda: None,
    )

    def match(take, reading, libraries, floor_m=None, keyframe_count=None):  # noqa: ANN001, ANN202
        asked.takes.append(take)
        asked.floors.append(floor_m)
        for step in range(3):
            yield Progress("Matching Waves", step / 3)
        asked.meanwhile()
        if asked.error:
            raise asked.error
        return asked.found

    monkeypatch.setattr(posing, "pose_clip", match)
    monkeypatch.setattr(registry_files, "libraries_to_match", lambda name: [waves, other])
    return asked


@pytest.fixture
def unposed(tiny_take: Take) -> Group:
    """The tiny take opened, without its keyframes."""
    results.clear_cache()
    (tiny_take.folder / "keyframes.json").unlink()
    bpy.ops.keymark.open_take(filepath=str(tiny_take.folder / "take.json"))
    return active_take(bpy.context.scene)


@pytest.fixture
def matched(unposed: Group, given: SimpleNamespace) -> Group:
    """That take, matched at frames 1, 7 and 13."""
    assert bpy.ops.keymark.match_library() == {"FINISHED"}
    return active_take(bpy.context.scene)


def shown(take: Group, frame: int) -> Posture:
    """The posture that the actor shows at a frame."""
    bpy.context.scene.frame_set(frame)
    return read_posture(take.armature, read_body(take.armature, HUMAN)).posture


def test_matched_postures_are_keyed_and_kept(matched: Group, wave_motion: Motion) -> None:
    """Frames, names, confidences, alternatives, and how sure the choice is."""
    assert (keyframes_of(matched), posed_frames(matched)) == ((1.0, 7.0, 13.0), ())
    assert shown(matched, 7).minus(wave_motion.posture[6]) == pytest.approx(0.0, abs=1e-5)
    state = matched.matching
    assert (state.reason, state.fit, round(state.floor_found, 6)) == ("It is", 0.75, 0.02)
    match = state.matches[1]
    assert (match.frame, match.library, match.candidate.name) == (7.0, "waves", "Wave 6")
    assert [each.is_doubtful for each in state.matches] == [False, True, False]
    assert [(each.name, each.mirrored) for each in match.candidates] == [("Wave 6", False), ("Back", True)]
    again = candidate_posture(match.candidates[1])
    assert again.minus(wave_motion.posture[6]) == pytest.approx(0.0, abs=1e-6)


def test_a_reconstruction_may_follow_directly(unposed: Group, given: SimpleNamespace) -> None:
    """Nothing is keyed, and the panel names the next step."""
    assert next_step(unposed) == "Next: match a library, or pose"
    bpy.ops.keymark.match_library()
    take = active_take(bpy.context.scene)
    assert next_step(take) == "Next: check matches, reconstruct"
    for match in take.matching.matches:
        match.by_hand = True
    assert next_step(take) == "Next: reconstruct the motion"
    take.method = "interpolation"
    assert bpy.ops.keymark.reconstruct() == {"FINISHED"}


def test_what_is_posed_stays_and_is_handed_to_matching(matched: Group, given: SimpleNamespace) -> None:
    """A match that was corrected is the animator's: matching again sees a pose in it and leaves it alone."""
    scene = bpy.context.scene
    scene.frame_set(7)
    bone = matched.armature.pose.bones["forearm.L"]
    bone.rotation_euler[0] += 0.4
    bone.keyframe_insert("rotation_euler", frame=7)
    before = shown(matched, 7)
    bpy.ops.keymark.match_library()
    take = active_take(scene)
    (handed,) = given.takes[-1].keyframes
    assert (handed.index, handed.matched) == (6, None)
    assert handed.posture.minus(before) == pytest.approx(0.0, abs=1e-5)
    assert shown(take, 7).minus(before) == pytest.approx(0.0, abs=1e-6)
    # What was matched there moves beside it.
    assert (posed_frames(take), matched_frames(take)) == ((7.0,), (1.0, 4.0, 13.0))
    assert [match.frame for match in take.matching.matches] == [1.0, 4.0, 13.0]


def test_matching_again_replaces_what_matching_gave(
    matched: Group, given: SimpleNamespace, wave_motion: Motion
) -> None:
    """Frames that are matched no longer are keyed no longer."""
    given.found = found(wave_motion, {3: 0.9, 9: 0.9})
    bpy.ops.keymark.match_library()
    take = active_take(bpy.context.scene)
    assert keyframes_of(take) == matched_frames(take) == (4.0, 10.0)
    assert len(bpy.data.actions) == 1


def test_a_frame_posed_while_the_job_runs_stays_posed(unposed: Group, given: SimpleNamespace) -> None:
    """The user interface stays alive meanwhile: the match of that frame comes too late."""
    before = shown(unposed, 7)
    given.meanwhile = bpy.ops.keymark.store_keyframe
    bpy.ops.keymark.match_library()
    take = active_take(bpy.context.scene)
    assert (posed_frames(take), matched_frames(take)) == ((7.0,), (1.0, 13.0))
    assert shown(take, 7).minus(before) == pytest.approx(0.0, abs=1e-5)


def test_the_floor_is_handed_on(unposed: Group, given: SimpleNamespace) -> None:
    """Only where it is known."""
    bpy.ops.keymark.match_library(floor_height=0.4)
    bpy.ops.keymark.match_library(floor="HEIGHT", floor_height=0.4)
    assert given.floors == [None, pytest.approx(0.4)]


def test_a_match_that_fails_leaves_the_scene_as_it_was(matched: Group, given: SimpleNamespace) -> None:
    """The sentence is reported, nothing else happens."""
    before = scene_state()
    given.error = InputError("no marker is seen in the footage")
    with pytest.raises(RuntimeError, match="no marker is seen"):
        bpy.ops.keymark.match_library()
    assert differences(before, scene_state()) == ""


def test_another_posture_is_chosen_by_one_click(matched: Group, wave_motion: Motion) -> None:
    """It is keyed as matched, nothing is in doubt any more, and choosing the first again brings that back."""
    matched.matching.active_match = 0
    bpy.ops.keymark.replace_match(candidate=1)
    match = matched.matching.matches[0]
    assert (match.matched.posture, match.matched.mirrored, match.is_doubtful) == ("Back", True, False)
    assert match.confidence == pytest.approx(0.9)
    assert matched_frames(matched) == (1.0, 7.0, 13.0)
    assert shown(matched, 1).minus(wave_motion.posture[12]) == pytest.approx(0.0, abs=1e-5)
    bpy.ops.keymark.replace_match(candidate=0)
    assert shown(matched, 1).minus(wave_motion.posture[0]) == pytest.approx(0.0, abs=1e-5)
    with pytest.raises(RuntimeError, match="candidate must be 0 to 1"):
        bpy.ops.keymark.replace_match(candidate=2)


def test_matches_are_accepted_and_removed(matched: Group) -> None:
    """Accepted, a frame is posed; removed, it is no keyframe."""
    matched.matching.active_match = 1
    before = shown(matched, 7)
    bpy.ops.keymark.accept_match()
    assert (posed_frames(matched), matched_frames(matched)) == ((7.0,), (1.0, 13.0))
    assert shown(matched, 7).minus(before) == pytest.approx(0.0, abs=1e-6)
    bpy.ops.keymark.remove_match()  # the entry goes, the animator's keys stay
    assert keyframes_of(matched) == (1.0, 7.0, 13.0)
    bpy.ops.keymark.remove_match()
    assert keyframes_of(matched) == (1.0, 7.0)
    assert [match.frame for match in matched.matching.matches] == [1.0]


def test_doubtful_matches_are_gone_through(matched: Group) -> None:
    """From the current frame on, around the end; choosing a match goes to its frame."""
    scene = bpy.context.scene
    visited = []
    for only_doubtful, direction in ((True, "NEXT"), (False, "NEXT"), (False, "NEXT"), (False, "PREVIOUS")):
        bpy.ops.keymark.jump_to_match(direction=direction, only_doubtful=only_doubtful)
        visited.append(scene.frame_current)
    assert visited == [7, 13, 1, 13]
    matched.matching.active_match = 1
    assert scene.frame_current == 7
    bpy.ops.keymark.replace_match(candidate=0)
    assert bpy.ops.keymark.jump_to_match(only_doubtful=True) == {"CANCELLED"}


def test_every_step_is_undone_and_redone(unposed: Group, given: SimpleNamespace) -> None:
    """One undo each, to the last key."""
    ops = bpy.ops.keymark
    bpy.ops.ed.undo_push(message="Opened")
    for name, settings in (
        ("match_library", {}),
        ("jump_to_match", {"only_doubtful": True}),
        ("replace_match", {"candidate": 1}),
        ("accept_match", {}),
        ("remove_match", {}),
    ):
        before = scene_state()
        getattr(ops, name)(**settings)
        bpy.ops.ed.undo_push(message=name)
        after = scene_state()
        assert before != after, name
        bpy.ops.ed.undo()
        assert differences(before, scene_state()) == "", name
        bpy.ops.ed.redo()
        assert differences(after, scene_state()) == "", name


def test_the_timeline_tells_matched_keyframes_from_posed_ones(matched: Group) -> None:
    """A square each, filled where sure; no proposal's diamond stays at the same frame."""
    for frame in (4, 7):
        matched.proposals.add().frame = frame
    items = picture(bpy.context.scene, matched, VIEW)
    marks = [item for item in items if isinstance(item, Fill)][-1]
    assert marks.corners.mean(axis=1)[:, 0] == pytest.approx([30.0, 150.0])
    width, height = np.ptp(marks.corners[0], axis=0)
    assert width == pytest.approx(height) and len({tuple(each) for each in marks.corners[0]}) == 4
    diamonds, squares = [item for item in items if isinstance(item, Stroke)][-2:]
    assert (len(diamonds.segments), len(squares.segments)) == (1 * 4, 3 * 4)
    bpy.context.scene.keymark.timeline.show_matches = False
    diamonds = [item for item in picture(bpy.context.scene, matched, VIEW) if isinstance(item, Stroke)][-1]
    assert len(diamonds.segments) == 2 * 4


def test_without_an_actor_nothing_can_be_matched(tiny_take: Take) -> None:
    """The tooltip names the first missing requirement."""
    bpy.ops.keymark.load_footage(filepath=str(tiny_take.clip))
    with pytest.raises(RuntimeError, match="Build the actor first"):
        bpy.ops.keymark.match_library()


def test_the_menu_holds_the_registry_and_what_was_chosen(unposed: Group) -> None:
    """A library that only another machine has is listed as missing."""
    state = unposed.matching
    assert state.library == "auto"
    state.library = "walking"
    assert state.library_name == "walking"
    state.library_name = "dragging a cart"
    assert state.library == "dragging a cart"
    with pytest.raises(RuntimeError, match="no keyframe library 'dragging a cart'"):
        bpy.ops.keymark.match_library(library=state.library_name)
    state.library = "walking"
    assert state.library_name == "walking"


def test_footage_is_matched_with_a_library_file(
    unposed: Group,
    wave_motion: Motion,
    tmp_path: Path,
    shown_points: Callable[[bpy.types.Object], np.ndarray],
) -> None:
    """End to end: the library's postures are keyed where the performer stood in the drawn clip."""
    steps = tuple(MotionStep(f"Wave {i}", i / 25.0) for i in (0, 6, 12))
    waves = replace(library(wave_motion), motions=(LibraryMotion("wave", steps, 12 / 25.0),))
    write_library(tmp_path / "waves.json", waves)
    assert bpy.ops.keymark.match_library(library=str(tmp_path / "waves.json")) == {"FINISHED"}
    take = active_take(bpy.context.scene)
    assert len(matched_frames(take)) >= 2 and take.matching.fit > 0.5
    for frame in (1, 13):
        bpy.context.scene.frame_set(frame)
        apart = np.linalg.norm(shown_points(take.armature) - wave_motion.points[frame - 1], axis=-1)
        assert apart.mean() < 0.15
    assert bpy.ops.keymark.reconstruct() == {"FINISHED"}


def test_matches_come_back_with_the_file(matched: Group, tmp_path: Path) -> None:
    """Frames, stored candidates, the reason, and that the keys are unchanged."""
    before, reason = known_matches(matched), matched.matching.reason
    place = [tuple(one.place) for match in matched.matching.matches for one in match.candidates]
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "kept.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "kept.blend"))
    take = active_take(bpy.context.scene)
    assert known_matches(take) == before and len(before) == 3 and take.matching.reason == reason
    assert [tuple(one.place) for match in take.matching.matches for one in match.candidates] == place


@pytest.mark.parametrize("mode", ["QUATERNION", "AXIS_ANGLE", "ZYX"])
def test_matches_are_keyed_in_any_rotation_mode(
    unposed: Group, given: SimpleNamespace, mode: str, wave_motion: Motion
) -> None:
    """On a scaled actor, too: it shows the matched postures, and they count as matched."""
    for bone in unposed.armature.pose.bones:
        bone.rotation_mode = mode
    unposed.armature.scale = (1.5, 1.5, 1.5)
    bpy.context.view_layer.update()
    assert bpy.ops.keymark.match_library() == {"FINISHED"}
    take = active_take(bpy.context.scene)
    assert len(matched_frames(take)) == 3 and not posed_frames(take)
    assert np.abs(shown(take, 7).minus(wave_motion.posture[6])[6:]).max() < 1e-4
