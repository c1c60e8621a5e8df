"""Keep the library that is made in this file among the user's own, so that footage is matched with it."""

import bpy

from ..shell.error_reports import reported
from ..shell.messages import say
from ..shell.requirements import all_met, idle, scene_library
from .conflict_dialog import WIDTH, draw_question
from .conflicts import CHOICES, Conflict, conflicts, keep_on_shelf, on_shelf, settled
from .library_choice import chosen_library


class KEYMARK_OT_keep_library(bpy.types.Operator):
    """Put the library among your own as it is now, so that footage can be matched with it"""

    bl_idname = "keymark.keep_library"
    bl_label = "Use for Matching"
    bl_options = {"REGISTER"}

    existing: bpy.props.EnumProperty(
        name="Existing",
        description="What to do where another library of the same identifier is at hand",
        items=CHOICES,
        options={"SKIP_SAVE"},
    )
    _found: list[Conflict] = []

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """There must be one."""
        return all_met(cls, context, scene_library, idle)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask where another one is at hand."""
        with reported(self):
            self._found = conflicts([chosen_library(context, "")], on_shelf)
            if not self._found:
                return self.execute(context)
            self.existing = "REPLACE"
            return context.window_manager.invoke_props_dialog(self, width=WIDTH, confirm_text="Continue")
        return {"CANCELLED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the question."""
        draw_question(self.layout, self, self._found)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Write it into the user's folder."""
        with reported(self):
            kept = settled([chosen_library(context, "")], on_shelf, self.existing)
            keep_on_shelf(kept)
            if kept:
                say(self, "INFO", "'{title}' is at hand for matching now", title=kept[0].title)
            else:
                say(self, "INFO", "The library is at hand already; nothing was changed")
            return {"FINISHED"}
        return {"CANCELLED"}


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_keep_library,))
