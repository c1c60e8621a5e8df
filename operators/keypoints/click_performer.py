"""Click on the performer where a detector sees several people."""

import bpy
import numpy as np

from ...core.arrays import Array
from ...core.body.human import HUMAN
from ...core.errors import InputError
from ..shell.base_operator import BaseOperator
from ..shell.cancel_on_esc import cancel_click
from ..shell.footage_clicks import NAVIGATION, footage_is_shown
from ..shell.footage_view import pixel_under
from ..shell.redraw import redraw_footage
from ..shell.requirements import footage, idle
from ..shell.takes import active_take
from .body_point_items import point_title
from .clicks import set_click
from .frame_keypoints import keypoints_at
from .requirements import keypoint_files


class KEYMARK_OT_click_performer(BaseOperator, bpy.types.Operator):
    """Click on the performer in a frame in which a detector sees several people; one frame is often enough"""

    bl_idname = "keymark.click_performer"
    bl_label = "Click on the Performer"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (footage, keypoint_files, idle)

    pixel: bpy.props.FloatVectorProperty(
        name="Pixel",
        description="Where the performer is, in pixels of the footage from its top left corner",
        size=2,
        options={"SKIP_SAVE"},
    )

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Wait for a click on the footage."""
        if not footage_is_shown(self, context, active_take(context.scene)):
            return {"CANCELLED"}
        context.window.cursor_modal_set("CROSSHAIR")
        context.workspace.status_text_set("Click on the performer   |   Esc: Cancel")
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Take one click."""
        if cancel_click(self, context, event):
            return {"CANCELLED"}
        if event.type == "LEFTMOUSE" and event.value == "PRESS":
            pixel = pixel_under(context, active_take(context.scene), event.mouse_x, event.mouse_y)
            self.cancel(context)
            if pixel is None:
                return {"CANCELLED", "PASS_THROUGH"}
            self.pixel = pixel
            return self.execute(context)
        return {"PASS_THROUGH"} if event.type in NAVIGATION else {"RUNNING_MODAL"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Restore cursor and status bar; Blender calls this as well."""
        if context.window is not None:
            context.window.cursor_modal_restore()
            context.workspace.status_text_set(None)

    def run(self, context: bpy.types.Context) -> None:
        """Vouch for the seen point that is nearest to the click: points by hand are the performer's.

        Raises:
            InputError: Nobody is seen in this frame.
        """
        take = active_take(context.scene)
        found = nearest_point(take, context.scene.frame_current, np.array(self.pixel))
        if found is None:
            raise InputError(
                f"no detector sees anybody in frame {context.scene.frame_current}; go to one in which "
                "the performer is seen"
            )
        point, pixel = found
        set_click(take, point, pixel)
        redraw_footage(context)
        self.report({"INFO"}, f"The performer is known by the point {point_title(point)}")


def nearest_point(
    take: bpy.types.PropertyGroup, scene_frame: int, pixel: Array
) -> tuple[str, tuple[float, float]] | None:
    """The joint of anyone in a frame that is seen nearest to a pixel, and its place [px]; None for nobody."""
    best: tuple[float, str, tuple[float, float]] | None = None
    for source in keypoints_at(take, scene_frame):
        for column, name in enumerate(source.names):
            places = source.pixel[:, column]
            away = np.linalg.norm(places - pixel, axis=-1)
            if name not in HUMAN.point_names or not np.isfinite(away).any():
                continue
            row = int(np.nanargmin(away))
            if best is None or away[row] < best[0]:
                best = float(away[row]), name, (float(places[row, 0]), float(places[row, 1]))
    return None if best is None else best[1:]


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_click_performer,))
