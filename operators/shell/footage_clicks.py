"""Operators that wait for clicks on the footage, and what lies under the mouse."""

from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass

import bpy
import numpy as np
from bpy.types import Area, Context, Event, PropertyGroup, Region
from bpy_extras.view3d_utils import location_3d_to_region_2d, region_2d_to_location_3d, region_2d_to_vector_3d

from ...core.arrays import Array
from ...core.errors import InputError
from .base_operator import reported
from .footage_view import FootageRequest, ask, follow_mouse, pixel_under, shows_footage, stop_asking
from .job_operator import cancel_click
from .takes import active_take

NAVIGATION = frozenset(
    "MIDDLEMOUSE WHEELUPMOUSE WHEELDOWNMOUSE TRACKPADPAN TRACKPADZOOM MOUSEPAN MOUSEZOOM HOME LEFT_ARROW "
    "RIGHT_ARROW UP_ARROW DOWN_ARROW NUMPAD_PLUS NUMPAD_MINUS".split()
)
"""Events that move the view or change the frame; the operator passes them on to Blender."""


# --- The 3D view under the mouse


@dataclass(frozen=True, eq=False)
class WorldInRegion:
    """A region of a 3D viewport, through a camera or not."""

    region: Region
    view: bpy.types.RegionView3D

    def position(self, place: Array) -> Array | None:
        """(2,) where the region shows a place (3,) of the world [px]; None behind the viewer."""
        found = location_3d_to_region_2d(self.region, self.view, tuple(place))
        return None if found is None else np.array(found, dtype=np.float64)

    def place(self, position: Array, depth: Array) -> Array:
        """(3,) the place of the world at a position (2,) [px], as deep as another place (3,)."""
        found = region_2d_to_location_3d(self.region, self.view, tuple(position), tuple(depth))
        return np.array(found, dtype=np.float64)

    def sight(self, position: Array) -> Array:
        """(3,) unit direction of the world in which the region looks at a position (2,) [px]."""
        found = np.array(region_2d_to_vector_3d(self.region, self.view, tuple(position)), dtype=np.float64)
        return np.asarray(found / np.linalg.norm(found))


def view_under(context: Context, mouse_x: int, mouse_y: int) -> WorldInRegion | None:
    """The 3D view under the mouse [window px]; None over another editor, a sidebar or a header."""
    area = area_under(context, mouse_x, mouse_y)
    if area is None or area.type != "VIEW_3D":
        return None
    under = [region for region in area.regions if _contains(region, mouse_x, mouse_y)]
    # Sidebars and headers lie over the view.
    covering = [region for region in under if region.type in ("UI", "TOOLS", "HEADER", "TOOL_HEADER")]
    views = [region for region in under if region.type == "WINDOW"]
    return WorldInRegion(views[0], views[0].data) if views and not covering else None


def area_under(context: Context, x: int, y: int) -> Area | None:
    """The editor under the mouse [window px]; None between them."""
    return next((area for area in context.screen.areas if _contains(area, x, y)), None)


def _contains(box: Region | Area, x: int, y: int) -> bool:
    return box.x <= x < box.x + box.width and box.y <= y < box.y + box.height


# --- Operators that ask for one click on the footage after another


DONE = frozenset({"RET", "NUMPAD_ENTER"})
SCRUBBED = frozenset({"DOPESHEET_EDITOR", "GRAPH_EDITOR", "NLA_EDITOR", "SEQUENCE_EDITOR"})
"""Editors with a time line, on which a click goes to another frame."""


class ClickSequence:
    """Mixin of a modal operator that takes clicks on the footage until Enter, or a click beside it.

    Esc and a right click cancel it: its `cancel` takes everything back. The arrow keys, and clicks on a time
    line, go to other frames.
    """

    report: Callable[[set[str], str], None]  # Blender's, of the Operator this is mixed into
    cursor = "CROSSHAIR"
    ends_beside = True  # whether a click beside the footage ends it; a brush is easily put down there

    def cancel(self, context: Context) -> None:
        """Take everything back, and stop asking; Blender calls this as well."""
        stop_asking(context)

    def prepare(self, context: Context, take: PropertyGroup) -> None:
        """Note what is now, before anything is asked for."""

    @abstractmethod
    def request(self, context: Context) -> tuple[FootageRequest, str]:
        """What to click on next, and the keys for the status bar."""

    def clicked(self, context: Context, pixel: tuple[float, float]) -> set[str]:
        """Take a click on a pixel of the footage; what `modal` returns."""
        return {"RUNNING_MODAL"}

    def done(self, context: Context) -> set[str]:
        """Keep what was clicked on, by default nothing; what `modal` returns."""
        self.cancel(context)
        return {"CANCELLED"}

    def go_on(self, context: Context) -> None:
        """Skip what is asked for."""

    def go_back(self, context: Context) -> None:
        """Take the last click back."""

    def invoke(self, context: Context, event: Event) -> set[str]:
        """Begin to ask, where an editor of the window shows the footage."""
        take = active_take(context.scene)
        with reported(self):
            if not shows_footage(context, take):
                raise InputError(
                    "look through the take's camera first (Numpad 0), or open the clip in a Movie Clip editor"
                )
            self.prepare(context, take)
            context.window.cursor_modal_set(self.cursor)
            self.ask(context)
            follow_mouse(context, event)
            context.window_manager.modal_handler_add(self)
            return {"RUNNING_MODAL"}
        return {"CANCELLED"}

    def modal(self, context: Context, event: Event) -> set[str]:
        if cancel_click(self, context, event):
            return {"CANCELLED"}
        follow_mouse(context, event)
        if event.value == "PRESS":
            if event.type in DONE:
                return self.done(context)
            if event.type in ("TAB", "BACK_SPACE"):
                (self.go_on if event.type == "TAB" else self.go_back)(context)
                self.ask(context)
                return {"RUNNING_MODAL"}
            if event.type == "LEFTMOUSE":
                pixel = pixel_under(context, active_take(context.scene), event.mouse_x, event.mouse_y)
                area = area_under(context, event.mouse_x, event.mouse_y)
                if pixel is not None:
                    return self.clicked(context, pixel)
                if area is not None and area.type in SCRUBBED:
                    return {"PASS_THROUGH"}
                if self.ends_beside:
                    return {*self.done(context), "PASS_THROUGH"}
                context.workspace.status_text_set("That is not on the footage; click in it   |   Esc: Cancel")
        return {"PASS_THROUGH"} if event.type in NAVIGATION else {"RUNNING_MODAL"}

    def ask(self, context: Context) -> None:
        ask(context, *self.request(context))
