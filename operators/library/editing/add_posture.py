"""Add the actor's pose to the library that is made in this file."""

import bpy

from ...shell.base_operator import BaseOperator
from ...shell.messages import say
from ...shell.redraw import refresh_asset_browsers
from ...shell.requirements import actor, idle, scene_library
from ...shell.takes import active_take
from .scene_libraries import library_here


class KEYMARK_OT_add_posture(BaseOperator, bpy.types.Operator):
    """Add the actor's pose at this frame to the library that is made in this file"""

    bl_idname = "keymark.add_posture"
    bl_label = "Add Posture"
    bl_options = {"REGISTER", "UNDO"}

    posture: bpy.props.StringProperty(
        name="Name", description="Name of the posture, such as Left Heel Strike", default="Posture"
    )
    tags: bpy.props.StringProperty(
        name="Tags", description="Words to find the posture by, with commas between them"
    )
    on_floor: bpy.props.BoolProperty(
        name="Stands on the Floor",
        description="Move the lower sole onto the floor; off: keep the height above z = 0, as in a jump",
        default=True,
    )
    replace: bpy.props.BoolProperty(
        name="Replace",
        description="Replace the chosen posture by the pose; name and tags stay",
        options={"SKIP_SAVE"},
    )

    requirements = (actor, scene_library, idle)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask for the name."""
        if self.replace:
            return self.execute(context)
        return context.window_manager.invoke_props_dialog(self, confirm_text="Add")

    def run(self, context: bpy.types.Context) -> None:
        """Read the pose, level it, and make it a pose asset."""
        from .library_edits import add_pose

        take, group = active_take(context.scene), library_here(context.scene)
        tags = tuple(tag.strip() for tag in self.tags.split(",") if tag.strip())
        name = None if self.replace else self.posture
        added = add_pose(group, take.armature, name, tags, on_floor=self.on_floor)
        refresh_asset_browsers(context)
        if added.beyond_m:
            say(
                self,
                "WARNING",
                "Added '{name}'; the pose goes {beyond:.0f} mm beyond what the skeleton can do, and its "
                "nearest posture is kept",
                name=added.name,
                beyond=1000.0 * added.beyond_m,
            )
        else:
            say(self, "INFO", "'{name}' is in the library '{title}'", name=added.name, title=group.name)


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_add_posture,))
