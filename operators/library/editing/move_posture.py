"""Move a posture in the order of the library that is made in this file."""

import bpy

from ...shell.base_operator import BaseOperator
from ...shell.requirements import idle, scene_library
from .scene_libraries import library_here


class KEYMARK_OT_move_posture(BaseOperator, bpy.types.Operator):
    """Move the chosen posture up or down in the library's order"""

    bl_idname = "keymark.move_posture"
    bl_label = "Move Posture"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (scene_library, idle)

    direction: bpy.props.EnumProperty(
        name="Direction",
        description="Direction of the move",
        items=[("UP", "Up", "Before the posture above"), ("DOWN", "Down", "Behind the posture below")],
    )

    def run(self, context: bpy.types.Context) -> set[str] | None:
        """Exchange two entries."""
        from .asset_updates import update_assets

        group = library_here(context.scene)
        before = group.active_posture
        after = before + (-1 if self.direction == "UP" else 1)
        if not (0 <= after < len(group.postures) and before < len(group.postures)):
            return {"CANCELLED"}
        group.postures.move(before, after)
        group.active_posture = after
        update_assets(group)
        return None


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_move_posture,))
