"""Keyframe libraries loaded, saved as files, edited as pose assets, and learned."""

from pathlib import Path

import bpy
from bpy.types import AnyType, Context, Event, Menu, Operator, PropertyGroup

from ...core.errors import InputError
from ...core.prior.learning import LibraryMetadata, learn_library
from ...core.prior.library import Library, library_digest, write_library
from ...core.prior.registry import identifier_of, registered_libraries
from ...core.prior.texts import identifier_from
from ..bridge.asset_catalogs import asset_root, catalog_file, ensure_catalog
from ..bridge.rig import shown_motion
from ..shell import need
from ..shell.base_operator import BaseOperator, browse, chosen_file, operator, warn_if_outdated
from ..shell.fields import HIDDEN, SKIP_SAVE, Choice, File, Integer, Switch, Text
from ..shell.takes import active_take, find_take, refresh_asset_browsers
from .registry import chosen_identifier, folders, load_registered, refresh, write_to_registry


class KEYMARK_OT_import_library(BaseOperator, bpy.types.Operator):
    """Load a keyframe library from a file, so that poses are found with it from now on"""

    bl_label = "Load Library"
    bl_options = {"REGISTER"}
    requirements = (need.idle,)

    filepath: File("A keyframe library: .json, or .blend with pose assets of one")
    replace: Switch("Replace", "Replace another library of the same identifier", options=SKIP_SAVE)
    filter_glob: Text(default="*.json;*.blend", options=HIDDEN)
    filter_folder: Switch(default=True, options=HIDDEN)

    def invoke(self, context: Context, event: Event) -> set[str]:
        return self.execute(context) if self.filepath else browse(self, context)

    def run(self, context: Context) -> None:
        """Read the whole file first, then write its libraries into the user's folder."""
        from ..bridge.library import read_libraries

        libraries = read_libraries(chosen_file(self, "a keyframe library, .json or .blend"))
        found = [entry.content for entry in registered_libraries(folders())]
        known = {library.identifier: library for library in found if library is not None}
        new = []
        for library in libraries:
            there = known.get(library.identifier)
            if there is None or library_digest(there) != library_digest(library):
                new.append(library)
                if there is not None and not self.replace:
                    raise InputError(
                        f"'{there.title}' ({there.identifier}) is there in version {there.version} by "
                        f"{there.author}, and this is version {library.version} by {library.author}; load it "
                        "with Replace, or give it another identifier"
                    )
        write_to_registry(new)
        refresh(libraries[0].identifier)  # the list points to it
        titles = ", ".join(f"'{library.title}'" for library in new)
        nothing = "Nothing to load: the library is at hand already"
        self.report({"INFO"}, f"Loaded {titles}" if new else nothing)


def _draw_import(menu: Menu, context: Context) -> None:
    menu.layout.operator(KEYMARK_OT_import_library.bl_idname, text="Keymark Keyframe Library (.json/.blend)")


@operator("Refresh Libraries", need.idle, undo=False)
def refresh_shelf(operator: Operator, context: Context, take: PropertyGroup) -> None:
    """Read the folder of your libraries again, after other programs have changed its files"""
    refresh()
    count = len(context.window_manager.keymark_shelf.libraries)
    operator.report({"INFO"}, f"{count} keyframe libraries are at hand")


class KEYMARK_OT_edit_library(BaseOperator, bpy.types.Operator):
    """Bring a library into this file as pose assets: to apply, to blend, to change, and to save again"""

    bl_label = "Edit as Pose Assets"
    requirements = (need.registered_library, need.idle)

    library: Text("Library", "Identifier of a library; empty: the one chosen in the list", options=SKIP_SAVE)

    def run(self, context: Context) -> None:
        """Add an Action for each posture; a saved file's catalogs are named beside it."""
        from ..bridge.library import add_assets, assets_by_library, catalog_of

        library = load_registered(self.library or chosen_identifier(context))
        if library.identifier in assets_by_library(bpy.data.actions):
            raise InputError(f"library '{library.title}' is in this file already")
        if bpy.data.filepath:
            file = catalog_file()
            for catalog in dict.fromkeys(catalog_of(library, posture) for posture in library.postures):
                ensure_catalog(file, catalog)
        count = len(add_assets(library))
        refresh_asset_browsers(context)
        self.report({"INFO"}, f"'{library.title}' is in this file now: {count} pose assets")


MENUS = {"TOPBAR_MT_file_import": _draw_import}


USUAL = (
    ("CC0-1.0", "Anything, without naming anybody"),
    ("CC-BY-4.0", "Anything, the author is named"),
    ("CC-BY-SA-4.0", "Anything under the same terms, the author is named"),
    ("CC-BY-NC-4.0", "Nothing commercial, the author is named"),
    ("LicenseRef-Proprietary", "Nothing without asking"),
)
"""SPDX identifiers, and what they allow."""


def suggest(_properties: AnyType, _context: Context, typed: str) -> list[tuple[str, str]]:
    """The common licenses that contain the typed text, each with what it allows; all if none does."""
    return [each for each in USUAL if typed.lower() in each[0].lower()] or list(USUAL)


