"""Operators of long jobs: synchronous in scripts, on a timer with a progress bar in the user interface."""

from abc import abstractmethod
from collections.abc import Generator
from time import monotonic
from typing import TYPE_CHECKING, Any

import bpy

from ...core.errors import InputError
from ...core.progress import run as run_job
from .base_operator import BaseOperator
from .error_reports import reported
from .messages import label, say
from .redraw import redraw_sidebars, redraw_sidebars_soon

if TYPE_CHECKING:
    from ...core.progress import Progress

SHORTEST_SLICE_S, LONGEST_SLICE_S = 0.05, 0.5
"""How long a job runs before the user interface is drawn again: as long as drawing took, between these."""
TIMER_S = 0.01
EARLIEST_S, LEAST_FRACTION = 1.5, 0.03
"""Before so much is done nobody can tell how long the rest takes."""


class JobOperator(BaseOperator):
    """Mixin of an operator whose work is a job that yields its progress.

    A subclass gives `start`, which changes nothing, and `finish`, which writes the result into the scene:
    so a job that is cancelled or fails leaves everything as it was.
    """

    _job: Generator[Any, None, Any] | None = None
    _timer: bpy.types.Timer | None = None
    _scene_uid: int = 0
    _slice_end: float = 0.0
    _begun: float = 0.0

    @abstractmethod
    def start(self, scene: bpy.types.Scene) -> Generator[Any, None, Any]:
        """The job; it must leave the scene as it was."""

    @abstractmethod
    def finish(self, scene: bpy.types.Scene, result: Any) -> None:
        """Write the job's result into the scene."""

    def watch(self, progress: "Progress") -> None:
        """Show what the job has found so far; by default nothing is shown."""

    def unwatch(self) -> None:
        """Leave everything as it was before `watch`."""

    def run(self, context: bpy.types.Context) -> None:
        """Do the whole job at once."""
        self.finish(context.scene, run_job(self.start(context.scene)))

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Do the job in slices, so that the user interface stays alive."""
        if bpy.app.background:  # there are no timer events
            return self.execute(context)
        with reported(self):
            self.begin(context)
            context.window_manager.modal_handler_add(self)
            return {"RUNNING_MODAL"}
        return {"CANCELLED"}

    def begin(self, context: bpy.types.Context) -> None:
        """Start the job and the timer that keeps it going; `modal` must be called from then on."""
        self._job = self.start(context.scene)
        self._scene_uid = context.scene.session_uid
        self._timer = context.window_manager.event_timer_add(TIMER_S, window=context.window)
        self._slice_end = self._begun = monotonic()
        self._show(context, "Starting", 0.0)

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Go on with the job, or stop it."""
        if event.type == "ESC" and event.value == "PRESS":
            self.cancel(context)
            say(self, "INFO", "Cancelled")
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
                self._show(context, progress.stage, progress.fraction)
                self._slice_end = monotonic()
            except StopIteration as stop:
                self.cancel(context)
                self.finish(self._scene(), stop.value)
                return {"FINISHED"}
            except BaseException:
                self.cancel(context)
                raise
            return {"RUNNING_MODAL"}
        return {"CANCELLED"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Stop the job and take its timer and its progress bar away; Blender calls this as well."""
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

    def _scene(self) -> bpy.types.Scene:
        """The scene that the job was started in, whatever it is called by now."""
        for scene in bpy.data.scenes:
            if scene.session_uid == self._scene_uid:
                return scene
        raise InputError("the scene that the job was about has been removed meanwhile; nothing was changed")

    def _show(self, context: bpy.types.Context, stage: str, fraction: float) -> None:
        left = time_left(monotonic() - self._begun, fraction)
        context.window_manager.keymark_progress.show(stage, fraction, left)
        words = f"{stage}: {100.0 * fraction:.0f}%   |   "
        context.workspace.status_text_set(words + (f"{left}   |   " if left else "") + "Esc: Cancel")
        redraw_sidebars(context)


def time_left(elapsed_s: float, fraction: float) -> str:
    """About how long a job will still take, in words; empty while nobody can tell.

    Args:
        elapsed_s: How long it has taken so far.
        fraction: How much of it is done.
    """
    if elapsed_s < EARLIEST_S or fraction < LEAST_FRACTION:
        return ""
    seconds = elapsed_s * (1.0 - fraction) / fraction
    if seconds >= 90.0:
        return label("about {minutes:.0f} min left", minutes=seconds / 60.0)
    # To what a person can tell apart, so that the words do not flicker.
    step = 10.0 if seconds > 30.0 else 5.0 if seconds > 10.0 else 1.0
    return label("about {seconds:.0f} s left", seconds=max(step * round(seconds / step), 1.0))
