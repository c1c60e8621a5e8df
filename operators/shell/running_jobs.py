"""Which of Keymark's jobs run."""

import bpy

PREFIX = "KEYMARK_OT_"


def job_is_running(context: bpy.types.Context, job: str = "") -> bool:
    """Whether one of Keymark's jobs runs in any window, or that of one operator: `keymark.reconstruct`."""
    wanted = job.replace("keymark.", PREFIX) or PREFIX
    return any(
        operator.bl_idname.startswith(wanted)
        for window in context.window_manager.windows
        for operator in window.modal_operators
    )
