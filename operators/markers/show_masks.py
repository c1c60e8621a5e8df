"""Show or hide the masks of the markers' colors."""

import bpy

from ...core.errors import InputError
from ..shell.base_operator import BaseOperator
from ..shell.redraw import redraw_footage
from ..shell.requirements import footage, idle, markers, picked_color
from ..shell.takes import active_take
from .mask_previews import preview_of, update_masks


class KEYMARK_OT_show_masks(BaseOperator, bpy.types.Operator):
    """Highlight the markers' colors over the footage, in the camera view and the Movie Clip editor"""

    bl_idname = "keymark.show_masks"
    bl_label = "Show Masks"
    bl_options = {"REGISTER"}
    requirements = (footage, markers, picked_color, idle)

    def run(self, context: bpy.types.Context) -> None:
        """Toggle the masks; markers that were not checked in this session are checked first."""
        manager = context.window_manager
        if not manager.keymark_show_masks:
            if preview_of(active_take(context.scene)) is None:
                _check_markers()
            update_masks(context.scene)
        manager.keymark_show_masks = not manager.keymark_show_masks
        redraw_footage(context)


def _check_markers() -> None:
    """Run the check of the markers, on a timer in the user interface.

    Raises:
        InputError: The markers cannot be checked.
    """
    try:
        bpy.ops.keymark.check_markers("INVOKE_DEFAULT")
    except RuntimeError as error:
        raise InputError(str(error).removeprefix("Error: ").strip()) from error


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_show_masks,))
