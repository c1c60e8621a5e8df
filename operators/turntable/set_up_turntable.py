"""Set up the turntable."""

import bpy

from ..shell.base_operator import BaseOperator
from ..shell.requirements import actor, idle
from ..shell.takes import active_take
from .properties import show_chosen_reference


class KEYMARK_OT_set_up_turntable(BaseOperator, bpy.types.Operator):
    """Add cameras that see the actor from the front, from a side and all around, or replace them"""

    bl_idname = "keymark.set_up_turntable"
    bl_label = "Set Up Turntable"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (actor, idle)

    side: bpy.props.EnumProperty(
        name="Side",
        description="The side of the actor that the side view shows; left is the performer's own left",
        items=(
            ("LEFT", "Left", "Look at the performer's left side"),
            ("RIGHT", "Right", "Look at the performer's right side"),
        ),
    )
    follow: bpy.props.BoolProperty(
        name="Follow",
        description="Follow the actor's hips over the floor; otherwise the cameras stand still, like "
        "one that films a reference clip",
        default=True,
    )
    lens: bpy.props.FloatProperty(
        name="Focal Length",
        description="Focal length of the cameras, with a sensor 36 mm wide",
        subtype="DISTANCE_CAMERA",
        default=50.0,
        min=1.0,
        soft_min=18.0,
        soft_max=200.0,
    )

    def run(self, context: bpy.types.Context) -> None:
        """Survey where the actor moves, and only then change the scene."""
        from ..bridge.turntable import add_turntable, remove_turntable, survey

        scene, take = context.scene, active_take(context.scene)
        stage = survey(scene, take.armature, take.camera, self.follow)
        if take.turntable.collection is not None:
            remove_turntable(scene, take.turntable.collection)
        made = add_turntable(
            scene,
            take.armature,
            stage,
            f"{take.name} Turntable",
            side=self.side,
            follow=self.follow,
            lens_mm=self.lens,
        )
        views = take.turntable
        views.collection = made.collection
        views.front, views.side, views.turning = made.front, made.side, made.turning
        show_chosen_reference(views)


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_set_up_turntable,))
