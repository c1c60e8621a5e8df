"""Look at the actor as the footage does, or from another side."""

import bpy

from ...core.errors import InputError
from ..footage.camera_view import look_through, viewports
from ..shell.base_operator import BaseOperator
from ..shell.requirements import footage
from ..shell.takes import active_take


class KEYMARK_OT_show_view(BaseOperator, bpy.types.Operator):
    """Look through the footage's camera or another one, in this viewport alone: split it to compare two"""

    bl_idname = "keymark.show_view"
    bl_label = "Show View"
    bl_options = {"REGISTER"}
    requirements = (footage,)

    view: bpy.props.EnumProperty(
        name="View",
        description="Where to look from",
        items=(
            ("FOOTAGE", "Footage", "Look through the camera that took the footage"),
            ("FRONT", "Front", "Look at the actor's face"),
            ("SIDE", "Side", "Look at one of the actor's sides"),
            ("TURNING", "Turntable", "Go round the actor while the frames play"),
        ),
    )

    @classmethod
    def description(cls, context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        """The tooltip of the view a button stands for."""
        return cls.bl_rna.properties["view"].enum_items[properties.view].description

    def run(self, context: bpy.types.Context) -> None:
        """Turn the viewport that asks, or from elsewhere all of them."""
        take = active_take(context.scene)
        camera = take.camera if self.view == "FOOTAGE" else getattr(take.turntable, self.view.lower())
        if camera is None or camera.name not in context.view_layer.objects:
            raise InputError(
                f"take '{take.name}' has no camera for the view {self.view.title()}; "
                "set up the turntable, or choose the footage's camera"
            )
        own = context.space_data
        asked = isinstance(own, bpy.types.SpaceView3D)
        for space in [own] if asked else list(viewports(context.window_manager)):
            look_through(space, context.scene, camera)


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_show_view,))
