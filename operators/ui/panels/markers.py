"""What the performer wears."""

import bpy

from ...takes import active_take
from .base import TakePanel


class KEYMARK_UL_markers(bpy.types.UIList):
    """Markers with their colors."""

    def draw_item(
        self,
        context: bpy.types.Context,
        layout: bpy.types.UILayout,
        data: bpy.types.AnyType,
        item: bpy.types.PropertyGroup,
        icon: int,
        active_data: bpy.types.AnyType,
        active_property: str,
    ) -> None:
        """Draw one marker: color and name."""
        row = layout.row(align=True)
        swatch = row.row()
        swatch.ui_units_x = 2.0
        swatch.prop(item, "color", text="")
        row.prop(item, "name", text="", emboss=False)


class KEYMARK_PT_markers(TakePanel, bpy.types.Panel):
    """The list of markers, and the active one."""

    bl_label = "Markers"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the list and the active marker."""
        take = active_take(context.scene)
        row = self.layout.row()
        row.template_list("KEYMARK_UL_markers", "", take, "markers", take, "active_marker", rows=5)
        buttons = row.column(align=True)
        buttons.operator("keymark.add_marker", text="", icon="ADD")
        buttons.operator("keymark.remove_marker", text="", icon="REMOVE")
        if take.active_marker < len(take.markers):
            marker = take.markers[take.active_marker]
            column = self.column()
            column.prop(marker, "segment")
            column.prop(marker, "color")
            column.operator("keymark.pick_marker_color", text="Pick from Footage", icon="EYEDROPPER")


register, unregister = bpy.utils.register_classes_factory((KEYMARK_UL_markers, KEYMARK_PT_markers))
