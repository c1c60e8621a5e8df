"""The footage in an editor: its pixels in a region and back, and operators that wait for clicks on it.

Footage pixels are those of the file's own picture: from its top left corner, x right, y down. The 3D viewport
shows the picture undistorted, as Blender's camera has no distortion; the Movie Clip editor shows it as it is.
"""

from abc import abstractmethod
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import bpy
import numpy as np
from bpy.types import Area, Context, Event, PropertyGroup, Region, Scene, SpaceView3D
from bpy_extras.view3d_utils import location_3d_to_region_2d, region_2d_to_location_3d, region_2d_to_vector_3d
from numpy.typing import ArrayLike

from ...core.arrays import Array
from ...core.camera.camera import Camera
from ...core.errors import InputError
from ..bridge.footage import read_lens
from ..bridge.scene_frames import scene_frames, shown_index
from .base_operator import reported
from .job_operator import cancel_click
from .results import reading_of
from .takes import FOOTAGE_EDITORS, active_take, areas, footage_of, redraw_footage


@dataclass(frozen=True, eq=False)
class FootageView:
    """A region that shows a take's footage."""

    region: Region
    size: tuple[int, int]  # width and height of the footage [px]
    top_left: Array  # (2,) position of the picture's top left corner in the region, y up [px]
    extent: Array  # (2,) vector from there to the bottom right corner [px]
    lens: Camera | None
    """The lens whose distortion is removed in the region; None if the picture is shown as it is."""

    def to_region(self, pixels: ArrayLike) -> Array:
        """Positions (..., 2) in the region of footage pixels (..., 2)."""
        flat = np.asarray(pixels, dtype=np.float64)
        if self.lens is not None:
            _, direction = self.lens.rays(flat)
            flat = _undistorted(self.lens).project(direction)[0]
        return np.asarray(self.top_left + flat / self.size * self.extent)

    def to_footage(self, positions: ArrayLike) -> Array:
        """Footage pixels (..., 2) at positions (..., 2) in the region."""
        flat = (np.asarray(positions, dtype=np.float64) - self.top_left) / self.extent * self.size
        if self.lens is not None:
            _, direction = _undistorted(self.lens).rays(flat)
            flat = self.lens.project(direction)[0]
        return np.asarray(flat)


def ui_scale() -> float:
    """Screen pixels for each unscaled pixel: resolution scale and high-density screens."""
    return float(bpy.context.preferences.system.ui_scale) or 1.0  # 0 before there is a window


def footage_view(scene: Scene, take: PropertyGroup, area: Area, region: Region) -> FootageView | None:
    """How a region of an editor shows a take's footage; None if it does not, or its file is missing."""
    if take.clip is None or take.clip_state.missing or region.type != "WINDOW" or not all(take.clip.size):
        return None
    space = area.spaces.active
    if area.type == "VIEW_3D":
        return _camera_view(scene, take, space, region)
    if area.type != "CLIP_EDITOR" or space.clip != take.clip or space.view != "CLIP":
        return None
    corner, opposite = (
        np.array(region.view2d.view_to_region(*uv, clip=False), dtype=np.float64)
        for uv in ((0.0, 1.0), (1.0, 0.0))
    )
    undistorted = space.clip_user.use_render_undistorted and take.camera is not None
    lens = read_lens(footage_of(scene, take)) if undistorted else None
    return FootageView(region, tuple(take.clip.size), corner, opposite - corner, lens)


def _views(context: Context, take: PropertyGroup) -> Iterator[FootageView]:
    for area in context.screen.areas:
        for region in area.regions:
            view = footage_view(context.scene, take, area, region)
            if view is not None:
                yield view


def view_of_footage_under(
    context: Context, take: PropertyGroup, mouse_x: int, mouse_y: int
) -> FootageView | None:
    """The region under the mouse [window px] that shows the footage; the mouse may lie beside the picture."""
    for view in _views(context, take):
        x, y = mouse_x - view.region.x, mouse_y - view.region.y
        if 0 <= x < view.region.width and 0 <= y < view.region.height:
            return view
    return None


def pixel_under(
    context: Context, take: PropertyGroup, mouse_x: int, mouse_y: int
) -> tuple[float, float] | None:
    """The footage pixel under the mouse [window px]; None if no editor shows the footage there."""
    view = view_of_footage_under(context, take, mouse_x, mouse_y)
    if view is None:
        return None
    x, y = view.to_footage((mouse_x - view.region.x, mouse_y - view.region.y))
    return (float(x), float(y)) if 0.0 <= x < view.size[0] and 0.0 <= y < view.size[1] else None


