"""Esc in Keymark's modal operators: a running job, and an operator that waits for a click.

Both are ended by their own `cancel`, which Blender also calls when it closes a window or opens another file.
A job's generator is closed in the middle; only `JobOperator.finish` writes to the scene, so the scene is as
before the job, and Blender adds no undo step.
"""

from typing import Protocol

import bpy

CANCELS_JOB = frozenset({"ESC"})
CANCELS_CLICK = frozenset({"ESC", "RIGHTMOUSE"})
"""As in Blender's own operators that wait for a click."""


class Modal(Protocol):
    """A modal operator."""

    def report(self, kind: set[str], text: str) -> None:
        """Show a sentence in the status bar."""

    def cancel(self, context: bpy.types.Context) -> None:
        """Stop, and leave everything as it was."""


def cancel_job(operator: Modal, context: bpy.types.Context, event: bpy.types.Event) -> bool:
    """Cancel a job if the event is Esc, and report it; return whether it was cancelled."""
    if event.type not in CANCELS_JOB or event.value != "PRESS":
        return False
    operator.cancel(context)
    operator.report({"INFO"}, "Cancelled")
    return True


def cancel_click(operator: Modal, context: bpy.types.Context, event: bpy.types.Event) -> bool:
    """Cancel an operator that waits for a click on Esc or a right click; return whether it was cancelled."""
    if event.type not in CANCELS_CLICK or event.value != "PRESS":
        return False
    operator.cancel(context)
    return True
