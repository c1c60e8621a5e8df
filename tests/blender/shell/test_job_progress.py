"""Which modal operators are running jobs."""

from types import SimpleNamespace

import pytest
from keymark.operators.shell.job_progress import job_is_running


def _operator(name: str, address: int) -> SimpleNamespace:
    return SimpleNamespace(bl_idname=name, as_pointer=lambda: address)


@pytest.mark.parametrize(("browsed", "runs"), [(None, True), (7, False), (8, True)])
def test_an_open_file_browser_is_no_running_job(browsed: int | None, runs: bool) -> None:
    modal = _operator("KEYMARK_OT_load_footage", 7)
    asking = None if browsed is None else _operator("KEYMARK_OT_load_footage", browsed)
    space = SimpleNamespace(active_operator=asking)
    area = SimpleNamespace(type="FILE_BROWSER", spaces=SimpleNamespace(active=space))
    window = SimpleNamespace(modal_operators=[modal], screen=SimpleNamespace(areas=[area]))
    context = SimpleNamespace(window_manager=SimpleNamespace(windows=[window]))
    assert job_is_running(context) is runs
    assert job_is_running(context, "keymark.load_footage") is runs
    assert not job_is_running(context, "keymark.reconstruct")


def test_dragging_joints_lets_other_operators_go_on() -> None:
    modal = [_operator("KEYMARK_OT_drag_joints", 7)]
    window = SimpleNamespace(modal_operators=modal, screen=SimpleNamespace(areas=[]))
    context = SimpleNamespace(window_manager=SimpleNamespace(windows=[window]))
    assert not job_is_running(context)
    assert job_is_running(context, "keymark.drag_joints")
    modal.append(_operator("KEYMARK_OT_reconstruct", 8))
    assert job_is_running(context)
