"""Build the performer's armature from a body height."""

import bpy

from .failures import reported
from .requirements import all_met, idle, object_mode_possible
from .takes import ensure_take, find_take


class KEYMARK_OT_build_actor(bpy.types.Operator):
    """Add an armature of average proportions with the performer's height, standing at the world's origin"""

    bl_idname = "keymark.build_actor"
    bl_label = "Build Actor"
    bl_options = {"REGISTER", "UNDO"}

    stature: bpy.props.FloatProperty(
        name="Height",
        description="The performer's body height",
        subtype="DISTANCE",
        default=1.75,
        min=0.5,
        max=3.0,
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Blender adds objects in Object Mode."""
        return all_met(cls, context, object_mode_possible, idle)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Take the height from the panel."""
        take = find_take(context.scene)
        if take is not None:
            self.stature = take.stature
        return self.execute(context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Build it, select it, and make it the scene's actor."""
        with reported(self):
            from ..core.body.actor import Actor
            from ..core.body.kinematics import Body
            from .new_actor import add_actor

            body = Body(Actor.from_stature(self.stature))
            take = ensure_take(context.scene)
            add_actor(context, take, body)
            take.stature = self.stature
            return {"FINISHED"}
        return {"CANCELLED"}


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_build_actor,))