def _camera_view(scene: Scene, take: PropertyGroup, space: SpaceView3D, region: Region) -> FootageView | None:
    camera = space.camera if space.use_local_camera else scene.camera
    view = space.region_3d
    if camera is None or camera != take.camera or view is None or view.view_perspective != "CAMERA":
        return None
    matrix = camera.matrix_world.normalized()
    # `view_frame` gives top right, bottom right, bottom left, top left.
    frame = [matrix @ corner for corner in camera.data.view_frame(scene=scene)]
    corners = [location_3d_to_region_2d(region, view, corner) for corner in (frame[3], frame[1])]
    if any(corner is None for corner in corners):
        return None
    top_left, bottom_right = (np.array(corner, dtype=np.float64) for corner in corners)
    lens = read_lens(footage_of(scene, take))
    return FootageView(
        region, lens.resolution, top_left, bottom_right - top_left, lens if any(lens.distortion) else None
    )


def _undistorted(lens: Camera) -> Camera:
    return replace(lens, distortion=(0.0, 0.0, 0.0))


def clip_index(take: PropertyGroup, scene_frame: int | None = None) -> int:
    """Index of the clip's frame shown in a scene frame, by a guess if its rate varies unread; -1 for none."""
    scene, footage = take.id_data, footage_of(take.id_data, take)
    reading = reading_of(take)
    if reading is not None:
        frames = scene_frames(reading.tracks.time_s, footage.first_frame, footage.rate)
    else:
        frames = footage.first_frame + np.arange(max(1, take.clip.frame_duration), dtype=np.float64)
    return int(shown_index(frames, scene.frame_current if scene_frame is None else scene_frame))


SIDES = {".L": "the performer's own left", ".R": "the performer's own right"}
"""Of what people read as left or right of the picture."""


@dataclass
class FootageRequest:
    """What is asked for now."""

    title: str  # as in `Click on: Forearm Left`
    detail: str = ""  # what is easily mistaken about it
    brush_px: float = 0.0  # radius of a brush in pixels of the footage; 0 for an operator without one
    head: tuple[float, float] | None = None  # its top, in pixels of the footage, where it was clicked on
    of_footage: bool = True  # whether the click is on the footage; else on what a 3D viewport shows
    mouse: tuple[int, int] = (-1, -1)  # position of the mouse in the window [px]
    keys: str = ""  # those that may be pressed


_request: FootageRequest | None = None


def shown_request() -> FootageRequest | None:
    """What is asked for now; None if nothing is."""
    return _request


def side_of(name: str) -> str:
    """Whose left or right a body part or point is; empty for those in the middle."""
    return SIDES.get(name[-2:], "")


def ask(context: Context, request: FootageRequest, keys: str) -> None:
    """Ask for something, in the header and beside the mouse, with the keys that may be pressed."""
    global _request
    request.keys = keys
    if _request is not None and request.mouse == (-1, -1):
        request.mouse = _request.mouse
    _request = request
    sentence = f"{request.title}, {request.detail}" if request.detail else request.title
    context.workspace.status_text_set(f"{sentence}   |   {keys}")
    for area in areas(context, *FOOTAGE_EDITORS):
        area.header_text_set(sentence)
    redraw_footage(context)


def follow_mouse(context: Context, event: Event) -> None:
    """Let the request follow the mouse."""
    if _request is not None and (event.mouse_x, event.mouse_y) != _request.mouse:
        _request.mouse = event.mouse_x, event.mouse_y
        redraw_footage(context)


def stop_asking(context: Context) -> None:
    """Ask for nothing; status bar, headers and cursor are as before."""
    global _request
    _request = None
    if context.window is None:  # Blender closes it or opens another file
        return
    context.window.cursor_modal_restore()
    context.workspace.status_text_set(None)
    for area in areas(context, *FOOTAGE_EDITORS):
        area.header_text_set(None)
    redraw_footage(context)


NAVIGATION = frozenset(
    "MIDDLEMOUSE WHEELUPMOUSE WHEELDOWNMOUSE TRACKPADPAN TRACKPADZOOM MOUSEPAN MOUSEZOOM HOME LEFT_ARROW "
    "RIGHT_ARROW UP_ARROW DOWN_ARROW NUMPAD_PLUS NUMPAD_MINUS".split()
)
"""Events that move the view or change the frame; the operator passes them on to Blender."""


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
            if next(_views(context, take), None) is None:
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
