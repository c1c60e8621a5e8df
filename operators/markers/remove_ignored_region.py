"""Let a region of the picture be searched for markers again."""

import bpy

from ..shell.base_operator import BaseOperator
from ..shell.redraw import redraw_footage
from ..shell.requirements import idle
from ..shell.takes import active_take
from .properties import clear_readouts
from .requirements import some_ignored


class KEYMARK_OT_remove_ignored_region(BaseOperator, bpy.types.Operator):
    """Search the chosen region of the picture for markers again"""

    bl_idname = "keymark.remove_ignored_region"
    bl_label = "Remove Region"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (some_ignored, idle)

    def run(self, context: bpy.types.Context) -> None:
        """Remove the region; the one before it becomes active."""
        take = active_take(context.scene)
        index = min(take.active_ignored, len(take.ignored_regions) - 1)
        take.ignored_regions.remove(index)
        take.active_ignored = max(0, index - 1)
        clear_readouts(take)
        redraw_footage(context)


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_remove_ignored_region,))
