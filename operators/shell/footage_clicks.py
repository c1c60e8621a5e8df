"""Operators that wait for clicks on the footage, and what lies under the mouse."""

from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass

import bpy
import numpy as np
from bpy_extras.view3d_utils import location_3d_to_region_2d, region_2d_to_location_3d, region_2d_to_vector_3d

from ...core.arrays import Array
from .base_operator import reported
from .footage_view import FootageRequest, ask, follow_mouse, pixel_under, shows_footage, stop_asking
from .job_operator import cancel_click
from .takes import active_take

NAVIGATION = frozenset(
    "MIDDLEMOUSE WHEELUPMOUSE WHEELDOWNMOUSE TRACKPADPAN TRACKPADZOOM MOUSEPAN MOUSEZOOM HOME LEFT_ARROW "
    "RIGHT_ARROW UP_ARROW DOWN_ARROW NUMPAD_PLUS NUMPAD_MINUS".split()
)
"""Events that move the view or change the frame; the operator passes them on to Blender."""


def footage_is_shown(
    operator: bpy.types.Operator, context: bpy.types.Context, take: bpy.types.PropertyGroup
) -> bool:
    """Whether an editor of the window shows the take's footage; if not, an error is reported."""
    with reported(operator):
        if shows_footage(context, take):
            return True
        operator.report(
            {"ERROR"},
            "Look through the take's camera first (Numpad 0), or open the clip in a Movie Clip editor",
        )
    return False


# --- The 3D view under the mouse


@dataclass(frozen=True, eq=False)
class WorldInRegion:
    """A region of a 3D viewport, through a camera or not."""

    region: bpy.types.Region
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


def view_under(context: bpy.types.Context, mouse_x: int, mouse_y: int) -> WorldInRegion | None:
    """The 3D view under the mouse [window px]; None over another editor, a sidebar or a header."""
    for area in context.screen.areas:
        if area.type != "VIEW_3D":
            continue
        under = [region for region in area.regions if _contains(region, mouse_x, mouse_y)]
        # Sidebars and headers lie over the view.
        if under and all(region.type == "WINDOW" for region in under):
            return WorldInRegion(under[0], under[0].data)
    return None


def _contains(region: bpy.types.Region, x: int, y: int) -> bool:
    within = region.x <= x < region.x + region.width and region.y <= y < region.y + region.height
    return within and region.type in ("WINDOW", "UI", "TOOLS", "HEADER", "TOOL_HEADER")


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

    def cancel(self, context: bpy.types.Context) -> None:
        """Take everything back, and stop asking; Blender calls this as well."""
        stop_asking(context)

    @abstractmethod
    def request(self, context: bpy.types.Context) -> tuple[FootageRequest, str]:
        """What to click on next, and the keys for the status bar."""

    @abstractmethod
    def clicked(self, context: bpy.types.Context, pixel: tuple[float, float]) -> set[str]:
        """Take a click on a pixel of the footage; what `modal` returns."""

    def done(self, context: bpy.types.Context) -> set[str]:
        """Keep what was clicked on, by default nothing; what `modal` returns."""
        self.cancel(context)
        return {"CANCELLED"}

    def go_on(self, context: bpy.types.Context) -> None:
        """Skip what is asked for."""

    def go_back(self, context: bpy.types.Context) -> None:
        """Take the last click back."""

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Begin to ask, where the footage is shown."""
        shown = footage_is_shown(self, context, active_take(context.scene))
        return self.wait_for_clicks(context) if shown else {"CANCELLED"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Take an event."""
        return self.take_event(context, event)

    def wait_for_clicks(self, context: bpy.types.Context) -> set[str]:
        """Begin to ask; what `invoke` returns."""
        context.window.cursor_modal_set(self.cursor)
        self.ask(context)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def ask(self, context: bpy.types.Context) -> None:
        """Show what is asked for now."""
        ask(context, *self.request(context))

    def take_event(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """What `modal` returns for an event."""
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
                return self._pressed(context, event)
        return {"PASS_THROUGH"} if event.type in NAVIGATION else {"RUNNING_MODAL"}

    def _pressed(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        pixel = pixel_under(context, active_take(context.scene), event.mouse_x, event.mouse_y)
        if pixel is not None:
            return self.clicked(context, pixel)
        if _kind_under(context, event) in SCRUBBED:
            return {"PASS_THROUGH"}
        return {*self.done(context), "PASS_THROUGH"} if self.ends_beside else {"RUNNING_MODAL"}


def _kind_under(context: bpy.types.Context, event: bpy.types.Event) -> str:
    """The kind of editor under the mouse; empty between them."""
    for area in context.screen.areas:
        if 0 <= event.mouse_x - area.x < area.width and 0 <= event.mouse_y - area.y < area.height:
            return str(area.type)
    return ""
