"""Pick the active marker's colour from the footage."""

import bpy

from .failures import reported
from .marker_styles import set_marker_color
from .requirements import all_met, footage, idle, markers
from .takes import active_take, footage_of


class KEYMARK_OT_pick_marker_color(bpy.types.Operator):
    """Click on the marker in the footage to take its color from there"""

    bl_idname = "keymark.pick_marker_color"
    bl_label = "Pick Marker Color"
    bl_options = {"REGISTER", "UNDO"}

    pixel: bpy.props.FloatVectorProperty(
        name="Pixel",
        description="Where to pick, in pixels of the footage from its top left corner",
        size=2,
        options={"SKIP_SAVE"},
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """There must be footage, and a marker to give the color to."""
        return all_met(cls, context, footage, markers, idle)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Wait for a click on the footage."""
        from .ui.footage_view import shows_footage

        if not shows_footage(context, active_take(context.scene)):
            self.report(
                {"ERROR"},
                "Look through the take's camera first (Numpad 0), or open the clip in a Movie Clip editor",
            )
            return {"CANCELLED"}
        context.window.cursor_modal_set("EYEDROPPER")
        context.workspace.status_text_set("Click on the marker in the footage   |   Esc: Cancel")
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Pick at the click, or stop."""
        if event.type in {"ESC", "RIGHTMOUSE"} and event.value == "PRESS":
            self.cancel(context)
            return {"CANCELLED"}
        if event.type == "LEFTMOUSE" and event.value == "PRESS":
            from .ui.footage_view import pixel_under

            pixel = pixel_under(context, active_take(context.scene), event.mouse_x, event.mouse_y)
            self.cancel(context)
            if pixel is None:
                self.report({"ERROR"}, "That is not on the footage; click on a marker in it")
                return {"CANCELLED"}
            self.pixel = pixel
            return self.execute(context)
        return {"RUNNING_MODAL"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Give the cursor back; Blender calls this as well."""
        context.window.cursor_modal_restore()
        context.workspace.status_text_set(None)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Read the pixel from the footage's file, free of the viewport's colors."""
        with reported(self):
            from .bridge.footage_color import footage_color

            take = active_take(context.scene)
            color = footage_color(footage_of(context.scene, take), self.pixel)
            marker = take.markers[min(take.active_marker, len(take.markers) - 1)]
            set_marker_color(marker, color)
            self.report({"INFO"}, f"Marker {marker.name} has the color {color}")
            return {"FINISHED"}
        return {"CANCELLED"}


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_pick_marker_color,))
