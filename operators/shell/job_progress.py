"""The running job: whether there is one, its progress, and the time left."""

import bpy
from bpy.types import Context, Operator, WindowManager

from .fields import Group, Number, Text

OPERATOR_PREFIX = "KEYMARK_OT_"
TOOLS = ("KEYMARK_OT_drag_joints",)
"""Modal operators that wait for the mouse in a view, and let everything else go on meanwhile."""
EARLIEST_S, LEAST_FRACTION = 1.5, 0.03
"""Time and share done of a job before which the time left is not estimated."""


class KEYMARK_PG_progress(bpy.types.PropertyGroup):
    """Progress of the running job; in the window manager, so that no file keeps it."""

    stage: Text()
    fraction: Number(min=0.0, max=1.0)
    time_left: Text()
    frame: Number("Frame", "The scene frame at which the job was begun")

    def show(self, stage: str, fraction: float, time_left: str = "") -> None:
        self.stage = stage
        self.fraction = fraction
        self.time_left = time_left


ATTACHED = {"WindowManager.keymark_progress": Group(type=KEYMARK_PG_progress)}


def job_is_running(context: Context, job: str = "") -> bool:
    """Whether any of Keymark's jobs but `TOOLS`, or one named so, runs; open browsers are none."""
    wanted = job.replace("keymark.", OPERATOR_PREFIX) or OPERATOR_PREFIX
    return any(
        operator.bl_idname.startswith(wanted)
        and (job or operator.bl_idname not in TOOLS)
        and not is_browsing(operator, context.window_manager)
        for window in context.window_manager.windows
        for operator in window.modal_operators
    )


def steady_frame(context: Context) -> float:
    """The scene's frame; of a job's beginning while it runs, else panels would change under the mouse."""
    manager = context.window_manager
    begun = manager.keymark_progress.stage and job_is_running(context)
    return float(manager.keymark_progress.frame if begun else context.scene.frame_current_final)


def time_left(elapsed_s: float, fraction: float) -> str:
    """Estimated time a job still takes, as a label; empty while it is too early to tell."""
    if elapsed_s < EARLIEST_S or fraction < LEAST_FRACTION:
        return ""
    seconds = elapsed_s * (1.0 - fraction) / fraction
    if seconds >= 90.0:
        return f"about {seconds / 60.0:.0f} min left"
    # Rounded more coarsely the longer it is, so that the label does not flicker.
    step = 10.0 if seconds > 30.0 else 5.0 if seconds > 10.0 else 1.0
    return f"about {max(step * round(seconds / step), 1.0):.0f} s left"


def is_browsing(operator: Operator, manager: WindowManager) -> bool:
    """Whether a modal operator waits for its file browser alone, in whichever window that is."""
    areas = (area for window in manager.windows for area in window.screen.areas)
    asking = (area.spaces.active.active_operator for area in areas if area.type == "FILE_BROWSER")
    return any(each is not None and each.as_pointer() == operator.as_pointer() for each in asking)
