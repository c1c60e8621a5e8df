"""The footage in an editor: footage pixels to positions in a region, and back.

Footage pixels are those of the file's own picture: from its top left corner, x right, y down. The 3D viewport
shows the picture undistorted, as Blender's camera has no distortion; the Movie Clip editor shows it as it is.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import bpy
import numpy as np
from bpy.types import Area, Context, Event, PropertyGroup, Region, Scene
from bpy_extras.view3d_utils import location_3d_to_region_2d
from numpy.typing import ArrayLike

from ...core.arrays import Array
from ...core.camera.camera import Camera
from ..bridge.camera_placement import read_lens
from ..bridge.scene_frames import scene_frames, shown_index
from .results import reading_of
from .takes import FOOTAGE_EDITORS, areas, footage_of, redraw_footage


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
    """Return how a region of an editor shows a take's footage; None if it does not.

    Instead of a missing file Blender shows a picture of another size, which is not the footage.
    """
    if take.clip is None or take.clip_state.missing or region.type != "WINDOW" or not all(take.clip.size):
        return None
    space = area.spaces.active
    if area.type == "VIEW_3D":
        return _camera_view(scene, take, space, region)
    if area.type == "CLIP_EDITOR" and space.clip == take.clip and space.view == "CLIP":
        return _clip_view(scene, take, space, region)
    return None


def _views(context: Context, take: PropertyGroup) -> Iterator[FootageView]:
    """Every region of the window that shows the footage."""
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


def shows_footage(context: Context, take: PropertyGroup) -> bool:
    """Whether any editor of the window shows the footage."""
    return next(_views(context, take), None) is not None


def _camera_view(
    scene: Scene, take: PropertyGroup, space: bpy.types.SpaceView3D, region: Region
) -> FootageView | None:
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


def _clip_view(
    scene: Scene, take: PropertyGroup, space: bpy.types.SpaceClipEditor, region: Region
) -> FootageView:
    view = region.view2d
    top_left, bottom_right = (
        np.array(view.view_to_region(*corner, clip=False), dtype=np.float64)
        for corner in ((0.0, 1.0), (1.0, 0.0))
    )
    lens = None
    if space.clip_user.use_render_undistorted and take.camera is not None:
        lens = read_lens(footage_of(scene, take))
    return FootageView(
        region, (take.clip.size[0], take.clip.size[1]), top_left, bottom_right - top_left, lens
    )


def _undistorted(lens: Camera) -> Camera:
    return replace(lens, distortion=(0.0, 0.0, 0.0))


def clip_index(take: PropertyGroup, scene_frame: int | None = None) -> int:
    """Index of the clip's frame that is shown in a scene frame, the current one by default; -1 for none.

    Where the rate varies and the clip was not read yet, the frame is a guess.
    """
    scene, footage = take.id_data, footage_of(take.id_data, take)
    reading = reading_of(take)
    if reading is not None:
        frames = scene_frames(reading.tracks.time_s, footage.first_frame, footage.rate)
    else:
        frames = footage.first_frame + np.arange(max(1, take.clip.frame_duration), dtype=np.float64)
    return int(shown_index(frames, scene.frame_current if scene_frame is None else scene_frame))


# --- What an operator that waits for clicks on the footage asks for


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
