"""Panels of the overlays, in the 3D viewport and in the Movie Clip editor."""

import bpy

from ..shell.panel import TakePanel
from ..shell.takes import find_take
from . import registry

SWITCHES = (
    "observed",
    "predicted",
    "keypoints",
    "skeleton",
    "candidates",
    "paths",
    "floor_grid",
    "timeline",
    "legend",
)


def _draw(layout: bpy.types.UILayout, settings: bpy.types.PropertyGroup) -> None:
    for name, sentence in registry.failures().items():
        layout.label(text="Switched off after an error:", icon="ERROR")
        layout.label(text=name)
        layout.label(text=sentence)
    column = layout.column(heading="Show")
    for name in SWITCHES:
        column.prop(settings, f"show_{name}")
    layout.prop(settings, "opacity")


class KEYMARK_PT_overlays(TakePanel, bpy.types.Panel):
    """Overlays of the viewport."""

    bl_label = "Overlays"
    bl_parent_id = "KEYMARK_PT_review"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the switches."""
        _draw(self.column(), context.scene.keymark.overlays)


class KEYMARK_PT_clip_overlays(TakePanel, bpy.types.Panel):
    """Overlays of the footage in the Movie Clip editor."""

    bl_label = "Overlays"
    bl_space_type = "CLIP_EDITOR"
    bl_parent_id = ""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """The editor shows a take's footage."""
        take = find_take(context.scene)
        return take is not None and take.clip is not None and take.clip == context.space_data.clip

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the switches."""
        _draw(self.column(), context.scene.keymark.overlays)


register, unregister = bpy.utils.register_classes_factory((KEYMARK_PT_overlays, KEYMARK_PT_clip_overlays))
