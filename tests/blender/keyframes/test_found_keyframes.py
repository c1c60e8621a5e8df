"""What an animator does with found keyframes: choosing, accepting, removing, going through them."""

from pathlib import Path
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from _results import shown
from _scene_state import differences, scene_state
from keymark.core.take.motion import Motion
from keymark.operators.keyframes.change_match import candidate_title
from keymark.operators.keyframes.found_properties import known_matches
from keymark.operators.overlays.drawing import Fill, Stroke
from keymark.operators.overlays.timeline import ROOMY, Timeline, picture
from keymark.operators.shell.take_state import TakeState
from keymark.operators.shell.takes import active_take

pytestmark = pytest.mark.usefixtures("registered", "still_neighbors")

VIEW = Timeline(origin=20.0, scale=10.0, width=200.0, height=60.0, pixel=1.0, sizes=ROOMY)
Group = bpy.types.PropertyGroup


def test_another_posture_is_chosen_by_one_click(found: Group, wave_motion: Motion) -> None:
    found.matching.shown_match = 0
    bpy.ops.keymark.replace_match(candidate=1)
    match = found.matching.matches[0]
    assert (match.matched.posture, match.matched.mirrored) == ("Back", True)
    assert match.confidence == pytest.approx(0.9) and TakeState(found).doubtful == [1]
    assert TakeState(found).matched == (1.0, 7.0, 13.0)
    assert shown(found, 1).minus(wave_motion.posture[12]) == pytest.approx(0.0, abs=1e-5)
    bpy.ops.keymark.replace_match(candidate=0)
    assert shown(found, 1).minus(wave_motion.posture[0]) == pytest.approx(0.0, abs=1e-5)
    with pytest.raises(RuntimeError, match="candidate must be 0 to 1"):
        bpy.ops.keymark.replace_match(candidate=2)


def test_found_keyframes_are_accepted_and_removed(found: Group) -> None:
    found.matching.shown_match = 1
    before = shown(found, 7)
    bpy.ops.keymark.accept_match()
    assert (TakeState(found).posed, TakeState(found).matched) == ((7.0,), (1.0, 13.0))
    assert shown(found, 7).minus(before) == pytest.approx(0.0, abs=1e-6)
    bpy.ops.keymark.remove_match()  # the entry goes, the animator's keys stay
    assert TakeState(found).keyed.all == (1.0, 7.0, 13.0)
    assert bpy.context.scene.frame_current == 13
    bpy.ops.keymark.remove_match()
    assert TakeState(found).keyed.all == (1.0, 7.0)
    assert [match.frame for match in found.matching.matches] == [1.0]
    bpy.context.scene.frame_set(5)
    with pytest.raises(RuntimeError, match="This frame holds no found keyframe"):
        bpy.ops.keymark.remove_match()


def test_all_found_are_removed_but_what_the_animator_decided_on(found: Group) -> None:
    found.matching.shown_match = 0
    bpy.ops.keymark.replace_match(candidate=1)
    bpy.context.scene.frame_set(7)
    bpy.ops.keymark.store_keyframe()
    bpy.ops.keymark.remove_found()
    assert (TakeState(found).posed, TakeState(found).matched) == ((7.0,), (1.0,))
    assert [match.frame for match in found.matching.matches] == [1.0]
    assert bpy.ops.keymark.remove_found() == {"CANCELLED"}
    assert TakeState(found).keyed.all == (1.0, 7.0)


def test_the_most_doubtful_is_gone_to_first(found: Group) -> None:
    for match, confidence in zip(found.matching.matches, (0.2, 0.4, 0.1), strict=True):
        match.candidates[0].confidence = confidence
    scene = bpy.context.scene
    scene.frame_set(4)
    visited = []
    for _ in range(4):
        bpy.ops.keymark.jump_to_match(only_doubtful=True)
        visited.append(scene.frame_current)
    assert visited == [13, 1, 7, 13]
    bpy.ops.keymark.replace_match(candidate=0)
    bpy.ops.keymark.jump_to_match(only_doubtful=True)
    assert scene.frame_current == 1
    for _ in range(2):
        bpy.ops.keymark.accept_match()
        bpy.ops.keymark.jump_to_match(only_doubtful=True)
    assert scene.frame_current == 7
    assert bpy.ops.keymark.jump_to_match(only_doubtful=True) == {"CANCELLED"}


def test_found_keyframes_are_gone_through_in_order(found: Group) -> None:
    scene, visited = bpy.context.scene, []
    scene.frame_set(7)
    for direction in ("NEXT", "NEXT", "PREVIOUS", "PREVIOUS"):
        bpy.ops.keymark.jump_to_match(direction=direction)
        visited.append(scene.frame_current)
    assert visited == [13, 1, 13, 7]


def test_the_chosen_one_is_that_of_the_current_frame(found: Group) -> None:
    scene, matching = bpy.context.scene, found.matching
    matching.shown_match = 1
    assert scene.frame_current == 7
    scene.frame_set(13)
    assert matching.shown_match == 2
    scene.frame_set(10)
    assert matching.shown_match == 1


def test_every_step_is_undone_and_redone(unposed: Group, given: SimpleNamespace) -> None:
    ops = bpy.ops.keymark
    bpy.context.scene.frame_set(1)
    bpy.ops.ed.undo_push(message="Opened")
    for name, settings in (
        ("pose_all", {}),
        ("jump_to_match", {}),
        ("replace_match", {"candidate": 1}),
        ("accept_match", {}),
        ("remove_match", {}),
        ("remove_found", {}),
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


def test_the_timeline_tells_found_keyframes_from_posed_ones(found: Group) -> None:
    found.proposals.clear()
    for frame in (4, 7):
        found.proposals.add().frame = frame
    items = picture(bpy.context.scene, found, VIEW)
    marks = [item for item in items if isinstance(item, Fill)][-1]
    assert marks.corners.mean(axis=1)[:, 0] == pytest.approx([30.0, 150.0])
    width, height = np.ptp(marks.corners[0], axis=0)
    assert width == pytest.approx(height) and len({tuple(each) for each in marks.corners[0]}) == 4
    diamonds, squares = [item for item in items if isinstance(item, Stroke)][-2:]
    assert (len(diamonds.segments), len(squares.segments)) == (1 * 4, 3 * 4)


def test_found_keyframes_come_back_with_the_file(found: Group, tmp_path: Path) -> None:
    before, reason = known_matches(found), found.matching.reason
    place = [tuple(one.place) for match in found.matching.matches for one in match.candidates]
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "kept.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "kept.blend"))
    take = active_take(bpy.context.scene)
    assert known_matches(take) == before and len(before) == 3 and take.matching.reason == reason
    assert [tuple(one.place) for match in take.matching.matches for one in match.candidates] == place


def test_a_candidate_is_named_by_what_tells_it_from_the_first(found: Group, wave_motion: Motion) -> None:
    last = found.matching.matches[2]
    first, other = last.candidates
    assert candidate_title(last, first) == "As found"
    assert candidate_title(last, other) == "Other arms"
    other.turned = 0.8
    assert candidate_title(last, other) == "46° left, other arms"
    other.turned = -3.1
    assert candidate_title(last, other) == "Turned round, other arms"
    other.limbs, other.turned = "arm.R leg.L leg.R", 0.0
    assert candidate_title(last, other) == "Other right arm, legs"
    other.limbs = ""
    assert candidate_title(last, other) == "Nearly as found"
    last.library = "waves"
    assert candidate_title(last, other) == "Back"
