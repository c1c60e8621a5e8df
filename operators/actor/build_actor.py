"""Build the performer's armature from a body height."""

import bpy

from ...core.body.actor import Actor
from ..shell.base_operator import BaseOperator
from ..shell.messages import say
from ..shell.requirements import bones_editable, idle
from ..shell.takes import ensure_take, find_take


class KEYMARK_OT_build_actor(BaseOperator, bpy.types.Operator):
    """Build an armature of the performer's height and stand it where the performer is in this frame"""

    bl_idname = "keymark.build_actor"
    bl_label = "Build Actor"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (bones_editable, idle)

    stature: bpy.props.FloatProperty(
        name="Height",
        description="The performer's body height",
        subtype="DISTANCE",
        precision=3,
        default=1.75,
        min=0.5,
        max=3.0,
    )
    place: bpy.props.BoolProperty(
        name="Stand in the Footage",
        description="Stand the actor where the markers say the performer is in the current frame, facing the "
        "camera; without markers, in the middle of the picture. An actor with keyframes stays where it is",
        default=True,
    )

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Take the height from the panel."""
        take = find_take(context.scene)
        if take is not None:
            self.stature = take.stature
        return self.execute(context)

    def run(self, context: bpy.types.Context) -> None:
        """Build or change it, stand it in the footage, and say what was done."""
        from ...core.body.kinematics import Body
        from ..bridge.pose import write_posture
        from .take_actor import is_posed, performers_place, size_actor

        body = Body(Actor.from_stature(self.stature))
        take = ensure_take(context.scene)
        had_one = size_actor(context, take, body)
        take.stature = self.stature
        if is_posed(take):
            say(
                self,
                "INFO",
                "The actor is {height:.2f} m tall now; its keyframes are kept",
                height=self.stature,
            )
            return {"FINISHED"}
        found = performers_place(context.scene, take, body) if self.place else None
        if found is not None:
            write_posture(take.armature, found[0])
        self._tell(had_one, found is not None, found is not None and found[1])

    def _tell(self, had_one: bool, placed: bool, by_markers: bool) -> None:
        if by_markers:
            say(self, "INFO", "The actor stands where the markers are in this frame")
        elif placed:
            say(
                self,
                "INFO",
                "The actor stands in the middle of the picture; with markers it would stand at the performer",
            )
        elif had_one:
            say(self, "INFO", "The actor is {height:.2f} m tall now", height=self.stature)
        else:
            say(self, "INFO", "The actor stands at the world's origin")


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_build_actor,))
