"""Add the actor's pose to a keyframe library."""

import bpy

from ....core.body.human import HUMAN
from ...shell.error_reports import reported
from ...shell.messages import say
from ...shell.redraw import refresh_asset_browsers
from ...shell.requirements import actor, all_met, idle, scene_library
from ...shell.takes import active_take
from .scene_libraries import library_here


class KEYMARK_OT_add_posture(bpy.types.Operator):
    """Add the actor's pose, as it stands at this frame, to the library that is made in this file"""

    bl_idname = "keymark.add_posture"
    bl_label = "Add Posture"
    bl_options = {"REGISTER", "UNDO"}

    posture: bpy.props.StringProperty(
        name="Name", description="What the posture is called, such as Left Heel Strike", default="Posture"
    )
    tags: bpy.props.StringProperty(
        name="Tags", description="Words to find the posture by, with commas between them"
    )
    on_floor: bpy.props.BoolProperty(
        name="Stands on the Floor",
        description="Let the lower sole touch the floor; off: as high as it is above z = 0, as in a jump",
        default=True,
    )
    replace: bpy.props.BoolProperty(
        name="Replace",
        description="Put the pose in the place of the chosen posture, which keeps its name and tags",
        options={"SKIP_SAVE"},
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """There must be an actor and a library."""
        return all_met(cls, context, actor, scene_library, idle)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask for the name."""
        if self.replace:
            return self.execute(context)
        return context.window_manager.invoke_props_dialog(self, confirm_text="Add")

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Read the pose, level it, and make it a pose asset."""
        with reported(self):
            from ....core.body.posture import Posture
            from ...bridge.actor_lengths import read_body
            from ...bridge.keyframes import NOTICEABLE_M
            from ...bridge.pose import read_posture
            from .scene_postures import keep_postures, replace_posture

            take, group = active_take(context.scene), library_here(context.scene)
            body = read_body(take.armature, HUMAN)
            reading = read_posture(take.armature, body)
            postures = Posture.stack([reading.posture])
            if self.replace:
                name = replace_posture(group, body, postures, on_floor=self.on_floor).name
            else:
                tags = tuple(tag.strip() for tag in self.tags.split(",") if tag.strip())
                (name,) = keep_postures(group, body, postures, [self.posture], tags, on_floor=self.on_floor)
            refresh_asset_browsers(context)
            if reading.furthest_m > NOTICEABLE_M:
                say(
                    self,
                    "WARNING",
                    "Added '{name}'; the pose goes {beyond:.0f} mm beyond what the skeleton can do, and its "
                    "nearest posture is kept",
                    name=name,
                    beyond=1000.0 * reading.furthest_m,
                )
            else:
                say(self, "INFO", "'{name}' is in the library '{title}'", name=name, title=group.name)
            return {"FINISHED"}
        return {"CANCELLED"}


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_add_posture,))
