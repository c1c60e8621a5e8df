"""Remove a file of keypoints from a take."""

import bpy

from ..shell.base_operator import BaseOperator
from ..shell.redraw import redraw_footage
from ..shell.requirements import idle
from ..shell.takes import active_take
from .requirements import keypoint_files


class KEYMARK_OT_remove_keypoints(BaseOperator, bpy.types.Operator):
    """Remove the chosen keypoints from the take; their file stays on disk"""

    bl_idname = "keymark.remove_keypoints"
    bl_label = "Remove Keypoints"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (keypoint_files, idle)

    def run(self, context: bpy.types.Context) -> None:
        """Remove them; those before become the chosen ones."""
        follow = active_take(context.scene).follow
        index = min(follow.active_file, len(follow.files) - 1)
        follow.files.remove(index)
        follow.active_file = max(0, index - 1)
        redraw_footage(context)


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_remove_keypoints,))
