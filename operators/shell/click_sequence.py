"""Operators that ask for one click on the footage after another."""

from abc import abstractmethod
from collections.abc import Callable

import bpy

from .cancel_on_esc import cancel_click
from .footage_clicks import NAVIGATION
from .footage_request import FootageRequest, ask, follow_mouse
from .footage_view import pixel_under
from .takes import active_take

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
    ends_beside = True
    """Whether a click beside the footage ends it; a brush is easily put down there."""

    @abstractmethod
    def cancel(self, context: bpy.types.Context) -> None:
        """Take everything back, and stop asking; Blender calls this as well."""

    @abstractmethod
    def request(self, context: bpy.types.Context) -> tuple[FootageRequest, str]:
        """What to click on next, and the keys for the status bar."""

    @abstractmethod
    def clicked(self, context: bpy.types.Context, pixel: tuple[float, float]) -> set[str]:
        """Take a click on a pixel of the footage; what `modal` returns."""

    @abstractmethod
    def done(self, context: bpy.types.Context) -> set[str]:
        """Keep what was clicked on; what `modal` returns."""

    def go_on(self, context: bpy.types.Context) -> None:
        """Skip what is asked for."""

    def go_back(self, context: bpy.types.Context) -> None:
        """Take the last click back."""

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
        inside = 0 <= event.mouse_x - area.x < area.width and 0 <= event.mouse_y - area.y < area.height
        if inside:
            return str(area.type)
    return ""
