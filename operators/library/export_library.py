"""Save a keyframe library: as .json, or as .blend of pose assets with its catalogs."""

from pathlib import Path
from typing import TYPE_CHECKING

import bpy

from ...core.errors import InputError
from ...core.library.texts import identifier_from
from ..shell.base_operator import BaseOperator
from ..shell.requirements import idle
from ..shell.takes import find_take
from .licenses import suggest
from .registry import chosen_identifier

if TYPE_CHECKING:
    from ...core.library.library import Library

FORMATS = [
    ("JSON", "Library File (.json)", "One text file, for other people's Keymark and for version control"),
    ("BLEND", "Pose Assets (.blend)", "Pose assets for the asset browser, with their catalogs beside them"),
]
SUFFIXES = {"JSON": ".json", "BLEND": ".blend"}
SOURCES = [
    ("LIBRARY", "Chosen Library", "The library as it is at hand"),
    ("ASSETS", "Pose Assets", "This file's pose assets of a library, and those that were made of the actor"),
    ("KEYFRAMES", "Keyframes", "The take's keyframes, a posture each, and a motion through them"),
]


class KEYMARK_OT_export_library(BaseOperator, bpy.types.Operator):
    """Save a keyframe library, pose assets or the take's keyframes as a library file, to keep or share it"""

    bl_idname = "keymark.export_library"
    bl_label = "Save Library"
    bl_options = {"REGISTER"}
    requirements = (idle,)

    source: bpy.props.EnumProperty(
        name="Postures", description="Postures of the library", items=SOURCES, options={"SKIP_SAVE"}
    )
    library: bpy.props.StringProperty(
        name="Library",
        description="Identifier of a library at hand or of pose assets; empty: the one chosen in the list",
        options={"SKIP_SAVE"},
    )
    title: bpy.props.StringProperty(
        name="Title",
        description="Title of a new library; by default the take's name",
        options={"SKIP_SAVE"},
    )
    author: bpy.props.StringProperty(name="Author", description="Author of a new library")
    license: bpy.props.StringProperty(
        name="License",
        description="Terms under which others may use it, an SPDX expression such as CC0-1.0 or CC-BY-4.0; "
        "by default none",
        default="LicenseRef-Proprietary",
        search=suggest,
        search_options={"SUGGESTION"},
    )
    format: bpy.props.EnumProperty(
        name="Format", description="Format of the file, where its name has neither suffix", items=FORMATS
    )
    filepath: bpy.props.StringProperty(name="File", description="File to write", subtype="FILE_PATH")
    check_existing: bpy.props.BoolProperty(default=True, options={"HIDDEN"})
    filter_glob: bpy.props.StringProperty(default="*.json;*.blend", options={"HIDDEN"})

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask for the file, named as the library is."""
        self.library = self.library or chosen_identifier(context)
        name = self.library if self.source == "LIBRARY" else identifier_from(self._title(context))
        folder = "//" if bpy.data.filepath else ""
        self.filepath = bpy.path.abspath(folder + (name or "library") + SUFFIXES[self.format])
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

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
        column.prop(self, "source")
        if self.source != "LIBRARY":
            for name in ("title", "author", "license"):
                column.prop(self, name)

    def run(self, context: bpy.types.Context) -> None:
        """Write the file."""
        from ..bridge.assets.catalogs import asset_root
        from ..bridge.library.library_file import write_library_file

        if not self.filepath:
            raise InputError("no file is named to save to; give filepath")
        library = self._library(context)
        path = Path(bpy.path.abspath(self.filepath))
        if path.suffix.lower() not in SUFFIXES.values():  # a script's file tells its format itself
            path = path.with_name(path.name + SUFFIXES[self.format])
        write_library_file(path, library, asset_root(path.parent))
        count = len(library.postures)
        self.report({"INFO"}, f"Wrote {count} postures to {path}")

    def _title(self, context: bpy.types.Context) -> str:
        take = find_take(context.scene)
        return self.title.strip() or (take.name if take is not None else "Postures")

    def _library(self, context: bpy.types.Context) -> "Library":
        """The library to write.

        Raises:
            InputError: There is none, or it is not complete.
        """
        from ...core.library.learning import LibraryMetadata
        from ..bridge.library.posed_library import library_of_assets, library_of_keyframes
        from .registry_files import load_registered

        wanted = self.library or chosen_identifier(context)
        if self.source == "LIBRARY":
            return load_registered(wanted)
        about = LibraryMetadata(self._title(context), self.author.strip() or "Unknown", self.license.strip())
        take = find_take(context.scene)
        armature = take.armature if take is not None else None
        if self.source == "ASSETS":
            return library_of_assets(bpy.data.actions, armature, about, wanted)
        if take is None or armature is None or take.keyframe_action is None:
            raise InputError("the take has no keyframes; pose the actor and store some first")
        return library_of_keyframes(context.scene, armature, take.keyframe_action, about)


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_export_library,))
