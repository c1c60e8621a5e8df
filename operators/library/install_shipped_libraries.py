"""Install the keyframe libraries that come with Keymark where the asset browser finds them."""

from typing import TYPE_CHECKING

import bpy

from .conflict_dialog import CHOICES
from .install_operator import InstallOperator, asset_library_items

if TYPE_CHECKING:
    from ...core.library.library import Library


class KEYMARK_OT_install_shipped_libraries(InstallOperator, bpy.types.Operator):
    """Install the libraries that come with Keymark as pose assets, so that the asset browser shows them"""

    bl_idname = "keymark.install_shipped_libraries"
    bl_label = "Install Shipped Libraries"

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
        """All that come with Keymark."""
        from .registry_files import shipped_libraries

        return shipped_libraries()

    def again(self) -> set[str]:
        """Call the operator anew, with the choices of the dialog."""
        return set(
            bpy.ops.keymark.install_shipped_libraries(
                "INVOKE_DEFAULT", asset_library=self.asset_library, existing=self.existing
            )
        )


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_install_shipped_libraries,))
