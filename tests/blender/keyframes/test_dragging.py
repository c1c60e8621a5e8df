"""Dragging joints: shown at once, with the path around the frame; stored by Enter, taken back by Esc."""

from types import SimpleNamespace
from typing import Any

import bpy
import numpy as np
import pytest
from _results import posture_of, shown
from _scene_state import differences, scene_state
from keymark.core.arrays import Array
from keymark.core.body.human import HUMAN
from keymark.operators.bridge.actor_bones import joint_places
from keymark.operators.bridge.keyframes import unchanged_keyframes
from keymark.operators.bridge.keys import PICTURED
from keymark.operators.keyframes import drag_joints
from keymark.operators.overlays.tools import Handles
from keymark.operators.shell import need
from keymark.operators.shell.take_state import TakeState
from keymark.operators.shell.takes import active_take

pytestmark = [pytest.mark.usefixtures("registered")]

Group = bpy.types.PropertyGroup
PIXELS = 1000.0  # that show a meter


class FrontView:
    """A view along Y without perspective."""

    def position(self, place: Array) -> Array:
        return PIXELS * np.asarray(place)[[0, 2]]

    def place(self, position: Array, depth: Array) -> Array:
        return np.array([position[0] / PIXELS, depth[1], position[1] / PIXELS])

    def sight(self, position: Array) -> Array:
        return np.array([0.0, 1.0, 0.0])


class Tool:
    """The operator without Blender's window: its events come from a test."""

    def __init__(self) -> None:
        self._handles = Handles()
        self.reports: list[str] = []
        self.inside = True
        self.context = SimpleNamespace(
            scene=bpy.context.scene, window=None, window_manager=bpy.context.window_manager
        )

    def report(self, kind: set[str], text: str) -> None:
        self.reports.append(text)

    def send(self, kind: str, value: str = "PRESS", x: int = 0, y: int = 0, **keys: bool) -> set[str]:
        held = {"ctrl": False, "shift": False, "oskey": False, **keys}
        return self.modal(self.context, SimpleNamespace(type=kind, value=value, mouse_x=x, mouse_y=y, **held))

    def drag(self, x: int, y: int, **keys: bool) -> None:
        self.send("LEFTMOUSE")
        self.send("MOUSEMOVE", "NOTHING", x, y, **keys)
        self.send("LEFTMOUSE", "RELEASE", x, y, **keys)


for _name, _value in vars(drag_joints.KEYMARK_OT_drag_joints).items():
    if not hasattr(Tool, _name):
        setattr(Tool, _name, _value)


@pytest.fixture
def tool(found: Group, monkeypatch: pytest.MonkeyPatch) -> Any:
    """The tool at the found keyframe at frame 7, with the mouse over the left wrist."""
    bpy.context.scene.frame_set(7)
    running = Tool()
    running._handles.hovered = "wrist.L"
    monkeypatch.setattr(drag_joints, "view_under", lambda *_: FrontView() if running.inside else None)
    monkeypatch.setattr(drag_joints, "nearest_joint", lambda *_: "wrist.L")
    for module, name in ((drag_joints, "show_keys"), (drag_joints, "redraw_editors"), (need, "idle")):
        monkeypatch.setattr(module, name, lambda *_: None)
    return running


def test_a_drag_is_shown_and_escape_leaves_everything_as_it_was(tool: Any) -> None:
    before, posture = scene_state(), posture_of(bpy.context.scene)
    tool.drag(50, 40)
    first = posture_of(bpy.context.scene)
    tool.drag(0, 40, ctrl=True)
    assert np.abs(first.minus(posture)).max() > 0.05
    assert np.abs(posture_of(bpy.context.scene).minus(first)).max() > 0.05
    assert TakeState(active_take(bpy.context.scene)).matched == (1.0, 7.0, 13.0)
    assert tool.send("ESC") == {"CANCELLED"}
    assert differences(before, scene_state()) == ""
    assert posture_of(bpy.context.scene).minus(posture) == pytest.approx(0.0, abs=1e-6)


