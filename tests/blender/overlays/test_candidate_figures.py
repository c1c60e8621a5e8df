"""Figures of a found keyframe's candidates, without a screen."""

from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from _found import show_found
from keymark.core.body.human import HUMAN
from keymark.core.take.motion import Motion
from keymark.operators.bridge.footage import read_camera
from keymark.operators.keyframes.change_match import KEYMARK_OT_replace_match
from keymark.operators.overlays import tools, views
from keymark.operators.overlays.drawing import Label, Stroke, candidate_icon
from keymark.operators.shell.footage_view import FootageView
from keymark.operators.shell.takes import active_take, footage_of

FOOTAGE = FootageView(None, (160, 120), np.array([10.0, 490.0]), np.array([640.0, -480.0]), None)
Group = bpy.types.PropertyGroup


@pytest.fixture
def match(opened: bpy.types.Scene, wave_motion: Motion) -> Group:
    take = active_take(opened)
    show_found(opened, wave_motion)
    return take.matching.matches[0]


@pytest.fixture(autouse=True)
def footage_shown(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(views, "footage_view", lambda *_: FOOTAGE)


def context_of(scene: bpy.types.Scene, playing: bool = False) -> SimpleNamespace:
    space, screen = SimpleNamespace(type="CLIP_EDITOR"), SimpleNamespace(is_animation_playing=playing)
    return SimpleNamespace(scene=scene, space_data=space, screen=screen, area=None, region=None)


def view_of(scene: bpy.types.Scene) -> views.MotionView:
    return views.motion_view(context_of(scene), active_take(scene))


def test_figures_stand_where_the_candidates_would(
    match: Group, opened: bpy.types.Scene, wave_motion: Motion
) -> None:
    take = active_take(opened)
    points = tools.candidate_points(take.armature, match)
    assert points == pytest.approx(wave_motion.points[[3, 9]], abs=1e-4)
    seen = read_camera(footage_of(opened, take), np.array([4.0])).project(points)[0]
    view = view_of(opened)
    assert view.project(points) == pytest.approx(FOOTAGE.to_region(seen), abs=1e-3)
    assert np.isnan(view.project(points - [0.0, 20.0, 0.0])).all()


def test_they_are_found_anew_only_where_something_changed(match: Group, opened: bpy.types.Scene) -> None:
    armature = active_take(opened).armature
    first = tools.candidate_points(armature, match)
    assert tools.candidate_points(armature, match) is first
    armature.scale = (1.2, 1.2, 1.2)
    bpy.context.view_layer.update()
    again = tools.candidate_points(armature, match)
    assert np.ptp(again[0, :, 2]) == pytest.approx(1.2 * np.ptp(first[0, :, 2]), rel=0.05)


def test_each_has_the_color_and_the_number_of_its_button(match: Group, opened: bpy.types.Scene) -> None:
    points = tools.candidate_points(active_take(opened).armature, match)
    positions = view_of(opened).project(points)
    settings = SimpleNamespace(opacity=0.5)
    for chosen, other in ((0, 1), (1, 0)):
        lines, cores, number = tools.candidate_figure(positions, other, chosen, settings)
        assert isinstance(lines, Stroke) and len(lines.segments) == 12 and len(cores.segments) == 4
        theme = bpy.context.preferences.themes[0].collection_color[other].color
        assert tuple(lines.color)[:3] == pytest.approx(tuple(theme)) and lines.color[3] < 0.5
        assert isinstance(number, Label) and number.words == str(other + 1)
        apart = np.linalg.norm(positions[other] - positions[chosen], axis=-1)
        assert number.x == pytest.approx(positions[other, apart.argmax(), 0])
        assert "wrist" in HUMAN.point_names[apart.argmax()]
        assert candidate_icon(other) == f"COLLECTION_COLOR_0{other + 1}"
    icons = bpy.types.UILayout.bl_rna.functions["label"].parameters["icon"].enum_items
    assert all(candidate_icon(index) in icons for index in range(9))


def test_points_that_are_not_seen_are_left_out() -> None:
    positions = np.full((2, 13, 2), np.nan)
    positions[0] = np.arange(26.0).reshape(13, 2)
    lines, cores = tools.candidate_figure(positions, 1, 0, SimpleNamespace(opacity=1.0))
    assert len(lines.segments) == len(cores.segments) == 0


def tooltip(candidate: int) -> str:
    """What Blender asks of a button that the mouse is over."""
    settings = SimpleNamespace(candidate=candidate)
    return KEYMARK_OT_replace_match.description(bpy.context, settings)


REASONS = ["nothing", "another frame", "off", "posed", "playing", "one candidate", "the chosen one"]
REASONS += ["fewer since", "the motion is shown"]


@pytest.mark.parametrize("reason", REASONS)
def test_the_one_under_the_mouse_is_drawn_at_an_undecided_frame_alone(
    match: Group, opened: bpy.types.Scene, reason: str
) -> None:
    assert tooltip(0 if reason == "the chosen one" else 1)
    if reason == "another frame":
        opened.frame_set(6)
    if reason == "off":
        opened.keymark.overlays.show_candidates = False
    if reason == "posed":
        bpy.ops.keymark.store_keyframe()
    if reason == "one candidate":
        match.candidates.remove(1)
    if reason == "fewer since":
        tools.look_at(bpy.context, len(match.candidates))
    if reason == "the motion is shown":
        active_take(opened).armature.animation_data.action = bpy.data.actions.new("Motion")
    assert bool(tools.draw_candidate(context_of(opened, reason == "playing"))) == (reason == "nothing")
