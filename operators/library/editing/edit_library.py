"""Bring a registered library into this file, to edit it."""

import bpy

from ....core.errors import InputError
from ...shell.base_operator import BaseOperator
from ...shell.messages import say
from ...shell.redraw import refresh_asset_browsers
from ...shell.requirements import idle, registered_library
from ..registry import chosen_entry


class KEYMARK_OT_edit_library(BaseOperator, bpy.types.Operator):
    """Bring a library into this file as pose assets: to apply, to blend, to change, and to share again"""

    bl_idname = "keymark.edit_library"
    bl_label = "Edit in This File"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (registered_library, idle)

    library: bpy.props.StringProperty(
        name="Library",
        description="Identifier of a library at hand; empty: the one chosen in the list",
        options={"SKIP_SAVE"},
    )

    def run(self, context: bpy.types.Context) -> None:
        """Add the library to the scene, its postures as pose assets."""
        from ..registry_files import load_registered
        from .library_to_scene import add_library

        item = chosen_entry(context)
        library = load_registered(self.library or (item.name if item is not None else ""))
        if any(group.identifier == library.identifier for group in context.scene.keymark.libraries):
            raise InputError(
                "library '{library}' is in this file already; remove it there first",
                library=library.title,
            )
        add_library(context.scene, library)
        refresh_asset_browsers(context)
        count = len(library.postures)
        say(
            self,
            "INFO",
            "'{title}' is in this file now: {count} pose assets",
            title=library.title,
            count=count,
        )


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_edit_library,))
