"""Show or hide what has the markers' colors."""

import bpy

from ...core.errors import InputError
from ..shell.base_operator import BaseOperator
from ..shell.error_reports import reported
from ..shell.redraw import redraw_footage
from ..shell.requirements import footage, idle, markers, picked_color
from ..shell.takes import active_take
from .mask_previews import look_at_frame, preview_of


class KEYMARK_OT_show_masks(BaseOperator, bpy.types.Operator):
    """Draw over the footage what has the markers' colors, in the camera view and the Movie Clip editor"""

    bl_idname = "keymark.show_masks"
    bl_label = "Show Masks"
    bl_options = {"REGISTER"}
    requirements = (footage, markers, picked_color, idle)

    def run(self, context: bpy.types.Context) -> None:
        """Switch over; colors that were not looked for in this session are looked for now."""
        manager = context.window_manager
        with reported(self):
            if not manager.keymark_show_masks:
                if preview_of(active_take(context.scene)) is None:
                    _look_for_markers()
                look_at_frame(context.scene)
            manager.keymark_show_masks = not manager.keymark_show_masks
            redraw_footage(context)
            return {"FINISHED"}
        return {"CANCELLED"}


def _look_for_markers() -> None:
    """Have them looked for, on a timer where there is one.

    Raises:
        InputError: They cannot be.
    """
    try:
        bpy.ops.keymark.check_markers("INVOKE_DEFAULT")
    except RuntimeError as error:
        raise InputError(str(error).removeprefix("Error: ").strip()) from error


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_show_masks,))
