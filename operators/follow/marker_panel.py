"""The settings of markers: their list, the chosen one, and what is never a marker."""

import bpy

from ..shell.panel import RowList, draw_progress, draw_sentence, is_roomy, property_column, side_by_side
from ..shell.takes import active_take


class KEYMARK_UL_markers(RowList, bpy.types.UIList):
    """Markers with their colors and the number of sampled frames in which they are found."""

    def draw_row(
        self, context: bpy.types.Context, layout: bpy.types.UILayout, item: bpy.types.PropertyGroup
    ) -> None:
        row = layout.row(align=True)
        swatch = row.row()
        roomy = is_roomy(context)
        swatch.ui_units_x = 1.6 if roomy else 0.8  # a narrow sidebar is left to the names
        swatch.enabled = item.is_picked
        swatch.prop(item, "color", text="")
        row.prop(item, "name", text="", emboss=False)
        status = row.row()
        status.alignment = "RIGHT"
        take = active_take(context.scene)
        if item.warning and not roomy:
            status.label(text="", icon="ERROR")
        elif item.is_picked and roomy and not item.has_readout(take):
            status.label(text="", icon="QUESTION")
        elif item.is_picked and roomy:
            status.label(text=f"{item.found}/{item.sampled}", icon="ERROR" if item.warning else "CHECKMARK")
        here = next((index for index, marker in enumerate(take.markers) if marker == item), -1)
        pick = row.row()
        pick.emboss = "NONE" if item.is_picked else "NORMAL"
        pick.operator("keymark.pick_marker_color", text="", icon="EYEDROPPER").row = here


class KEYMARK_UL_ignored_regions(RowList, bpy.types.UIList):
    """Regions of the picture that are never a marker, each with its frames."""

    def draw_row(
        self, context: bpy.types.Context, layout: bpy.types.UILayout, item: bpy.types.PropertyGroup
    ) -> None:
        row = layout.row(align=True)
        row.prop(item, "name", text="", emboss=False, icon="BRUSH_DATA" if len(item.stroke) else "MESH_PLANE")
        status = row.row()
        status.alignment = "RIGHT"
        text = f"{item.first_frame} - {item.last_frame}" if item.some_frames else "All Frames"
        status.label(text=text, translate=False)


def draw_markers(
    layout: bpy.types.UILayout, context: bpy.types.Context, take: bpy.types.PropertyGroup
) -> None:
    """Draw the list, the active marker, and the operators of both."""
    if not len(take.markers):
        _draw_pick(layout, context, "Pick Markers")
        layout.operator("keymark.add_usual_markers", icon="COMMUNITY")
        layout.operator("keymark.add_marker", icon="ADD")
        return
    picked = all(marker.is_picked for marker in take.markers)
    _draw_pick(layout, context, "Pick All Anew" if picked else "Pick Markers")
    row = layout.row()
    row.template_list("KEYMARK_UL_markers", "", take, "markers", take, "active_marker", rows=5)
    buttons = row.column(align=True)
    buttons.operator("keymark.add_marker", text="", icon="ADD")
    buttons.operator("keymark.remove_marker", text="", icon="REMOVE")
    if take.active_marker < len(take.markers):
        _draw_marker(layout, context, take, take.markers[take.active_marker])
    _draw_ignored(layout, context, take)
    row = side_by_side(layout)
    if not draw_progress(row, context, "keymark.check_markers"):
        row.operator("keymark.check_markers", icon="VIEWZOOM")
    shown = context.window_manager.keymark_show_masks
    row.operator("keymark.show_masks", icon="HIDE_OFF" if shown else "HIDE_ON", depress=shown)


def _draw_pick(layout: bpy.types.UILayout, context: bpy.types.Context, text: str) -> None:
    """Draw the button that asks for all markers, or its progress."""
    pick = layout.row()
    pick.scale_y = 1.3
    jobs = ("keymark.pick_markers", "keymark.pick_marker_color")
    if not any(draw_progress(pick, context, job) for job in jobs):
        pick.operator("keymark.pick_markers", text=text, translate=False, icon="EYEDROPPER")


def _draw_ignored(
    layout: bpy.types.UILayout, context: bpy.types.Context, take: bpy.types.PropertyGroup
) -> None:
    """Draw what is never a marker: the brush, the list of regions, and the frames of the chosen one."""
    jobs = ("keymark.ignore_region", "keymark.ignore_still_areas")
    if not any(draw_progress(layout, context, job) for job in jobs):
        row = layout.row(align=True)
        row.operator("keymark.ignore_region", icon="BRUSH_DATA")
        if any(marker.has_readout(take) and len(marker.still_areas) for marker in take.markers):
            row.operator("keymark.ignore_still_areas")
    if not len(take.ignored_regions):
        return
    row = layout.row()
    source = (take, "ignored_regions", take, "active_ignored")
    row.template_list("KEYMARK_UL_ignored_regions", "", *source, rows=2, maxrows=5)
    row.column(align=True).operator("keymark.remove_ignored_region", text="", icon="REMOVE")
    if take.active_ignored < len(take.ignored_regions):
        region, column = take.ignored_regions[take.active_ignored], property_column(layout.column())
        column.prop(region, "some_frames")
        if region.some_frames:
            frames = column.column(align=True)
            frames.prop(region, "first_frame")
            frames.prop(region, "last_frame")


def _draw_marker(
    layout: bpy.types.UILayout,
    context: bpy.types.Context,
    take: bpy.types.PropertyGroup,
    marker: bpy.types.PropertyGroup,
) -> None:
    """Draw the active marker: its properties and its readout."""
    column = property_column(layout.column())
    column.prop(marker, "segment")
    if not marker.has_readout(take):
        return
    readout = layout.column(align=True)
    _row(readout, "Found In", f"{marker.found} of {marker.sampled} frames")
    _row(readout, "Area", f"{marker.area:.0f} px ({100.0 * marker.area_share:.2f}%)")
    _row(readout, "Distinct", f"{100.0 * marker.distinctness:.0f}%")
    for sentence in marker.warning.splitlines():
        draw_sentence(layout, context, sentence, icon="ERROR")


def _row(layout: bpy.types.UILayout, name: str, value: str) -> None:
    """Draw a name and a value in the two columns of properties."""
    row = layout.split(factor=0.4)
    left = row.row()
    left.alignment = "RIGHT"
    left.label(text=name)
    row.label(text=value, translate=False)
