"""Remove the turntable."""

import bpy

from ..footage.camera_view import look_through, viewports
from ..shell.base_operator import BaseOperator
from ..shell.requirements import idle, turntable
from ..shell.takes import active_take


class KEYMARK_OT_remove_turntable(BaseOperator, bpy.types.Operator):
    """Remove the front, side and turning views with their collection; a reference clip stays in the file"""

    bl_idname = "keymark.remove_turntable"
    bl_label = "Remove Turntable"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (turntable, idle)

    def run(self, context: bpy.types.Context) -> None:
        """Remove the views; viewports that looked through one of them show the footage again."""
        from ..bridge.turntable import remove_turntable

        scene, take = context.scene, active_take(context.scene)
        views = take.turntable
        removed = {views.front, views.side, views.turning} - {None}
        for space in viewports(context.window_manager):
            if space.camera in removed and take.camera is not None:
                look_through(space, scene, take.camera)
        if scene.camera in removed:
            scene.camera = take.camera
        remove_turntable(scene, views.collection)


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_remove_turntable,))
