"""The markers in step 2, in the sidebars of the 3D viewport and of the Movie Clip editor."""

import bpy

from ..shell.follow_panel import ClipFollowPanel, FollowPanel, draw_readout, draw_switch
from ..shell.messages import label
from ..shell.panel import RowList, draw_progress, draw_sentence
from ..shell.takes import active_take
from .frame_markers import markers_label

LABEL_SHARE = 0.4
"""Share of the width that Blender gives to the labels of its two columns."""


class KEYMARK_UL_markers(RowList, bpy.types.UIList):
    """Markers with their colors and the number of sampled frames in which they are found."""

    def draw_row(
        self, context: bpy.types.Context, layout: bpy.types.UILayout, item: bpy.types.PropertyGroup
    ) -> None:
        """Draw one marker: color, name, status."""
        row = layout.row(align=True)
        swatch = row.row()
        swatch.ui_units_x = 1.6
        swatch.enabled = item.is_picked
        swatch.prop(item, "color", text="")
        row.prop(item, "name", text="", emboss=False)
        status = row.row()
        status.alignment = "RIGHT"
        if not item.is_picked:
            status.label(text="Not Picked", icon="EYEDROPPER")
        elif not item.has_readout(active_take(context.scene)):
            status.label(text="Not Checked", icon="QUESTION")
        else:
            status.label(text=f"{item.found}/{item.sampled}", icon="ERROR" if item.warning else "CHECKMARK")


class Markers:
    """Mixin of the panels: a switch in the header, how many are seen in this frame, and the list."""

    layout: bpy.types.UILayout

    def draw_header(self, context: bpy.types.Context) -> None:
        """Draw the switch."""
        draw_switch(self.layout, context, "use_markers")

    def draw_header_preset(self, context: bpy.types.Context) -> None:
        """Draw what is seen in this frame."""
        draw_readout(self.layout, markers_label(active_take(context.scene)))

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the list and the active marker."""
        self.layout.active = active_take(context.scene).follow.use_markers
        draw_markers(self.layout, context)


class KEYMARK_PT_markers(Markers, FollowPanel, bpy.types.Panel):
    """The list of markers, and the active one."""

    bl_label = "Markers"


class KEYMARK_PT_clip_markers(Markers, ClipFollowPanel, bpy.types.Panel):
    """The same in the Movie Clip editor."""

    bl_label = "Markers"


def draw_markers(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw the list, the active marker, and the operators of both."""
    take = active_take(context.scene)
    if not len(take.markers):
        layout.operator("keymark.add_usual_markers", icon="COMMUNITY")
        layout.operator("keymark.add_marker", icon="ADD")
        return
    row = layout.row()
    row.template_list("KEYMARK_UL_markers", "", take, "markers", take, "active_marker", rows=5)
    buttons = row.column(align=True)
    buttons.operator("keymark.add_marker", text="", icon="ADD")
    buttons.operator("keymark.remove_marker", text="", icon="REMOVE")
    buttons.separator()
    buttons.operator("keymark.pick_marker_color", text="", icon="EYEDROPPER").add = True
    if take.active_marker < len(take.markers):
        _draw_marker(layout, context, take, take.markers[take.active_marker])
    row = layout.row(align=True)
    if not draw_progress(row, context, "keymark.check_markers"):
        row.operator("keymark.check_markers", icon="VIEWZOOM")
    shown = context.window_manager.keymark_show_masks
    row.operator("keymark.show_masks", icon="HIDE_OFF" if shown else "HIDE_ON", depress=shown)


def _draw_marker(
    layout: bpy.types.UILayout,
    context: bpy.types.Context,
    take: bpy.types.PropertyGroup,
    marker: bpy.types.PropertyGroup,
) -> None:
    """Draw the active marker: the button that picks its color, its properties and its readout."""
    pick = layout.row()
    pick.scale_y = 1.3
    if not draw_progress(pick, context, "keymark.pick_marker_color"):
        pick.operator("keymark.pick_marker_color", text="Pick from Footage", icon="EYEDROPPER")
    column = layout.column()
    column.use_property_split = True
    column.use_property_decorate = False
    column.prop(marker, "segment")
    column.prop(marker, "color")
    if not marker.has_readout(take):
        return
    readout = layout.column(align=True)
    _row(
        readout, "Found In", label("{found} of {sampled} frames", found=marker.found, sampled=marker.sampled)
    )
    _row(readout, "Area", f"{marker.area:.0f} px ({100.0 * marker.area_share:.2f}%)")
    _row(readout, "Distinct", f"{100.0 * marker.distinctness:.0f}%")
    for sentence in marker.warning.splitlines():
        draw_sentence(layout, context, sentence, icon="ERROR")


def _row(layout: bpy.types.UILayout, name: str, value: str) -> None:
    """Draw a name and a value in the two columns of properties."""
    row = layout.split(factor=LABEL_SHARE)
    left = row.row()
    left.alignment = "RIGHT"
    left.label(text=name)
    row.label(text=value, translate=False)


register, unregister = bpy.utils.register_classes_factory(
    (KEYMARK_UL_markers, KEYMARK_PT_markers, KEYMARK_PT_clip_markers)
)
