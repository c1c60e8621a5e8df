"""Remove all found keyframes that the animator has not decided on."""

import bpy

from ..shell.base_operator import BaseOperator
from ..shell.requirements import actor, idle, matches
from ..shell.takes import active_take
from .matches import undecided_matches


class KEYMARK_OT_remove_found(BaseOperator, bpy.types.Operator):
    """Remove every found keyframe that you have neither changed, accepted nor chosen the pose of"""

    bl_idname = "keymark.remove_found"
    bl_label = "Remove All Found"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (actor, matches, idle)

    def run(self, context: bpy.types.Context) -> set[str] | None:
        """Remove their keys and entries; what the animator has decided on stays."""
        from .found_result import clear_found

        scene, take = context.scene, active_take(context.scene)
        if not undecided_matches(take):
            self.report({"INFO"}, "All found keyframes are yours by now; nothing was removed")
            return {"CANCELLED"}
        count = clear_found(take)
        scene.frame_set(scene.frame_current, subframe=scene.frame_subframe)
        self.report({"INFO"}, f"Removed {count} found keyframes")
        return None


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_remove_found,))
