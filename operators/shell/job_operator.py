"""Operators of long jobs, and Esc in them and in operators that wait for a click.

Both are ended by their own `cancel`, which Blender also calls when it closes a window or opens another file.
A job's generator is closed in the middle; only `JobOperator.finish` writes to the scene, so the scene is as
before the job, and Blender adds no undo step.
"""

from abc import abstractmethod
from collections.abc import Generator
from time import monotonic
from typing import Any

import bpy
from bpy.types import Context, Event, Scene

from ...core.errors import InputError
from ...core.progress import Progress
from ...core.progress import run as run_job
from ..bridge.keys import keys_changed
from .base_operator import BaseOperator, capitalized, reported
from .job_progress import time_left
from .takes import redraw_sidebars, redraw_sidebars_soon


def cancel_job(operator: Any, context: Context, event: Event) -> bool:
    """Cancel a modal operator's job if the event is Esc, and report it; return whether it was cancelled."""
    if event.type != "ESC" or event.value != "PRESS":
        return False
    operator.cancel(context)
    operator.report({"INFO"}, "Cancelled")
    return True


def cancel_click(operator: Any, context: Context, event: Event) -> bool:
    """Cancel an operator that waits for a click on Esc or a right click; return whether it was cancelled."""
    if event.type not in ("ESC", "RIGHTMOUSE") or event.value != "PRESS":
        return False
    operator.cancel(context)
    return True


TIMER_S = 0.01
SHORTEST_SLICE_S, LONGEST_SLICE_S = 0.05, 0.5
"""Bounds of a time slice; in between, a job runs as long as the user interface took to draw."""


class JobOperator(BaseOperator):
    """Mixin of an operator whose work is a job: a generator that yields its progress and returns its result.

    A subclass gives `start`, which changes nothing, and `finish`, which writes the result into the scene:
    so a job that is cancelled (see `cancel_on_esc`) or fails leaves everything as it was.
    """

    _job: Generator[Any, None, Any] | None = None
    _timer: bpy.types.Timer | None = None
    _scene_uid: int = 0
    _slice_end: float = 0.0
    _begun: float = 0.0

    @abstractmethod
    def start(self, scene: Scene) -> Generator[Any, None, Any]:
        """The job; it must leave the scene as it was."""

    @abstractmethod
    def finish(self, scene: Scene, result: Any) -> None:
        """Write the job's result into the scene."""

    def watch(self, progress: Progress) -> None:
        """Show a preview of the job's result; by default there is none."""

    def unwatch(self) -> None:
        """Remove the preview: everything is as before `watch`."""

    def run(self, context: Context) -> None:
        result = run_job(self.start(context.scene))
        keys_changed()  # a script may have set some meanwhile
        self.finish(context.scene, result)

    def invoke(self, context: Context, event: Event) -> set[str]:
        """Run the job in time slices, so that the user interface stays alive."""
        if bpy.app.background:  # there are no timer events
            return self.execute(context)
        with reported(self):
            self.begin(context)
            context.window_manager.modal_handler_add(self)
            return {"RUNNING_MODAL"}
        return {"CANCELLED"}

    def begin(self, context: Context) -> None:
        """Start the job and its timer, whose events Blender passes to `modal`."""
        self._job = self.start(context.scene)
        self._scene_uid = context.scene.session_uid
        context.window_manager.keymark_progress.frame = context.scene.frame_current_final
        self._timer = context.window_manager.event_timer_add(TIMER_S, window=context.window)
        self._slice_end = self._begun = monotonic()
        self._show(context, "Starting", 0.0)

    def modal(self, context: Context, event: Event) -> set[str]:
        """Run the job for one time slice, or cancel it."""
        if cancel_job(self, context, event):
            return {"CANCELLED"}
        if event.type != "TIMER" or self._job is None:
            return {"PASS_THROUGH"}
        with reported(self):
            drawing = monotonic() - self._slice_end
            until = monotonic() + min(max(drawing, SHORTEST_SLICE_S), LONGEST_SLICE_S)
            try:
                preview = None
                while True:
                    progress = next(self._job)
                    preview = progress if progress.preview is not None else preview
                    if monotonic() >= until:
                        break
                if preview is not None:
                    self.watch(preview)
                self._show(context, capitalized(progress.stage), progress.fraction)
                self._slice_end = monotonic()
            except StopIteration as stop:
                self.cancel(context)
                scene = next((one for one in bpy.data.scenes if one.session_uid == self._scene_uid), None)
                if scene is None:  # it may have been renamed
                    raise InputError(
                        "the scene of this job was removed while it ran; nothing was changed"
                    ) from None
                self.finish(scene, stop.value)
                return {"FINISHED"}
            except BaseException:
                self.cancel(context)
                raise
            return {"RUNNING_MODAL"}
        return {"CANCELLED"}

    def cancel(self, context: Context) -> None:
        """Close the job, and remove its preview, timer and progress bar; Blender calls this as well."""
        if self._job is not None:
            self._job.close()
            self._job = None
        self.unwatch()
        if self._timer is not None:
            context.window_manager.event_timer_remove(self._timer)
            self._timer = None
        if context.workspace is not None:
            context.workspace.status_text_set(None)
        redraw_sidebars(context)
        redraw_sidebars_soon()

    def _show(self, context: Context, stage: str, fraction: float) -> None:
        left = time_left(monotonic() - self._begun, fraction)
        context.window_manager.keymark_progress.show(stage, fraction, left)
        words = f"{stage}: {100.0 * fraction:.0f}%   |   "
        context.workspace.status_text_set(words + (f"{left}   |   " if left else "") + "Esc: Cancel")
        redraw_sidebars(context)
