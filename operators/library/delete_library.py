"""Delete one of the user's own libraries."""

from pathlib import Path

import bpy

from ...core.errors import ConversionError, InputError
from ..shell.error_reports import reported
from ..shell.messages import label, say
from ..shell.requirements import all_met, idle, registered_library
from .registry import chosen, fill


class KEYMARK_OT_discard_library(bpy.types.Operator):
    """Delete the chosen library's file from your libraries; this cannot be undone"""

    bl_idname = "keymark.discard_library"
    bl_label = "Delete Library"
    bl_options = {"REGISTER"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """One of the user's own must be chosen."""
        return all_met(cls, context, registered_library, _an_own_library, idle)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask."""
        item = chosen(context)
        message = label("'{title}' goes for good", title=item.title if item is not None else "")
        return context.window_manager.invoke_confirm(
            self, event, message=message, confirm_text="Delete", icon="WARNING"
        )

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Delete it."""
        with reported(self):
            item = chosen(context)
            if item is None:
                raise InputError("no library is chosen; choose the one to delete")
            title, path = item.title, Path(item.path)
            try:
                path.unlink(missing_ok=True)
            except OSError as error:
                raise ConversionError(f"{path}: cannot be deleted ({error.strerror or error})") from error
            fill()
            say(self, "INFO", "Deleted '{title}'", title=title)
            return {"FINISHED"}
        return {"CANCELLED"}


def _an_own_library(context: bpy.types.Context) -> str | None:
    item = chosen(context)
    own = item is not None and item.is_own
    return None if own else "This library comes with Keymark and stays"


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_discard_library,))
