"""A corrected keyframe at once improves the found ones around it."""

from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from _results import posture_of, shown
from _scene_state import differences, scene_state
from keymark.core.body.human import HUMAN
from keymark.core.errors import InputError
from keymark.core.markers.ignored_regions import IgnoredRegion
from keymark.operators.bridge.actor_bones import joint_places
from keymark.operators.bridge.pose import write_posture
from keymark.operators.follow.properties import add_ignored_regions
from keymark.operators.keyframes.corrections import camera_now
from keymark.operators.keyframes.posing import improve_neighbors
from keymark.operators.shell import results
from keymark.operators.shell.take_state import TakeState
from keymark.operators.shell.takes import active_take

pytestmark = pytest.mark.usefixtures("registered")

Group = bpy.types.PropertyGroup
FPS = 25.0


def test_storing_a_keyframe_improves_the_found_ones_around_it(found: Group, given: SimpleNamespace) -> None:
    scene = bpy.context.scene
    scene.frame_set(7)
    bpy.ops.ed.undo_push(message="Opened")
    before = scene_state()
    given.confidences = {0: 0.95, 12: 0.85}
    given.contradictions = {12: ("shin.L",)}
    write_posture(found.armature, posture_of(scene).plus(np.full(HUMAN.dof_count, 0.02)))
    bpy.ops.keymark.store_keyframe()
    bpy.ops.ed.undo_push(message="Stored")
    take = active_take(scene)
    assert (TakeState(take).posed, TakeState(take).matched) == ((7.0,), (1.0, 13.0))
    assert (given.between[-1], given.frames[-1]) == ((0, 12), (0, 12))
    assert [each.index for each in given.takes[-1].keyframes] == [6]
    assert given.floors[-1] == pytest.approx(0.02)
    state = [(round(match.frame), round(match.confidence, 2)) for match in take.matching.matches]
    assert state == [(1, 0.95), (7, 0.3), (13, 0.85)]
    assert take.contradictions[0].frame == 13.0
    bpy.ops.ed.undo()
    assert differences(before, scene_state()) == ""


def test_replacing_improves_as_well_and_accepting_does_not(found: Group, given: SimpleNamespace) -> None:
    asked = len(given.frames)
    found.matching.shown_match = 0
    bpy.ops.keymark.replace_match(candidate=1)
    assert given.frames[asked] == (6, 12)
    take = active_take(bpy.context.scene)
    chosen = shown(take, 1)
    take.matching.shown_match = 1
    bpy.ops.keymark.accept_match()
    assert len(given.frames) == asked + 1
    assert shown(take, 1).minus(chosen) == pytest.approx(0.0, abs=1e-6)


def test_it_is_left_out_where_nothing_is_known(found: Group, given: SimpleNamespace) -> None:
    scene, asked = bpy.context.scene, len(given.frames)
    color = tuple(found.markers[0].color)
    found.markers[0].color = (0.5, 0.1, 0.5)
    assert improve_neighbors(bpy.context, found, 7.0) == 0
    found.markers[0].color = color
    assert improve_neighbors(bpy.context, found, 7.0) == 2
    key, found.reading_key = found.reading_key, ""
    assert improve_neighbors(bpy.context, found, 7.0) == 0
    found.reading_key = key
    bpy.ops.keymark.remove_found()
    assert improve_neighbors(bpy.context, active_take(scene), 7.0) == 0
    assert len(given.frames) == asked + 1


def test_regions_that_are_no_marker_are_part_of_what_was_read(unposed: Group, given: SimpleNamespace) -> None:
    add_ignored_regions(unposed, (IgnoredRegion(box=(1.0, 1.0, 4.0, 4.0)),))
    bpy.ops.keymark.pose_all()
    take = active_take(bpy.context.scene)
    assert improve_neighbors(bpy.context, take, 7.0) == 2
    add_ignored_regions(take, (IgnoredRegion(box=(1.0, 1.0, 5.0, 5.0)),))
    assert improve_neighbors(bpy.context, take, 7.0) == 0


def test_a_correction_holds_where_nothing_is_found_around_it(found: Group, given: SimpleNamespace) -> None:
    bpy.context.scene.frame_set(7)
    others = [shown(found, frame) for frame in (1, 13)]
    bpy.context.scene.frame_set(7)
    given.error = InputError("no marker is seen in the footage")
    assert bpy.ops.keymark.store_keyframe() == {"FINISHED"}
    assert (TakeState(found).posed, TakeState(found).matched) == ((7.0,), (1.0, 13.0))
    for frame, posture in zip((1, 13), others, strict=True):
        assert shown(found, frame).minus(posture) == pytest.approx(0.0, abs=1e-6)
    assert results.reading_of(found) is not None


@pytest.mark.parametrize(("pushed", "improved"), [(False, []), (True, [(0, 12)])], ids=["picture", "depth"])
def test_a_dragged_joint_of_a_found_keyframe_stays_and_improves_its_neighbors_in_depth(
    found: bpy.types.PropertyGroup, given: SimpleNamespace, pushed: bool, improved: list[tuple[int, ...]]
) -> None:
    """What is put right in the picture alone tells them nothing."""
    scene = bpy.context.scene
    scene.frame_set(7)
    bpy.ops.ed.undo_push(message="Opened")
    before, asked = scene_state(), len(given.frames)
    place = joint_places(found.armature)[HUMAN.point_names.index("wrist.L")] + [0.05, 0.0, 0.05]
    camera = camera_now(scene, found)
    bpy.ops.keymark.move_joint(joint="wrist.L", place=place, sight=camera.sight(place, 0), pushed=pushed)
    bpy.ops.ed.undo_push(message="Moved")
    take = active_take(scene)
    assert TakeState(take).posed == (7.0,)
    assert TakeState(take).matched == (1.0, 13.0)
    assert given.frames[asked:] == improved
    reached = joint_places(take.armature)[HUMAN.point_names.index("wrist.L")]
    np.testing.assert_allclose(camera.project(reached, 0)[0], camera.project(place, 0)[0], atol=0.5)  # px
    bpy.ops.ed.undo()
    assert not differences(before, scene_state())


def test_a_turned_found_keyframe_is_posed(found: bpy.types.PropertyGroup, given: SimpleNamespace) -> None:
    bpy.context.scene.frame_set(13)
    before = posture_of(bpy.context.scene)
    bpy.ops.keymark.turn_performer(facing="AWAY", fit=False)
    assert TakeState(active_take(bpy.context.scene)).posed == (13.0,)
    assert np.abs(posture_of(bpy.context.scene).minus(before)).max() > 0.5