def test_enter_stores_all_drags_once_and_leaves_the_neighbors(tool: Any, given: SimpleNamespace) -> None:
    bpy.ops.ed.undo_push(message="Opened")
    before, asked = scene_state(), len(given.frames)
    tool.drag(50, 40)
    tool.drag(-20, 10)
    wanted = posture_of(bpy.context.scene)
    assert given.frames[asked:] == []
    assert tool.send("RET") == {"FINISHED"}
    take = active_take(bpy.context.scene)
    assert (TakeState(take).posed, TakeState(take).matched) == ((7.0,), (1.0, 13.0))
    assert given.frames[asked:] == []
    assert shown(take, 7).minus(wanted) == pytest.approx(0.0, abs=1e-4)
    bpy.ops.ed.undo()
    assert differences(before, scene_state()) == ""


def test_without_a_drag_enter_stores_nothing(tool: Any) -> None:
    before = scene_state()
    tool.drag(0, 0)
    assert tool.send("RET") == {"CANCELLED"}
    assert differences(before, scene_state()) == ""


def test_what_was_set_before_stays_seen_while_another_joint_is_dragged(
    tool: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The wrist follows the shoulder; set before, it comes back to where it was set."""
    row, followed = HUMAN.point_names.index("wrist.L"), []
    for set_px in (0, 20):
        for joint, moved_px in (("wrist.L", set_px), ("shoulder.L", 40)):
            before = joint_places(active_take(bpy.context.scene).armature)[row]
            tool._handles.hovered = joint
            monkeypatch.setattr(drag_joints, "nearest_joint", lambda *_, joint=joint: joint)
            tool.drag(moved_px, 0)
        after = joint_places(active_take(bpy.context.scene).armature)[row]
        followed.append(float(np.linalg.norm((after - before)[[0, 2]])))
        tool.send("ESC")
    assert followed[0] > 0.03 and followed[1] < 0.5 * followed[0]


@pytest.mark.usefixtures("still_neighbors")
def test_depth_counts_if_one_of_the_drags_was_in_depth(tool: Any) -> None:
    take = active_take(bpy.context.scene)
    tool.drag(0, 40, ctrl=True)
    tool.drag(30, 0)
    tool.send("RET")
    assert unchanged_keyframes(take.armature, take.keyframe_action, PICTURED) == ()
    assert 7.0 in TakeState(take).posed


def test_undo_takes_back_the_last_drag_alone(tool: Any) -> None:
    tool.drag(50, 40)
    first = posture_of(bpy.context.scene)
    tool.drag(-30, 20)
    assert tool.send("Z", ctrl=True) == {"RUNNING_MODAL"}
    assert posture_of(bpy.context.scene).minus(first) == pytest.approx(0.0, abs=1e-6)
    tool.send("Z", ctrl=True)
    assert tool.send("Z", ctrl=True) == {"PASS_THROUGH"}  # Blender's own


def test_the_path_around_the_frame_changes_with_the_drag(tool: Any) -> None:
    tool.drag(80, 60)
    joint, (before, after) = tool._handles.path
    apart = np.linalg.norm(after - before, axis=-1)
    assert joint == "wrist.L" and len(apart) == 13
    assert apart[6] > 0.05 and (apart[[4, 8]] > 0.01).all()
    assert apart[[0, 12]] == pytest.approx(0.0, abs=1e-6)
    tool.send("Z", ctrl=True)
    assert tool._handles.path is None


def test_a_click_elsewhere_stores_first_and_another_frame_drops_it_with_a_word(tool: Any) -> None:
    tool.drag(50, 40)
    bpy.context.scene.frame_set(9)
    tool.send("TIMER")
    assert tool.reports == ["The pose dragged at frame 7 was not stored"]
    assert TakeState(active_take(bpy.context.scene)).posed == ()
    bpy.context.scene.frame_set(7)
    tool.drag(50, 40)
    tool.inside = False
    assert tool.send("LEFTMOUSE") == {"FINISHED", "PASS_THROUGH"}
    assert TakeState(active_take(bpy.context.scene)).posed == (7.0,)
