"""Load keyframe libraries: from a .json, or from a .blend of pose assets."""

from typing import TYPE_CHECKING

import bpy

from ...core.errors import InputError
from ..shell.base_operator import BaseOperator
from ..shell.file_browser import browse, chosen_file
from ..shell.requirements import idle
from .registry import refresh

if TYPE_CHECKING:
    from ...core.library.library import Library


class KEYMARK_OT_import_library(BaseOperator, bpy.types.Operator):
    """Load a keyframe library from a file, so that poses are found with it from now on"""

    bl_idname = "keymark.import_library"
    bl_label = "Load Library"
    bl_options = {"REGISTER"}
    requirements = (idle,)

    filepath: bpy.props.StringProperty(
        name="File Path",
        description="A keyframe library: .json, or .blend with pose assets of one",
        subtype="FILE_PATH",
        options={"SKIP_SAVE"},
    )
    replace: bpy.props.BoolProperty(
        name="Replace",
        description="Replace another library of the same identifier that is at hand",
        options={"SKIP_SAVE"},
    )
    filter_glob: bpy.props.StringProperty(default="*.json;*.blend", options={"HIDDEN"})
    filter_folder: bpy.props.BoolProperty(default=True, options={"HIDDEN"})

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask for the file, unless one was dropped."""
        return self.execute(context) if self.filepath else browse(self, context)

    def run(self, context: bpy.types.Context) -> None:
        """Read the whole file first, then write its libraries into the user's folder."""
        from ...core.library.library_file import library_digest
        from ..bridge.library.library_file import read_libraries
        from .registry_files import find_registered, write_to_registry

        libraries = read_libraries(chosen_file(self, "a keyframe library, .json or .blend"))
        new = []
        for library in libraries:
            there = find_registered(library.identifier)
            if there is None or library_digest(there) != library_digest(library):
                new.append(library)
                if there is not None and not self.replace:
                    raise InputError(_conflict(library, there))
        write_to_registry(new)
        refresh(libraries[0].identifier)  # the list points to it
        titles = ", ".join(f"'{library.title}'" for library in new)
        if new:
            self.report({"INFO"}, f"Loaded {titles}")
        else:
            self.report({"INFO"}, "Nothing to load: the library is at hand already")


def _conflict(new: "Library", there: "Library") -> str:
    return (
        f"'{there.title}' ({there.identifier}) is there in version {there.version} by {there.author}, "
        f"and this is version {new.version} by {new.author}; load it with Replace, or give it another "
        "identifier"
    )


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
