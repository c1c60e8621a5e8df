"""Publish the library that is made in this file to the registry, so that footage is matched with it."""

import bpy

from ..shell.base_operator import BaseOperator
from ..shell.error_reports import reported
from ..shell.messages import say
from ..shell.requirements import idle, scene_library
from .conflict_dialog import CHOICES, WIDTH, Conflict, draw_question
from .library_choice import chosen_library
from .publication import publish, registry_conflicts


class KEYMARK_OT_keep_library(BaseOperator, bpy.types.Operator):
    """Publish the library, as it is now, among your own, so that footage can be matched with it"""

    bl_idname = "keymark.keep_library"
    bl_label = "Use for Matching"
    bl_options = {"REGISTER"}
    requirements = (scene_library, idle)

    existing: bpy.props.EnumProperty(
        name="Existing",
        description="Action where another library of the same identifier is at hand",
        items=CHOICES,
        options={"SKIP_SAVE"},
    )
    _found: list[Conflict] = []

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask where another library of this identifier is registered."""
        with reported(self):
            self._found = registry_conflicts([chosen_library(context, "")])
            if not self._found:
                return self.execute(context)
            self.existing = "REPLACE"
            return context.window_manager.invoke_props_dialog(self, width=WIDTH, confirm_text="Continue")
        return {"CANCELLED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the question."""
        draw_question(self.layout, self, self._found)

    def run(self, context: bpy.types.Context) -> None:
        """Write the library into the user's folder."""
        published = publish([chosen_library(context, "")], self.existing)
        if published:
            say(self, "INFO", "'{title}' is at hand for matching now", title=published[0].title)
        else:
            say(self, "INFO", "The library is at hand already; nothing was changed")


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_keep_library,))
