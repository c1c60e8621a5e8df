"""The sidebar in every state of the work: what it shows, how much of it, and that none of it fails."""

import bpy
import pytest
from _panel import controls, drawn_panels
from keymark.core.take.take import Take
from keymark.operators.shell.steps import STEPS
from keymark.operators.shell.takes import active_take

pytestmark = pytest.mark.usefixtures("registered")

MOST, FRESH = 25, 12  # Controls at any time, and of a clip that was just loaded


def steps_shown() -> list[str]:
    """Titles of the steps."""
    return [words for kind, _, words in drawn_panels() if kind == "label" and words in TITLES]


TITLES = ("Clip", "Performer", "Poses", "Motion", "Character", "Export")


def every_step() -> dict[str, int]:
    """How many controls the sidebar shows with each step open."""
    shown, counts = bpy.context.window_manager.keymark_steps, {}
    for step in STEPS:
        setattr(shown, step, True)
        counts[step] = len(controls())
    return counts


def test_an_empty_scene_shows_where_to_begin() -> None:
    assert steps_shown() == []
    assert {"keymark.load_footage", "keymark.open_take", "keymark.open_example"} <= set(controls())


def test_few_controls_are_shown_in_every_state(tiny_take: Take) -> None:
    bpy.ops.keymark.load_footage(filepath=str(tiny_take.clip))
    take = active_take(bpy.context.scene)
    assert len(controls()) <= FRESH
    assert sorted(steps_shown()) == sorted(TITLES)
    assert max(every_step().values()) <= MOST
    bpy.ops.keymark.keep_camera()
    bpy.ops.keymark.add_usual_markers()
    assert max(every_step().values()) <= MOST
    bpy.ops.keymark.build_actor()
    assert max(every_step().values()) <= MOST
    bpy.ops.keymark.store_keyframe()
    take.clip_state.missing = True
    assert max(every_step().values()) <= MOST


@pytest.mark.parametrize("editor", ["VIEW_3D", "CLIP_EDITOR"])
def test_each_kind_of_evidence_has_its_settings(opened: bpy.types.Scene, editor: str) -> None:
    shown = bpy.context.window_manager.keymark_steps
    shown.actor = True
    inside = {
        "markers": "keymark.pick_markers",
        "keypoints": "keymark.detect_keypoints",
        "tracks": "use_tracks",
        "contours": "use_contours",
    }
    for kind, control in inside.items():
        setattr(shown, kind, True)
        assert control in controls(editor)
        assert len(controls(editor)) <= MOST
        assert [each for each in inside if getattr(shown, each)] == [kind]


def test_a_motion_is_reviewed_and_given_on(opened: bpy.types.Scene) -> None:
    bpy.ops.keymark.reconstruct()
    take = active_take(opened)
    assert {"keymark.reconstruct", "keymark.show_action"} <= set(controls())
    bpy.ops.keymark.bake_motion()
    assert max(every_step().values()) <= MOST
    bpy.data.objects.remove(take.armature)
    assert max(every_step().values()) <= MOST
    bpy.context.window_manager.keymark_steps.actor = True
    assert "keymark.apply_lengths" in controls()


def test_a_folded_step_offers_what_is_next_where_it_can_be_pressed(opened: bpy.types.Scene) -> None:
    assert bpy.context.window_manager.keymark_steps.keyframes
    assert "keymark.reconstruct" in controls()
    assert "keymark.bake_motion" not in controls()
    active_take(opened).keyframe_action = None
    assert "keymark.reconstruct" not in controls()
