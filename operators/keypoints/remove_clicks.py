"""Remove points that were clicked on in the current frame."""

import bpy

from ..shell.base_operator import BaseOperator
from ..shell.redraw import redraw_footage
from ..shell.requirements import footage, idle
from ..shell.takes import active_take
from .clicks import clicked_here, clip_frame, remove_click


class KEYMARK_OT_remove_clicks(BaseOperator, bpy.types.Operator):
    """Remove this point in this frame, or all points that were clicked on in this frame"""

    bl_idname = "keymark.remove_clicks"
    bl_label = "Remove Clicked Points"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (footage, idle)

    point: bpy.props.StringProperty(
        name="Body Point", description="The point to remove; empty for all", options={"SKIP_SAVE"}
    )

    def run(self, context: bpy.types.Context) -> set[str] | None:
        """Remove them; those of other frames stay."""
        take = active_take(context.scene)
        here = clip_frame(take)
        points = [self.point] if self.point else clicked_here(take)
        removed = [point for point in points if remove_click(take, point, here)]
        if not removed:
            self.report({"INFO"}, "Nothing was clicked on in this frame")
            return {"CANCELLED"}
        redraw_footage(context)
        return None


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_remove_clicks,))
