"""Install a keyframe library where the asset browser finds it."""

from typing import TYPE_CHECKING

import bpy

from .conflict_dialog import CHOICES
from .install_operator import InstallOperator, asset_library_items
from .library_choice import chosen_library

if TYPE_CHECKING:
    from ...core.library.library import Library


class KEYMARK_OT_install_library(InstallOperator, bpy.types.Operator):
    """Install the library as pose assets, so that the asset browser shows it in every file"""

    bl_idname = "keymark.install_library"
    bl_label = "Install as Pose Assets"

    library: bpy.props.StringProperty(
        name="Library",
        description="Identifier of a library at hand; empty: the one that is made in this file",
        options={"SKIP_SAVE"},
    )
    asset_library: bpy.props.EnumProperty(
        name="Asset Library", description="Asset library to install in", items=asset_library_items
    )
    existing: bpy.props.EnumProperty(
        name="Existing",
        description="Action where another library of the same identifier is installed",
        items=CHOICES,
        options={"SKIP_SAVE"},
    )

    def libraries(self, context: bpy.types.Context) -> "list[Library]":
        """The chosen library."""
        return [chosen_library(context, self.library)]

    def again(self) -> set[str]:
        """Call the operator anew, with the choices of the dialog."""
        return set(
            bpy.ops.keymark.install_library(
                "INVOKE_DEFAULT",
                library=self.library,
                asset_library=self.asset_library,
                existing=self.existing,
            )
        )


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_install_library,))
