"""Load keyframe libraries: from a .json, or from a .blend of pose assets."""

import bpy
from bpy.types import Context, Event, Menu

from ...core.errors import InputError
from ..shell.base_operator import BaseOperator, browse, chosen_file, idle, registered_library
from ..shell.fields import HIDDEN, SKIP_SAVE, Switch, Text
from ..shell.takes import refresh_asset_browsers
from .registry import chosen_identifier, folders, refresh


class KEYMARK_OT_import_library(BaseOperator, bpy.types.Operator):
    """Load a keyframe library from a file, so that poses are found with it from now on"""

    bl_label = "Load Library"
    bl_options = {"REGISTER"}
    requirements = (idle,)

    filepath: Text(
        "File Path",
        "A keyframe library: .json, or .blend with pose assets of one",
        subtype="FILE_PATH",
        options=SKIP_SAVE,
    )
    replace: Switch(
        "Replace", "Replace another library of the same identifier that is at hand", options=SKIP_SAVE
    )
    filter_glob: Text(default="*.json;*.blend", options=HIDDEN)
    filter_folder: Switch(default=True, options=HIDDEN)

    def invoke(self, context: Context, event: Event) -> set[str]:
        return self.execute(context) if self.filepath else browse(self, context)

    def run(self, context: Context) -> None:
        """Read the whole file first, then write its libraries into the user's folder."""
        from ...core.prior.library import library_digest
        from ...core.prior.registry import registered_libraries
        from ..bridge.library import read_libraries
        from .registry_files import write_to_registry

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


class KEYMARK_OT_refresh_shelf(BaseOperator, bpy.types.Operator):
    """Read the folder of your libraries again, after other programs have changed its files"""

    bl_label = "Refresh Libraries"
    bl_options = {"REGISTER"}
    requirements = (idle,)

    def run(self, context: Context) -> None:
        refresh()
        count = len(context.window_manager.keymark_shelf.libraries)
        self.report({"INFO"}, f"{count} keyframe libraries are at hand")


class KEYMARK_OT_edit_library(BaseOperator, bpy.types.Operator):
    """Bring a library into this file as pose assets: to apply, to blend, to change, and to save again"""

    bl_label = "Edit as Pose Assets"
    requirements = (registered_library, idle)

    library: Text(
        "Library", "Identifier of a library at hand; empty: the one chosen in the list", options=SKIP_SAVE
    )

    def run(self, context: Context) -> None:
        """Add an Action for each posture; a saved file's catalogs are named beside it."""
        from ..bridge.asset_catalogs import catalog_file, ensure_catalog
        from ..bridge.library import add_assets, assets_by_library, catalog_of
        from .registry_files import load_registered

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
