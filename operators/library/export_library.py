"""Export a keyframe library: as .json, or as .blend of pose assets with its catalogs."""

from pathlib import Path

import bpy

from ...core.errors import InputError
from ..shell.base_operator import BaseOperator
from ..shell.error_reports import reported
from ..shell.messages import say
from ..shell.requirements import idle
from .editing.scene_libraries import library_here
from .library_choice import chosen_library

FORMATS = [
    ("JSON", "Library File (.json)", "One text file, for other people's Keymark and for version control"),
    ("BLEND", "Pose Assets (.blend)", "Pose assets for the asset browser, with their catalogs beside them"),
]
SUFFIXES = {"JSON": ".json", "BLEND": ".blend"}


class KEYMARK_OT_export_library(BaseOperator, bpy.types.Operator):
    """Write a keyframe library as a file, to share it"""

    bl_idname = "keymark.export_library"
    bl_label = "Export Library"
    bl_options = {"REGISTER"}
    requirements = (idle,)

    library: bpy.props.StringProperty(
        name="Library",
        description="Identifier of a library at hand; empty: the one that is made in this file",
        options={"SKIP_SAVE"},
    )
    format: bpy.props.EnumProperty(
        name="Format", description="Format of the file, where its name has neither suffix", items=FORMATS
    )
    only_selected: bpy.props.BoolProperty(
        name="Selected Postures Only",
        description="Write only postures that are marked in the list; motions keep the steps to these",
        options={"SKIP_SAVE"},
    )
    filepath: bpy.props.StringProperty(name="File", description="File to write", subtype="FILE_PATH")
    check_existing: bpy.props.BoolProperty(default=True, options={"HIDDEN"})
    filter_glob: bpy.props.StringProperty(default="*.json;*.blend", options={"HIDDEN"})

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask for the file, named as the library is."""
        with reported(self):
            library = chosen_library(context, self.library)
            folder = "//" if bpy.data.filepath else ""
            self.filepath = bpy.path.abspath(folder + library.identifier + SUFFIXES[self.format])
            context.window_manager.fileselect_add(self)
            return {"RUNNING_MODAL"}
        return {"CANCELLED"}

    def check(self, context: bpy.types.Context) -> bool:
        """Give the file's name the suffix of the format."""
        stem = self.filepath
        for suffix in SUFFIXES.values():
            stem = stem.removesuffix(suffix)
        path = bpy.path.ensure_ext(stem, SUFFIXES[self.format])
        changed = path != self.filepath
        self.filepath = path
        return changed

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the choices beside the file browser."""
        column = self.layout.column()
        column.prop(self, "format", expand=True)
        if not self.library:
            column.prop(self, "only_selected")

    def run(self, context: bpy.types.Context) -> None:
        """Write the file."""
        from ..bridge.library.library_file import with_postures, write_library_file

        if not self.filepath:
            raise InputError("no file is named to export to; give filepath")
        library = chosen_library(context, self.library)
        if self.only_selected and not self.library:
            postures = library_here(context.scene).postures
            library = with_postures(library, [entry.name for entry in postures if entry.selected])
        path = Path(bpy.path.abspath(self.filepath))
        if path.suffix.lower() not in SUFFIXES.values():  # a script's file tells its format itself
            path = path.with_name(path.name + SUFFIXES[self.format])
        write_library_file(path, library)
        count = len(library.postures)
        say(self, "INFO", "Wrote {count} postures to {path}", count=count, path=path)


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_export_library,))
