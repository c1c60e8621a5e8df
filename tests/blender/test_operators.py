"""The operators, scripted as an animator would press them."""

from pathlib import Path

import bpy
import numpy as np
import pytest
from keymark.core.body.body_volume import MARKER_SEGMENTS
from keymark.core.take.take import Take
from keymark.core.take.take_file import read_take
from keymark.operators.bridge.armature import read_body
from keymark.operators.follow.properties import SEGMENTS
from keymark.operators.shell.takes import active_take

pytestmark = pytest.mark.usefixtures("registered")


def test_markers_can_be_bound_to_what_core_knows(body) -> None:  # noqa: ANN001
    assert set(SEGMENTS) == set(MARKER_SEGMENTS)


def test_opening_a_take_fills_the_scene(opened: bpy.types.Scene, tiny_take: Take) -> None:
    settings = active_take(opened)
    assert opened.active_clip.frame_duration == 13
    lengths = read_body(settings.armature).actor.segments_m
    assert dict(lengths) == pytest.approx(dict(tiny_take.body.actor.segments_m), rel=1e-5)
    assert [(m.name, m.segment) for m in settings.markers] == [(s.name, s.segment) for s in tiny_take.markers]
    assert [round(255 * v) for v in settings.markers[1].color] == list(tiny_take.markers[1].color_srgb)
    assert settings.armature.animation_data.action == settings.keyframe_action


def test_a_take_that_cannot_be_read_changes_nothing(tiny_take: Take) -> None:
    (tiny_take.folder / "take.json").write_text("{")
    with pytest.raises(RuntimeError, match=r"take\.json"):
        bpy.ops.keymark.open_take(filepath=str(tiny_take.folder))
    assert len(bpy.data.objects) == len(bpy.data.movieclips) == 0


def test_a_take_goes_out_and_comes_back(opened: bpy.types.Scene, tiny_take: Take, tmp_path: Path) -> None:
    folder = tmp_path / "saved"
    bpy.ops.keymark.save_take(directory=str(folder))
    saved = read_take(folder)
    assert (saved.fps, saved.frame_start, saved.frame_count) == (tiny_take.fps, 1, 13)
    assert [style.color_srgb for style in saved.markers] == [style.color_srgb for style in tiny_take.markers]
    points = np.array([[0.3, 0.2, 1.4]])
    assert saved.camera.project(points)[0] == pytest.approx(tiny_take.camera.project(points)[0], abs=0.01)
    for was, now in zip(tiny_take.keyframes, saved.keyframes, strict=True):
        assert now.index == was.index
        assert now.posture.minus(was.posture) == pytest.approx(0.0, abs=1e-4)


def test_proposals_can_be_jumped_to(opened: bpy.types.Scene) -> None:
    take = active_take(opened)
    take.keyframe_count = 4
    for _ in range(2):
        bpy.ops.keymark.propose_keyframes()
        frames = [proposal.frame for proposal in take.proposals]
        assert len(frames) == 4
        assert (frames[0], frames[-1]) == (1, 13)
    opened.frame_set(1)
    bpy.ops.keymark.jump_to_proposal(direction="NEXT")
    assert opened.frame_current == frames[1]
    bpy.ops.keymark.jump_to_proposal(direction="PREVIOUS")
    assert opened.frame_current == 1
    assert bpy.ops.keymark.jump_to_proposal(direction="PREVIOUS") == {"CANCELLED"}


def test_two_markers_on_one_segment_are_refused(opened: bpy.types.Scene) -> None:
    active_take(opened).markers[1].segment = "trunk"
    with pytest.raises(RuntimeError, match="Two markers have the segment 'trunk'"):
        bpy.ops.keymark.reconstruct()


@pytest.mark.parametrize(
    ("operator", "sentence"),
    [
        ("reconstruct", "Load the footage or open a take first"),
        ("store_keyframe", "Build the actor first"),
        ("propose_keyframes", "Load the footage"),
        ("remove_marker", "Add the markers"),
        ("jump_to_proposal", "Propose keyframes first"),
        ("pick_marker_color", "Load the footage"),
        ("save_take", "Load the footage"),
        ("show_action", "Build the actor first"),
    ],
)
def test_an_operator_that_cannot_run_says_what_is_missing(operator: str, sentence: str) -> None:
    with pytest.raises(RuntimeError, match=sentence):
        getattr(bpy.ops.keymark, operator)()


def test_building_an_actor_selects_it_alone(opened: bpy.types.Scene) -> None:
    bpy.data.objects.remove(active_take(opened).armature)
    bpy.ops.keymark.build_actor(stature=1.6)
    layer = bpy.context.view_layer
    assert list(layer.objects.selected) == [active_take(opened).armature] == [layer.objects.active]
    assert active_take(opened).armature.animation_data.action == active_take(opened).keyframe_action
    assert read_body(active_take(opened).armature).actor.stature_m == pytest.approx(1.6, rel=1e-4)


def test_storing_a_pose_beyond_the_skeleton_warns_but_stores(opened: bpy.types.Scene) -> None:
    forearm = active_take(opened).armature.pose.bones["forearm.L"]
    forearm.rotation_euler = (0.5, 0.0, 0.6)
    opened.frame_set(4)
    forearm.rotation_euler = (0.5, 0.0, 0.6)
    assert bpy.ops.keymark.store_keyframe() == {"FINISHED"}
    opened.frame_set(5)
    opened.frame_set(4)
    assert tuple(forearm.rotation_euler) == pytest.approx((0.5, 0.0, 0.6))
