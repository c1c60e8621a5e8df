"""The main panel: the running job, or the takes of the scene."""

import bpy

from .base import SidebarPanel, draw_progress


class KEYMARK_UL_takes(bpy.types.UIList):
    """Takes by name, with an icon that tells whether there is a motion yet."""

    def draw_item(
        self,
        context: bpy.types.Context,
        layout: bpy.types.UILayout,
        data: bpy.types.AnyType,
        item: bpy.types.PropertyGroup,
        icon: int,
        active_data: bpy.types.AnyType,
        active_property: str,
    ) -> None:
        """Draw one take."""
        done = item.motion_action is not None
        layout.prop(item, "name", text="", emboss=False, icon="ACTION" if done else "FILE_MOVIE")


class KEYMARK_PT_main(SidebarPanel, bpy.types.Panel):
    """What runs, and which takes there are."""

    bl_label = "Keymark"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the running job, or the takes."""
        layout, settings = self.layout, context.scene.keymark
        if draw_progress(layout, context):
            return
        if not len(settings.takes):
            layout.operator("keymark.load_footage", icon="FILE_MOVIE")
            layout.operator("keymark.open_take", icon="FILE_FOLDER")
            return
        if len(settings.takes) > 1:
            layout.template_list("KEYMARK_UL_takes", "", settings, "takes", settings, "active_take", rows=2)


register, unregister = bpy.utils.register_classes_factory((KEYMARK_UL_takes, KEYMARK_PT_main))
