"""Look through the footage's camera or one of the turntable's."""

import bpy

from ...core.errors import InputError
from ..footage.camera_view import look_through, viewports
from ..shell.base_operator import BaseOperator
from ..shell.messages import tooltip
from ..shell.requirements import footage
from ..shell.takes import active_take


class KEYMARK_OT_show_view(BaseOperator, bpy.types.Operator):
    """Look through the footage's camera or another one in this viewport; split it to compare two views"""

    bl_idname = "keymark.show_view"
    bl_label = "Show View"
    bl_options = {"REGISTER"}
    requirements = (footage,)

    view: bpy.props.EnumProperty(
        name="View",
        description="The camera to look through",
        items=(
            ("FOOTAGE", "Footage", "Look through the camera that took the footage"),
            ("FRONT", "Front", "Look at the actor's face"),
            ("SIDE", "Side", "Look at one of the actor's sides"),
            ("TURNING", "Turntable", "Go round the actor while the frames play"),
        ),
    )

    @classmethod
    def description(cls, context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        """Return the tooltip of the button's view."""
        return tooltip(cls.bl_rna.properties["view"].enum_items[properties.view].description)

    def run(self, context: bpy.types.Context) -> None:
        """Set the context's viewport, or all of them if the context is another editor."""
        take = active_take(context.scene)
        camera = take.camera if self.view == "FOOTAGE" else getattr(take.turntable, self.view.lower())
        if camera is None or camera.name not in context.view_layer.objects:
            raise InputError(
                "take '{take}' has no camera for the view {view}; set up the turntable, or choose the "
                "footage's camera",
                take=take.name,
                view=self.view.title(),
            )
        own = context.space_data
        in_viewport = isinstance(own, bpy.types.SpaceView3D)
        for space in [own] if in_viewport else list(viewports(context.window_manager)):
            look_through(space, context.scene, camera)


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_show_view,))
