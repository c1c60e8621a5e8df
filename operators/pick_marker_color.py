"""Pick the active marker's colour from the footage."""

import bpy
import numpy as np
from bpy_extras.view3d_utils import location_3d_to_region_2d

from .failures import reported
from .marker_styles import set_marker_color
from .requirements import all_met, footage, idle, markers


class KEYMARK_OT_pick_marker_color(bpy.types.Operator):
    """Click on the marker in the footage, seen through the camera, to take its color from there"""

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
        """Wait for a click in a viewport that looks through the camera."""
        if not any(_looks_through_camera(area) for area in context.screen.areas):
            self.report(
                {"ERROR"}, "Look through the camera first (Numpad 0), so that the footage can be seen"
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
            pixel = _pixel_under(context, event.mouse_x, event.mouse_y)
            self.cancel(context)
            if pixel is None:
                self.report(
                    {"ERROR"}, "That is not on the footage; look through the camera and click on a marker"
                )
                return {"CANCELLED"}
            with reported(self):
                from .bridge.footage_color import footage_pixel

                self.pixel = footage_pixel(context.scene, pixel)
                return self.execute(context)
            return {"CANCELLED"}
        return {"RUNNING_MODAL"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Give the cursor back; Blender calls this as well."""
        context.window.cursor_modal_restore()
        context.workspace.status_text_set(None)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Read the pixel from the footage's file, free of the viewport's colors."""
        with reported(self):
            from .bridge.footage_color import footage_color

            settings = context.scene.keymark
            color = footage_color(context.scene, self.pixel)
            marker = settings.markers[min(settings.active_marker, len(settings.markers) - 1)]
            set_marker_color(marker, color)
            self.report({"INFO"}, f"Marker {marker.name} has the color {color}")
            return {"FINISHED"}
        return {"CANCELLED"}


def _looks_through_camera(area: bpy.types.Area) -> bool:
    return area.type == "VIEW_3D" and area.spaces.active.region_3d.view_perspective == "CAMERA"


def _pixel_under(context: bpy.types.Context, mouse_x: int, mouse_y: int) -> tuple[float, float] | None:
    """The footage's pixel under a place in the window, or None where there is none."""
    for area in context.screen.areas:
        inside = area.x <= mouse_x < area.x + area.width and area.y <= mouse_y < area.y + area.height
        if not (inside and _looks_through_camera(area)):
            continue
        region = next(region for region in area.regions if region.type == "WINDOW")
        share = _frame_share(context.scene, region, area.spaces.active.region_3d, mouse_x, mouse_y)
        if share is not None and 0.0 <= min(share) and max(share) < 1.0:
            width, height = context.scene.active_clip.size
            return share[0] * width, share[1] * height
    return None


def _frame_share(
    scene: bpy.types.Scene,
    region: bpy.types.Region,
    view: bpy.types.RegionView3D,
    mouse_x: int,
    mouse_y: int,
) -> tuple[float, float] | None:
    """Shares of the camera frame's width from the left and height from the top."""
    camera = scene.camera
    matrix = camera.matrix_world.normalized()
    # Top right, bottom right, bottom left, top left.
    corners = [
        location_3d_to_region_2d(region, view, matrix @ corner)
        for corner in camera.data.view_frame(scene=scene)
    ]
    if any(corner is None for corner in corners):
        return None
    top_left, bottom_right = np.array(corners[3]), np.array(corners[1])
    share = (np.array([mouse_x - region.x, mouse_y - region.y]) - top_left) / (bottom_right - top_left)
    return float(share[0]), float(share[1])


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_pick_marker_color,))
