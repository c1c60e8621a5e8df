"""Long jobs on a timer: progress, cancelling, failing, and which of them are running."""

from types import SimpleNamespace
from typing import Any

import bpy
import pytest
from keymark.core.errors import InputError
from keymark.core.progress import Progress
from keymark.operators.shell.job_operator import JobOperator
from keymark.operators.shell.job_progress import job_is_running
from keymark.operators.shell.takes import active_take

pytestmark = pytest.mark.usefixtures("registered")


class Job(JobOperator):
    """A job of twenty steps that would write a custom property at its end."""

    def __init__(self, fail_at: int | None = None) -> None:
        self.fail_at = fail_at
        self.reports: list[tuple[set[str], str]] = []
        self.closed = False

    def report(self, kind: set[str], text: str) -> None:
        self.reports.append((kind, text))

    def start(self, scene: bpy.types.Scene):  # noqa: ANN201
        try:
            for step in range(20):
                if step == self.fail_at:
                    raise InputError("the clip is upside down")
                yield Progress("Counting", step / 20)
            return "counted"
        finally:
            self.closed = True

    def finish(self, scene: bpy.types.Scene, result: str) -> None:
        scene["result"] = result


@pytest.fixture
def context(monkeypatch: pytest.MonkeyPatch) -> SimpleNamespace:
    timers: list[object] = []
    manager = bpy.context.window_manager

    def add(_interval: float, window: Any) -> object:
        timers.append(object())
        return timers[-1]

    fake = SimpleNamespace(
        keymark_progress=manager.keymark_progress,
        windows=manager.windows,
        event_timer_add=add,
        event_timer_remove=timers.remove,
        modal_handler_add=lambda operator: True,
    )
    screen = SimpleNamespace(background=False, translations=bpy.app.translations)
    monkeypatch.setattr("keymark.operators.shell.job_operator.bpy.app", screen, raising=False)
    return SimpleNamespace(
        scene=bpy.context.scene,
        window=bpy.context.window,
        window_manager=fake,
        workspace=bpy.context.workspace,
        timers=timers,
    )


def event(kind: str, value: str = "NOTHING") -> SimpleNamespace:
    return SimpleNamespace(type=kind, value=value)


def run_modal(job: Job, context: SimpleNamespace) -> set[str]:
    for _ in range(100):
        result = job.modal(context, event("TIMER"))
        if result != {"RUNNING_MODAL"}:
            return result
    raise AssertionError("the job never ended")


def test_at_once_the_whole_job_is_done(context: SimpleNamespace) -> None:
    job = Job()
    assert job.execute(context) == {"FINISHED"}
    assert context.scene["result"] == "counted"


def test_on_the_timer_the_job_ends_with_its_result(context: SimpleNamespace) -> None:
    job = Job()
    assert job.invoke(context, event("LEFTMOUSE")) == {"RUNNING_MODAL"}
    assert len(context.timers) == 1
    assert run_modal(job, context) == {"FINISHED"}
    assert context.scene["result"] == "counted"
    assert context.timers == []


def test_escape_leaves_everything_as_it_was(
    context: SimpleNamespace, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("keymark.operators.shell.job_operator.LONGEST_SLICE_S", 0.0)  # one step an event
    job = Job()
    job.invoke(context, event("LEFTMOUSE"))
    assert job.modal(context, event("TIMER")) == {"RUNNING_MODAL"}
    assert context.window_manager.keymark_progress.stage == "Counting"
    assert job.modal(context, event("MOUSEMOVE")) == {"PASS_THROUGH"}
    assert job.modal(context, event("ESC", "PRESS")) == {"CANCELLED"}
    assert job.closed
    assert "result" not in context.scene
    assert context.timers == []
    assert job.reports == [({"INFO"}, "Cancelled")]


@pytest.mark.parametrize("modal", [True, False])
def test_a_failing_job_is_one_sentence(context: SimpleNamespace, modal: bool) -> None:
    job = Job(fail_at=3)
    if modal:
        job.invoke(context, event("LEFTMOUSE"))
        assert run_modal(job, context) == {"CANCELLED"}
    else:
        assert job.execute(context) == {"CANCELLED"}
    assert job.reports == [({"ERROR"}, "The clip is upside down")]
    assert "result" not in context.scene
    assert context.timers == []


def test_a_reconstruction_that_is_cancelled_leaves_the_scene(tiny_take) -> None:  # noqa: ANN001
    from keymark.operators.reconstruct.reconstruct import KEYMARK_OT_reconstruct

    bpy.ops.keymark.open_take(filepath=str(tiny_take.folder))
    scene = bpy.context.scene
    scene.frame_set(6)
    actor = active_take(scene).armature
    before = actor.animation_data.action, len(bpy.data.actions), scene.frame_current
    for steps in (1, 10, 20, 30):
        job = KEYMARK_OT_reconstruct.start(SimpleNamespace(), scene)
        for _ in range(steps):
            next(job, None)
        job.close()
        assert (actor.animation_data.action, len(bpy.data.actions), scene.frame_current) == before
    assert active_take(scene).motion_action is None


def modal_operator(name: str, address: int) -> SimpleNamespace:
    return SimpleNamespace(bl_idname=name, as_pointer=lambda: address)


@pytest.mark.parametrize(("browsed", "runs"), [(None, True), (7, False), (8, True)])
def test_an_open_file_browser_is_no_running_job(browsed: int | None, runs: bool) -> None:
    modal = modal_operator("KEYMARK_OT_load_footage", 7)
    asking = None if browsed is None else modal_operator("KEYMARK_OT_load_footage", browsed)
    space = SimpleNamespace(active_operator=asking)
    area = SimpleNamespace(type="FILE_BROWSER", spaces=SimpleNamespace(active=space))
    window = SimpleNamespace(modal_operators=[modal], screen=SimpleNamespace(areas=[area]))
    context = SimpleNamespace(window_manager=SimpleNamespace(windows=[window]))
    assert job_is_running(context) is runs
    assert job_is_running(context, "keymark.load_footage") is runs
    assert not job_is_running(context, "keymark.reconstruct")


def test_dragging_joints_lets_other_operators_go_on() -> None:
    modal = [modal_operator("KEYMARK_OT_drag_joints", 7)]
    window = SimpleNamespace(modal_operators=modal, screen=SimpleNamespace(areas=[]))
    context = SimpleNamespace(window_manager=SimpleNamespace(windows=[window]))
    assert not job_is_running(context)
    assert job_is_running(context, "keymark.drag_joints")
    modal.append(modal_operator("KEYMARK_OT_reconstruct", 8))
    assert job_is_running(context)
