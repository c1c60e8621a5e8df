"""The popover of the overlays, of the viewport and of the Movie Clip editor."""

import bpy

from ..shell.panel import Popover
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


class KEYMARK_PT_overlays(Popover, bpy.types.Panel):
    """Switches of what is drawn over the footage."""

    bl_label = "Overlays"

    def draw(self, context: bpy.types.Context) -> None:
        layout, settings = self.layout, context.scene.keymark.overlays
        for name, sentence in registry.failures().items():
            layout.label(text="Switched off after an error:", icon="ERROR")
            layout.label(text=name)
            layout.label(text=sentence)
        column = layout.column()
        for name in SWITCHES:
            column.prop(settings, f"show_{name}")
        column.prop(settings, "opacity")
