"""Delete a library from the user's folder."""

from pathlib import Path

import bpy

from ...core.errors import ConversionError, InputError
from ..shell.base_operator import BaseOperator
from ..shell.messages import label, say
from ..shell.requirements import idle, registered_library
from .registry import chosen_entry, refresh


def _an_own_library(context: bpy.types.Context) -> str | None:
    item = chosen_entry(context)
    own = item is not None and item.is_own
    return None if own else label("This library comes with Keymark and stays")


class KEYMARK_OT_discard_library(BaseOperator, bpy.types.Operator):
    """Delete the chosen library's file from your libraries; this cannot be undone"""

    bl_idname = "keymark.discard_library"
    bl_label = "Delete Library"
    bl_options = {"REGISTER"}
    requirements = (registered_library, _an_own_library, idle)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask for confirmation."""
        item = chosen_entry(context)
        message = label("'{title}' is deleted permanently", title=item.title if item is not None else "")
        return context.window_manager.invoke_confirm(
            self, event, message=message, confirm_text="Delete", icon="WARNING"
        )

    def run(self, context: bpy.types.Context) -> None:
        """Delete the file."""
        item = chosen_entry(context)
        if item is None:
            raise InputError("no library is chosen; choose the one to delete")
        title, path = item.title, Path(item.path)
        try:
            path.unlink(missing_ok=True)
        except OSError as error:
            raise ConversionError(
                "{path}: cannot be deleted ({strerror})", path=path, strerror=error.strerror or error
            ) from error
        refresh()
        say(self, "INFO", "Deleted '{title}'", title=title)


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_discard_library,))
