"""The popover of the overlays, of the viewport and of the Movie Clip editor."""

import bpy
from bpy.types import Context

from ..shell.panel import Popover
from .registry import FAILURES


class KEYMARK_PT_overlays(Popover, bpy.types.Panel):
    """Switches of what is drawn over the footage."""

    bl_label = "Overlays"

    def draw(self, context: Context) -> None:
        layout, settings = self.layout, context.scene.keymark.overlays
        for overlay, sentence in FAILURES.items():
            layout.label(text="Switched off after an error:", icon="ERROR")
            layout.label(text=overlay.name)
            layout.label(text=sentence)
        column = layout.column()
        column.prop(settings, "only_character")
        for each in settings.bl_rna.properties:
            if each.identifier.startswith("show_"):
                column.prop(settings, each.identifier)
        column.prop(settings, "opacity")
