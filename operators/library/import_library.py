"""Import keyframe libraries: from a .json, or from a .blend of pose assets."""

from typing import TYPE_CHECKING

import bpy

from ..shell.base_operator import BaseOperator
from ..shell.error_reports import reported
from ..shell.file_browser import browse, chosen_file
from ..shell.messages import label, say
from ..shell.requirements import idle
from .conflict_dialog import CHOICES, WIDTH, Conflict, draw_question
from .publication import publish, registry_conflicts
from .registry import refresh

if TYPE_CHECKING:
    from ...core.library.library import Library


class KEYMARK_OT_import_library(BaseOperator, bpy.types.Operator):
    """Import a keyframe library from a file, to match footage with it and to pose with it"""

    bl_idname = "keymark.import_library"
    bl_label = "Import Library"
    bl_options = {"REGISTER"}
    requirements = (idle,)

    filepath: bpy.props.StringProperty(
        name="File Path",
        description="A keyframe library: .json, or .blend with pose assets of one",
        subtype="FILE_PATH",
        options={"SKIP_SAVE"},
    )
    existing: bpy.props.EnumProperty(
        name="Existing",
        description="Action where another library of the same identifier is at hand",
        items=CHOICES,
        options={"SKIP_SAVE"},
    )
    filter_glob: bpy.props.StringProperty(default="*.json;*.blend", options={"HIDDEN"})
    filter_folder: bpy.props.BoolProperty(default=True, options={"HIDDEN"})

    _found: list[Conflict] = []

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask for the file, unless one was dropped; then what to do where its identifier is taken."""
        if not self.filepath:
            return browse(self, context)
        with reported(self):
            self._found = registry_conflicts(self._read())
            if not self._found:
                return self.execute(context)
            self.existing = "KEEP"
            return context.window_manager.invoke_props_dialog(self, width=WIDTH, confirm_text="Continue")
        return {"CANCELLED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the question."""
        if self._found:
            draw_question(self.layout, self, self._found)

    def run(self, context: bpy.types.Context) -> set[str] | None:
        """Read the whole file first, then write its libraries into the user's folder."""
        libraries = self._read()
        if self.existing == "ASK" and self.options.is_invoke and registry_conflicts(libraries):
            # The file was chosen in a file browser: ask now.
            return bpy.ops.keymark.import_library("INVOKE_DEFAULT", filepath=self.filepath)
        published = publish(libraries, self.existing)
        titles = ", ".join(f"'{library.title}'" for library in published)
        if published:
            say(self, "INFO", "Imported {titles}", titles=titles)
        else:
            refresh(libraries[0].identifier)  # the list points to it
            say(self, "INFO", "Nothing to import: the library is at hand already")
        return None

    def _read(self) -> "tuple[Library, ...]":
        from ..bridge.library.library_file import read_libraries

        return read_libraries(chosen_file(self, label("a keyframe library, .json or .blend")))


def _draw_import(menu: bpy.types.Menu, context: bpy.types.Context) -> None:
    menu.layout.operator(KEYMARK_OT_import_library.bl_idname, text="Keymark Keyframe Library (.json/.blend)")


def register() -> None:
    """Add the operator, and an entry to File > Import."""
    bpy.utils.register_class(KEYMARK_OT_import_library)
    bpy.types.TOPBAR_MT_file_import.append(_draw_import)


def unregister() -> None:
    """Remove both."""
    bpy.types.TOPBAR_MT_file_import.remove(_draw_import)
    bpy.utils.unregister_class(KEYMARK_OT_import_library)
