"""Bring a library into this file as pose assets."""

import bpy

from ...core.errors import InputError
from ..shell.base_operator import BaseOperator
from ..shell.redraw import refresh_asset_browsers
from ..shell.requirements import idle, registered_library
from .registry import chosen_identifier


class KEYMARK_OT_edit_library(BaseOperator, bpy.types.Operator):
    """Bring a library into this file as pose assets: to apply, to blend, to change, and to save again"""

    bl_idname = "keymark.edit_library"
    bl_label = "Edit as Pose Assets"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (registered_library, idle)

    library: bpy.props.StringProperty(
        name="Library",
        description="Identifier of a library at hand; empty: the one chosen in the list",
        options={"SKIP_SAVE"},
    )

    def run(self, context: bpy.types.Context) -> None:
        """Add an Action for each posture; a saved file's catalogs are named beside it."""
        from ..bridge.assets.catalogs import catalog_file, ensure_catalog
        from ..bridge.library.pose_assets import add_assets, assets_by_library, catalog_of
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


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_edit_library,))
