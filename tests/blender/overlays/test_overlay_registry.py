"""Draw handlers in Blender, and their failures."""

from types import SimpleNamespace

import bpy
import pytest
from keymark.core.errors import InputError
from keymark.operators.overlays import registry
from keymark.operators.overlays.registry import DrawFunction, Overlay, guarded


def overlay(draw: DrawFunction) -> Overlay:
    return Overlay("Broken", draw, "SpaceView3D")


@pytest.fixture(autouse=True)
def blending(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    modes: list[str] = []
    monkeypatch.setattr(registry, "gpu", SimpleNamespace(state=SimpleNamespace(blend_set=modes.append)))
    registry.try_again()
    return modes


def test_a_failure_is_logged_once_and_switches_the_overlay_off(
    caplog: pytest.LogCaptureFixture, blending: list[str]
) -> None:
    calls = []

    def draw(context: bpy.types.Context) -> None:
        calls.append(context)
        raise ValueError("no such marker")

    handler = guarded(overlay(draw))
    handler()
    handler()
    assert len(calls) == len(caplog.records) == 1
    assert "'Broken' failed" in caplog.text
    assert registry.failures() == {"Broken": "no such marker"}
    assert blending == ["ALPHA", "NONE"]
    registry.try_again()
    handler()
    assert len(calls) == 2


def test_another_overlay_goes_on(blending: list[str]) -> None:
    calls = []

    def draw(context: bpy.types.Context) -> None:
        raise ValueError

    guarded(overlay(draw))()
    guarded(Overlay("Sound", lambda context: calls.append(context) or (), "SpaceView3D"))()
    assert calls == [bpy.context]
    assert registry.failures() == {"Broken": "ValueError"}
    assert blending == ["ALPHA", "NONE"] * 2


def test_what_is_not_dragged_is_hidden_meanwhile(monkeypatch: pytest.MonkeyPatch) -> None:
    calls: list[bpy.types.Context] = []
    handlers = [
        guarded(Overlay("Any", lambda context: calls.append(context) or (), "SpaceView3D", correcting))
        for correcting in (True, False)
    ]
    for handler in handlers:
        handler()
    assert len(calls) == 2
    monkeypatch.setattr(registry, "job_is_running", lambda _context, job: job == "keymark.drag_joints")
    for handler in handlers:
        handler()
    assert len(calls) == 3


def test_every_overlay_can_be_handed_to_blender() -> None:
    for each in registry.OVERLAYS:
        space = getattr(bpy.types, each.space)
        handler = space.draw_handler_add(guarded(each), (), "WINDOW", "POST_PIXEL")
        assert handler is not None, each
        space.draw_handler_remove(handler, "WINDOW")
        with pytest.raises(ValueError):  # it is gone
            space.draw_handler_remove(handler, "WINDOW")


def test_without_a_screen_no_handler_is_added() -> None:
    registry.register()
    assert registry._handlers == []
    registry.unregister()


def test_what_cannot_be_drawn_now_is_drawn_when_it_can(blending: list[str]) -> None:
    calls = []

    def draw(context: bpy.types.Context) -> None:
        calls.append(context)
        raise InputError("camera 'Camera' is of type ORTHO; footage needs a perspective one")

    handler = guarded(overlay(draw))
    handler()
    handler()
    assert len(calls) == 2 and not registry.failures()
    assert blending == ["ALPHA", "NONE"] * 2