class Licensed:
    """Mixin of operators that make a library: its license."""

    license: Text(
        "License",
        "Terms under which others may use it, an SPDX expression such as CC0-1.0 or CC-BY-4.0; "
        "by default none",
        default="LicenseRef-Proprietary",
        search=suggest,
        search_options={"SUGGESTION"},
    )


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


class KEYMARK_OT_export_library(Licensed, BaseOperator, bpy.types.Operator):
    """Save a keyframe library, pose assets or the take's keyframes as a library file, to keep or share it"""

    bl_label = "Save Library"
    bl_options = {"REGISTER"}
    requirements = (need.idle,)

    source: Choice("Postures", "Postures of the library", items=SOURCES, options=SKIP_SAVE)
    library: Text(
        "Library",
        "Identifier of a library at hand or of pose assets; empty: the one chosen in the list",
        options=SKIP_SAVE,
    )
    title: Text("Title", "Title of a new library; by default the take's name", options=SKIP_SAVE)
    author: Text("Author", "Author of a new library")
    format: Choice("Format", "Format of the file, where its name has neither suffix", items=FORMATS)
    filepath: Text("File", "File to write", subtype="FILE_PATH")
    check_existing: Switch(default=True, options=HIDDEN)
    filter_glob: Text(default="*.json;*.blend", options=HIDDEN)

    def invoke(self, context: Context, event: Event) -> set[str]:
        self.library = self.library or chosen_identifier(context)
        name = self.library if self.source == "LIBRARY" else identifier_from(self._title(context))
        folder = "//" if bpy.data.filepath else ""
        self.filepath = bpy.path.abspath(folder + (name or "library") + SUFFIXES[self.format])
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def check(self, context: Context) -> bool:
        stem = self.filepath
        for suffix in SUFFIXES.values():
            stem = stem.removesuffix(suffix)
        path = bpy.path.ensure_ext(stem, SUFFIXES[self.format])
        changed = path != self.filepath
        self.filepath = path
        return changed

    def draw(self, context: Context) -> None:
        column = self.layout.column()
        column.prop(self, "format", expand=True)
        column.prop(self, "source")
        if self.source != "LIBRARY":
            for name in ("title", "author", "license"):
                column.prop(self, name)

    def run(self, context: Context) -> None:
        from ..bridge.library import write_library_blend

        if not self.filepath:
            raise InputError("no file is named to save to; give filepath")
        library = self._library(context)
        path = Path(bpy.path.abspath(self.filepath))
        if path.suffix.lower() not in SUFFIXES.values():  # a script's file tells its format itself
            path = path.with_name(path.name + SUFFIXES[self.format])
        if path.suffix.lower() == SUFFIXES["BLEND"]:
            write_library_blend(path, library, asset_root(path.parent))
        else:
            write_library(path, library)
        self.report({"INFO"}, f"Wrote {len(library.postures)} postures to {path}")

    def _title(self, context: Context) -> str:
        take = find_take(context.scene)
        return self.title.strip() or (take.name if take is not None else "Postures")

    def _library(self, context: Context) -> Library:
        from ..bridge.library import library_of_assets, library_of_keyframes

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


class KEYMARK_OT_learn_library(Licensed, BaseOperator, bpy.types.Operator):
    """Make a keyframe library of the motion, so that the next take of its kind needs fewer keyframes"""

    bl_label = "Library from Motion"
    requirements = (need.actor, need.motion, need.idle)

    title: Text("Title", "Title of the library; by default the take's name")
    author: Text("Author", "Author of the library")
    count: Integer("Postures", "How many postures; 0 for 10 to 40, as many as differ", min=0, max=1000)
    learned_as: Text(
        "Learned As",
        "Identifier that the library was given, by which learning again replaces it",
        options={"HIDDEN", "SKIP_SAVE"},
    )

    def invoke(self, context: Context, event: Event) -> set[str]:
        take = active_take(context.scene)
        if not self.title:
            self.title = take.name
        if not self.author:
            self.author = take.finish.author
        return context.window_manager.invoke_props_dialog(self, width=360, confirm_text="Learn")

    def draw(self, context: Context) -> None:
        layout = self.layout
        layout.use_property_split, layout.use_property_decorate = True, False
        for name in ("title", "author", "license"):
            layout.prop(self, name)
        layout.prop(self, "count", text="Postures (0: Automatic)")

    def run(self, context: Context) -> None:
        """Learn the library, and write it into the user's folder."""
        from ..bridge.library import checked

        take = active_take(context.scene)
        title = self.title.strip() or take.name
        known = set(map(identifier_of, registered_libraries(folders())))
        identifier = self.learned_as or identifier_from(title, known)
        author, terms = self.author.strip() or "Unknown", self.license.strip()
        about = LibraryMetadata(title, author, terms, identifier)
        action = take.finish.action or take.motion_action
        shown = shown_motion(context.scene, take.armature, action)
        library = checked(learn_library(shown.body, shown.posture, shown.time_s, about, self.count or None))
        self.learned_as = library.identifier
        write_to_registry([library])
        refresh(library.identifier)
        warn_if_outdated(self, take)
        (learned,) = library.motions
        what = f"{len(library.postures)} postures over {learned.duration_s:.1f} s"
        self.report({"INFO"}, f"Learned '{title}': {what}")
