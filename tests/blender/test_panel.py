"""The sidebar in every state of the work: what it shows, how much of it, and that none of it fails."""

from collections.abc import Callable
from pathlib import Path

import bpy
import pytest
from _panel import calls, controls, drawn_panels
from keymark.core.take.take import Take
from keymark.operators.shell.take_state import STEPS, TakeState
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


def test_the_top_line_says_how_good_a_motion_is_and_what_to_do(opened: bpy.types.Scene) -> None:
    def said() -> str:
        return " ".join(words for kind, _, words in drawn_panels() if kind == "label")

    take = active_take(opened)
    take.method = "interpolation"
    bpy.ops.keymark.reconstruct()
    take.review.confidence, start, update = 0.6, "keymark.pose_from_motion", "keymark.update"
    for frame in (4, 8):
        take.review.weak_frames.add().frame = frame
    assert "Good for blocking; 2 frames are worth correcting" in said() and start in controls()
    for left, frame in ((1, 4), (0, 8)):  # the one that is chosen, then the one that is left
        bpy.ops.keymark.pose_from_motion(where="WEAK")
        assert opened.frame_current == frame and len(TakeState(take).open_weak) == left
        assert "correct more, or update" in said() and update in controls() and start not in controls()
    bpy.ops.keymark.update()
    assert "review, then a character" in said() and update not in controls()


def test_just_the_character_hides_the_actor(opened: bpy.types.Scene) -> None:
    actor, overlays = active_take(opened).armature, opened.keymark.overlays
    for only in (True, False):
        overlays.only_character = only
        assert actor.hide_get() is only


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


OUTSIDE = ("wm.path_open",)  # Shows a folder in another program


def as_empty(_: Take) -> None:
    pass


def as_loaded(take: Take) -> None:
    bpy.ops.keymark.load_footage(filepath=str(take.clip))


def as_built(take: Take) -> None:
    as_loaded(take)
    bpy.ops.keymark.keep_camera()
    bpy.ops.keymark.add_usual_markers()
    bpy.ops.keymark.build_actor()


def as_finished(take: Take) -> None:
    bpy.ops.keymark.open_take(filepath=str(take.folder))
    bpy.ops.keymark.reconstruct()
    bpy.ops.keymark.bake_motion()


def as_lost(take: Take) -> None:
    as_finished(take)
    bpy.data.objects.remove(active_take(bpy.context.scene).armature)


@pytest.mark.parametrize("state", [as_empty, as_loaded, as_built, as_finished, as_lost])
def test_no_button_ends_in_a_traceback(
    state: Callable[[Take], None], tiny_take: Take, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each is asked for its tooltip and called: it does its work or says why not."""
    monkeypatch.setenv("BLENDER_USER_RESOURCES", str(tmp_path / "user"))
    state(tiny_take)
    blend = str(tmp_path / "state.blend")
    bpy.ops.wm.save_as_mainfile(filepath=blend)
    offered = {}
    for step in STEPS:
        setattr(bpy.context.window_manager.keymark_steps, step, True)
        offered |= {(name, *settings): (name, settings) for name, settings in calls()}
    assert len(offered) >= 4
    for name, settings in offered.values():
        if name in OUTSIDE:
            continue
        group, _, operator = name.partition(".")
        try:
            getattr(getattr(bpy.ops, group), operator)(**settings)
        except RuntimeError as error:
            assert "Traceback" not in str(error), f"{name} {settings}: {error}"
            continue
        bpy.ops.wm.open_mainfile(filepath=blend)
