"""Draw handlers in Blender, and their failures."""

from types import SimpleNamespace

import bpy
import pytest
from keymark.core.errors import InputError
from keymark.operators.overlays import registry
from keymark.operators.overlays.registry import Overlay, guarded


@pytest.fixture(autouse=True)
def blending(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    modes: list[str] = []
    monkeypatch.setattr(registry, "gpu", SimpleNamespace(state=SimpleNamespace(blend_set=modes.append)))
    registry.FAILURES.clear()
    return modes


@pytest.mark.parametrize(
    ("error", "calls", "said"),
    [
        (ValueError("no such marker"), 1, "no such marker"),
        (ValueError(), 1, "ValueError"),
        (InputError("camera 'Camera' is of type ORTHO; footage needs a perspective one"), 2, None),
    ],
)
def test_an_unexpected_failure_alone_is_logged_and_switches_that_overlay_off(
    caplog: pytest.LogCaptureFixture, blending: list[str], error: Exception, calls: int, said: str | None
) -> None:
    drawn: list[bpy.types.Context] = []

    def draw(context: bpy.types.Context) -> tuple[()]:
        drawn.append(context)
        raise error

    handler = guarded(Overlay("Broken", draw, "SpaceView3D"))
    handler()
    handler()
    assert len(drawn) == calls and blending == ["ALPHA", "NONE"] * calls
    assert list(registry.FAILURES.values()) == ([said] if said else [])
    assert len(caplog.records) == bool(said) == ("'Broken' failed" in caplog.text)
    registry.FAILURES.clear()
    handler()
    guarded(Overlay("Sound", lambda context: drawn.append(context) or (), "SpaceView3D"))()
    assert len(drawn) == calls + 2


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
