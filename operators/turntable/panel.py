"""The panel of the turntable: views from other sides, and a reference clip."""

import bpy

from ..shell.panel import TakePanel
from ..shell.takes import active_take

VIEWS = (("FOOTAGE", "Footage"), ("FRONT", "Front"), ("SIDE", "Side"), ("TURNING", "Turntable"))


class KEYMARK_PT_turntable(TakePanel, bpy.types.Panel):
    """Views of the actor from other sides."""

    bl_label = "Turntable"
    bl_parent_id = "KEYMARK_PT_review"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the views' buttons, and the reference clip."""
        views, column = active_take(context.scene).turntable, self.column()
        if views.collection is None:
            column.operator("keymark.set_up_turntable", icon="OUTLINER_OB_CAMERA")
            return
        _draw_views(column, context)
        column.separator()
        column.label(text="Reference Clip")
        column.template_ID(views, "reference", open="clip.open")
        choice = column.column()
        choice.active = views.reference is not None
        choice.prop(views, "reference_view")
        choice.prop(views, "reference_offset")
        _draw_background(choice, views)
        column.separator()
        column.operator("keymark.remove_turntable", icon="X")


def _draw_background(layout: bpy.types.UILayout, views: bpy.types.PropertyGroup) -> None:
    """Draw opacity, offset and scale of the reference, which another camera filmed than the view's."""
    camera = {"FRONT": views.front, "SIDE": views.side, "TURNING": views.turning}[views.reference_view]
    if camera is not None and camera.data.background_images:
        background = camera.data.background_images[0]
        layout.prop(background, "alpha", text="Opacity", slider=True)
        layout.prop(background, "offset", text="Move")
        layout.prop(background, "scale")


def _draw_views(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw a button for each view; the one of this viewport's view is pressed."""
    take, space = active_take(context.scene), context.space_data
    cameras = {
        "FOOTAGE": take.camera,
        "FRONT": take.turntable.front,
        "SIDE": take.turntable.side,
        "TURNING": take.turntable.turning,
    }
    through_camera = space.region_3d is not None and space.region_3d.view_perspective == "CAMERA"
    shown = space.camera if space.use_local_camera else context.scene.camera
    grid = layout.grid_flow(row_major=True, columns=2, even_columns=True, align=True)
    for view, title in VIEWS:
        pressed = through_camera and shown is not None and shown == cameras[view]
        grid.operator("keymark.show_view", text=title, depress=pressed).view = view


register, unregister = bpy.utils.register_classes_factory((KEYMARK_PT_turntable,))
