"""Import keyframe libraries: from a .json, or from a .blend of pose assets."""

from pathlib import Path
from typing import TYPE_CHECKING

import bpy

from ...core.errors import InputError
from ..shell.error_reports import reported
from ..shell.messages import say
from ..shell.requirements import all_met, idle
from .conflict_dialog import WIDTH, draw_question
from .conflicts import CHOICES, Conflict, conflicts, keep_on_shelf, on_shelf, settled
from .registry import fill

if TYPE_CHECKING:
    from ...core.library.library import Library


class KEYMARK_OT_import_library(bpy.types.Operator):
    """Import a keyframe library from a file, to match footage with it and to pose with it"""

    bl_idname = "keymark.import_library"
    bl_label = "Import Library"
    bl_options = {"REGISTER"}

    filepath: bpy.props.StringProperty(
        name="File Path",
        description="A keyframe library: .json, or .blend with pose assets of one",
        subtype="FILE_PATH",
        options={"SKIP_SAVE"},
    )
    existing: bpy.props.EnumProperty(
        name="Existing",
        description="What to do where another library of the same identifier is at hand",
        items=CHOICES,
        options={"SKIP_SAVE"},
    )
    filter_glob: bpy.props.StringProperty(default="*.json;*.blend", options={"HIDDEN"})
    filter_folder: bpy.props.BoolProperty(default=True, options={"HIDDEN"})

    _found: list[Conflict] = []

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Not while a job runs."""
        return all_met(cls, context, idle)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask for the file, unless one was dropped; then, where its library is there, what to do."""
        if not self.filepath:
            context.window_manager.fileselect_add(self)
            return {"RUNNING_MODAL"}
        with reported(self):
            self._found = conflicts(self._read(), on_shelf)
            if not self._found:
                return self.execute(context)
            self.existing = "KEEP"
            return context.window_manager.invoke_props_dialog(self, width=WIDTH, confirm_text="Continue")
        return {"CANCELLED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the question."""
        if self._found:
            draw_question(self.layout, self, self._found)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Read all of it first, then keep it in the user's folder."""
        with reported(self):
            libraries = self._read()
            if self.existing == "ASK" and self.options.is_invoke and conflicts(libraries, on_shelf):
                # The file was chosen in a file browser: ask now.
                return bpy.ops.keymark.import_library("INVOKE_DEFAULT", filepath=self.filepath)
            kept = settled(libraries, on_shelf, self.existing)
            keep_on_shelf(kept)
            titles = ", ".join(f"'{library.title}'" for library in kept)
            if kept:
                say(self, "INFO", "Imported {titles}", titles=titles)
            else:
                fill(libraries[0].identifier)  # the list points to it
                say(self, "INFO", "Nothing to import: the library is at hand already")
            return {"FINISHED"}
        return {"CANCELLED"}

    def _read(self) -> "tuple[Library, ...]":
        from ..bridge.library.library_file import read_libraries

        if not self.filepath:
            raise InputError("no file is named to import; give filepath")
        return read_libraries(Path(bpy.path.abspath(self.filepath)))


def _draw_import(menu: bpy.types.Menu, context: bpy.types.Context) -> None:
    menu.layout.operator(KEYMARK_OT_import_library.bl_idname, text="Keymark Keyframe Library (.json/.blend)")


def register() -> None:
    """Add the operator, and an entry to File > Import."""
    bpy.utils.register_class(KEYMARK_OT_import_library)
    bpy.types.TOPBAR_MT_file_import.append(_draw_import)


def unregister() -> None:
    """Take both away."""
    bpy.types.TOPBAR_MT_file_import.remove(_draw_import)
    bpy.utils.unregister_class(KEYMARK_OT_import_library)
