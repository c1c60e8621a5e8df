"""Contradictions: kept with the take at their frame for as long as they are true."""

from types import SimpleNamespace

import bpy
import pytest
from keymark.operators.shell.notes import note_contradictions
from keymark.operators.shell.panel import draw_contradictions
from keymark.operators.shell.take_state import TakeState
from keymark.operators.shell.takes import active_take

Group = bpy.types.PropertyGroup


class Layout:
    """Keeps what is drawn."""

    def __init__(self) -> None:
        self.lines: list[str] = []
        self.scale_y = 1.0

    def column(self, align: bool = False) -> "Layout":
        return self

    def label(self, text: str = "", icon: str = "NONE", translate: bool = True) -> None:
        self.lines.append(text)


class Context:
    """What drawing asks of a context."""

    def __init__(self, scene: bpy.types.Scene) -> None:
        self.scene, self.region = scene, SimpleNamespace(width=2000)
        self.window_manager = bpy.context.window_manager
        self.preferences = SimpleNamespace(system=SimpleNamespace(ui_scale=1.0))


@pytest.fixture
def take(opened: bpy.types.Scene) -> Group:
    found = active_take(opened)
    note_contradictions(found, 5.0, ("shin.L", "wrist.R"))
    return found


def drawn(scene: bpy.types.Scene, frame: int) -> str:
    scene.frame_set(frame)
    layout = Layout()
    draw_contradictions(layout, Context(scene), TakeState(active_take(scene)))
    return " ".join(layout.lines)


def test_it_is_said_at_its_frame_alone(take: Group, opened: bpy.types.Scene) -> None:
    take.follow.use_keypoints = True
    assert "shin.L, wrist.R" in drawn(opened, 5)
    assert drawn(opened, 4) == drawn(opened, 6) == ""


def test_a_frame_that_is_looked_at_again_says_the_newest(take: Group) -> None:
    note_contradictions(take, 5.0, ("trunk",))
    assert TakeState(take).contradictions_at(5.0) == ("trunk",)
    note_contradictions(take, 5.0, ())
    assert TakeState(take).contradictions_at(5.0) == () and not len(take.contradictions)


def test_what_is_followed_no_more_contradicts_no_more(take: Group) -> None:
    take.follow.use_keypoints = take.follow.use_tracks = False
    assert TakeState(take).contradictions_at(5.0) == ("shin.L",)
    take.follow.use_keypoints = True
    take.markers.remove([marker.name for marker in take.markers].index("shin.L"))
    assert TakeState(take).contradictions_at(5.0) == ("wrist.R",)
    take.reading_key = "another"
    assert TakeState(take).contradictions_at(5.0) == ()


def test_storing_a_keyframe_settles_it(take: Group, opened: bpy.types.Scene) -> None:
    opened.frame_set(5)
    bpy.ops.keymark.store_keyframe()
    assert TakeState(active_take(opened)).contradictions_at(5.0) == ()
