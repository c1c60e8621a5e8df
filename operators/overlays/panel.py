"""Panels of the overlays, in the 3D viewport and in the Movie Clip editor."""

import bpy

from ..shell.panel import TakePanel
from ..shell.takes import find_take
from . import registry

ROWS = (
    ("head",),
    *((f"{joint}.L", f"{joint}.R") for joint in ("shoulder", "elbow", "wrist", "hip", "knee", "ankle")),
)
"""Rows of the choice of points: the performer's left, and right."""


def _draw(layout: bpy.types.UILayout, settings: bpy.types.PropertyGroup) -> None:
    for name, sentence in registry.failures().items():
        layout.label(text="Switched off after an error:", icon="ERROR")
        layout.label(text=name)
        layout.label(text=sentence)
    column = layout.column(heading="Show")
    column.prop(settings, "show_observed")
    column.prop(settings, "show_predicted")
    column.prop(settings, "show_keypoints")
    column.prop(settings, "show_skeleton")
    column.prop(settings, "show_candidates")
    column.prop(settings, "show_floor_grid")
    column.prop(settings, "show_legend")
    column = layout.column()
    column.prop(settings, "opacity")
    column.prop(settings, "line_width")
    row = column.row()
    row.active = settings.show_skeleton
    row.prop(settings, "uncertain_beyond")


def _draw_paths(layout: bpy.types.UILayout, settings: bpy.types.PropertyGroup) -> None:
    layout.active = settings.show_paths
    column = layout.column(align=True)
    column.prop(settings, "path_before")
    column.prop(settings, "path_after")
    grid = layout.column(align=True)
    grid.use_property_split = False
    for row_of_points in ROWS:
        row = grid.row(align=True)
        for point in row_of_points:
            row.prop_enum(settings, "path_points", point)


class KEYMARK_PT_overlays(TakePanel, bpy.types.Panel):
    """Overlays of the viewport."""

    bl_label = "Overlays"
    bl_parent_id = "KEYMARK_PT_review"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the switches."""
        _draw(self.column(), context.scene.keymark.overlays)


class KEYMARK_PT_paths(TakePanel, bpy.types.Panel):
    """Paths: their points, and their lengths."""

    bl_label = "Paths"
    bl_parent_id = "KEYMARK_PT_overlays"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context: bpy.types.Context) -> None:
        """Draw the switch."""
        self.layout.prop(context.scene.keymark.overlays, "show_paths", text="")

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the choice of points and frames."""
        _draw_paths(self.column(), context.scene.keymark.overlays)


class ClipPanel:
    """Base of Keymark's panels in the Movie Clip editor."""

    bl_space_type = "CLIP_EDITOR"
    bl_region_type = "UI"
    bl_category = "Keymark"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """The editor shows a take's footage."""
        take = find_take(context.scene)
        return take is not None and take.clip is not None and take.clip == context.space_data.clip


class KEYMARK_PT_clip_overlays(ClipPanel, TakePanel, bpy.types.Panel):
    """Overlays of the footage."""

    bl_label = "Overlays"
    bl_parent_id = ""

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the switches."""
        _draw(self.column(), context.scene.keymark.overlays)


class KEYMARK_PT_clip_paths(ClipPanel, TakePanel, bpy.types.Panel):
    """Paths: their points, and their lengths."""

    bl_label = "Paths"
    bl_parent_id = "KEYMARK_PT_clip_overlays"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context: bpy.types.Context) -> None:
        """Draw the switch."""
        self.layout.prop(context.scene.keymark.overlays, "show_paths", text="")

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the choice of points and frames."""
        _draw_paths(self.column(), context.scene.keymark.overlays)


register, unregister = bpy.utils.register_classes_factory(
    (KEYMARK_PT_overlays, KEYMARK_PT_paths, KEYMARK_PT_clip_overlays, KEYMARK_PT_clip_paths)
)
