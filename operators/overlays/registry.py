"""Overlay of the 3D viewport: the reconstructed motion; marker outlines in the view of the take's camera."""

import logging
from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from typing import TYPE_CHECKING, Any

import bpy
import gpu
import numpy as np

from ...core.arrays import Array, IndexArray
from ...core.errors import KeymarkError
from ..bridge.camera_placement import read_lens
from ..shell.footage_view import FootageRequest, FootageView, footage_view, shown_request
from ..shell.takes import find_take, footage_of
from . import drawing
from .figures import segments
from .mask import paint
from .motion import picture, shown

if TYPE_CHECKING:
    from ...core.review.review import Review


@dataclass(frozen=True, eq=False)
class WorldView:
    """A region of a 3D viewport as a view of the motion."""

    footage: FootageView | None
    matrix: Array
    """(4, 4) from the world to the region's homogeneous coordinates, -1 to 1 after division."""
    right: Array
    """(3,) the viewer's right in the world."""
    size: Array
    """(2,) of the region [px]."""

    def point_positions(self, review: "Review", indices: IndexArray) -> Array:
        """Region pixels (I, 13, 2) of the points, NaN behind the viewer."""
        return self.project(review.points[indices])

    def pixels_per_meter(self, review: "Review", index: int) -> Array:
        """Size (13,) of a meter across the view at each point."""
        points = review.points[index]
        depth = self._before(points)
        return np.asarray(0.5 * self.size[0] * np.linalg.norm(self.matrix[0, :3] @ self.right) / depth)

    def project(self, points: Array) -> Array:
        """Region pixels (..., 2) of points (..., 3) in the world."""
        flat = points @ self.matrix[:2, :3].T + self.matrix[:2, 3]
        return np.asarray(0.5 * self.size * (1.0 + flat / self._before(points)[..., None]))

    def _before(self, points: Array) -> Array:
        """Homogeneous coordinate w (...) of points, which grows with the distance; NaN behind the viewer."""
        divisor = points @ self.matrix[3, :3] + self.matrix[3, 3]
        return np.where(divisor > 1e-6, divisor, np.nan)


def world_view(
    region: bpy.types.Region, view: bpy.types.RegionView3D, footage: FootageView | None
) -> WorldView:
    """A region of a 3D viewport as a view of the motion."""
    right = np.array(view.view_matrix, dtype=np.float64)[0, :3]
    return WorldView(
        footage,
        np.array(view.perspective_matrix, dtype=np.float64),
        right / np.linalg.norm(right),
        np.array([region.width, region.height], dtype=np.float64),
    )


def draw(context: bpy.types.Context) -> None:
    """Draw into the region that Blender is drawing."""
    space = context.space_data
    what = shown(context.scene)
    if what is None or not space.overlay.show_overlays:
        return
    footage = footage_view(context.scene, what.take, context.area, context.region)
    view = world_view(context.region, context.region_data, footage)
    paint(picture(context, what, view, context.scene.keymark.overlays))


# --- Overlay of the Movie Clip editor


@dataclass(frozen=True, eq=False)
class ClipView:
    """A region of the Movie Clip editor as a view of the motion."""

    footage: FootageView
    to_camera: Array
    """(4, 4) from the world to the footage's camera."""
    focal_px: float
    """Focal length of that camera [px of the footage]."""

    def point_positions(self, review: "Review", indices: IndexArray) -> Array:
        """Region pixels (I, 13, 2) of the points, each as the camera of its own frame saw it."""
        return self.footage.to_region(review.image_points[indices])

    def pixels_per_meter(self, review: "Review", index: int) -> Array:
        """Size (13,) of a meter across the view at each point."""
        depth = -(review.points[index] @ self.to_camera[2, :3] + self.to_camera[2, 3])
        magnified = abs(self.footage.extent[0]) / self.footage.size[0]
        return np.asarray(magnified * self.focal_px / np.where(depth > 0.0, depth, np.nan))


def clip_view(scene: bpy.types.Scene, take: bpy.types.PropertyGroup, footage: FootageView) -> ClipView:
    """A region of a Movie Clip editor as a view of a take's motion.

    Raises:
        InputError: The take's camera is missing, or of an unsupported type.
    """
    source = footage_of(scene, take)
    to_camera = np.array(source.camera.matrix_world.normalized().inverted(), dtype=np.float64)
    return ClipView(footage, to_camera, read_lens(source).focal_px)


def draw_clip_editor(context: bpy.types.Context) -> None:
    """Draw into the region that Blender is drawing."""
    scene, what = context.scene, shown(context.scene)
    if what is None or context.space_data.view != "CLIP" or what.take.camera is None:
        return
    footage = footage_view(scene, what.take, context.area, context.region)
    if footage is not None:
        paint(picture(context, what, clip_view(scene, what.take, footage), scene.keymark.overlays))


# --- Overlay of what an operator asks for


TITLE_SIZE, DETAIL_SIZE, NEAR_SIZE = 22.0, 14.0, 13.0
TOP_GAP, NEAR_GAP = 84.0, 18.0
"""Distances of the title from the region's top, where headers lie, and of the words from the mouse."""
CORNERS = 48
"""Of the brush's circle."""


def draw_request(context: bpy.types.Context) -> None:
    """Draw into the region that Blender is drawing."""
    take, request = find_take(context.scene), shown_request()
    if request is None or take is None:
        return
    view = footage_view(context.scene, take, context.area, context.region)
    if view is None:
        return
    scale, region = drawing.ui_scale(), context.region
    middle, top = 0.5 * region.width, region.height - TOP_GAP * scale
    drawing.text(request.title, middle, top, size=TITLE_SIZE, align="middle")
    if request.detail:
        below = top - 1.6 * DETAIL_SIZE * scale
        drawing.text(request.detail, middle, below, size=DETAIL_SIZE, align="middle")
    x, y = request.mouse[0] - region.x, request.mouse[1] - region.y
    if 0 <= x < region.width and 0 <= y < region.height:
        _near_mouse(request, view, float(x), float(y))


def _near_mouse(request: FootageRequest, view: FootageView, x: float, y: float) -> None:
    scale = drawing.ui_scale()
    if request.brush_px:
        drawing.lines(
            segments(brush_circle(request.brush_px, view, x, y), closed=True), drawing.INK, halo=1.0
        )
        return
    words = f"{request.title}, {request.detail}" if request.detail else request.title
    width = drawing.text_size(words, NEAR_SIZE)[0]
    left = min(x + NEAR_GAP * scale, view.region.width - width - NEAR_GAP * scale)
    drawing.text(words, left, y + NEAR_GAP * scale, size=NEAR_SIZE)


def brush_circle(radius_px: float, view: FootageView, x: float, y: float) -> np.ndarray:
    """The circle (N, 2) of a brush about a position in the region; its radius is in pixels of the footage."""
    angle = np.linspace(0.0, 2.0 * np.pi, CORNERS, endpoint=False)
    around = radius_px * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    return view.to_region(view.to_footage((x, y)) + around)


# --- Registry of the overlays, and their draw handlers in Blender's editors


DrawFunction = Callable[[bpy.types.Context], None]

logger = logging.getLogger(__name__)


@dataclass(frozen=True)
class Overlay:
    """A draw function, and the editor it draws in."""

    name: str
    """Name that users see."""
    module: str
    """Module in this folder with the function `draw(context)`."""
    space: str
    """Space of the editor, a class of `bpy.types`."""
    region: str = "WINDOW"
    phase: str = "POST_PIXEL"


OVERLAYS = (
    Overlay("Masks in the Viewport", "mask", "SpaceView3D"),
    Overlay("Masks in the Clip Editor", "mask", "SpaceClipEditor"),
    Overlay("Ignored Regions in the Viewport", "ignored", "SpaceView3D"),
    Overlay("Ignored Regions in the Clip Editor", "ignored", "SpaceClipEditor"),
    Overlay("Keypoints in the Viewport", "keypoints", "SpaceView3D"),
    Overlay("Keypoints in the Clip Editor", "keypoints", "SpaceClipEditor"),
    Overlay("Candidates in the Viewport", "candidates", "SpaceView3D"),
    Overlay("Candidates in the Clip Editor", "candidates", "SpaceClipEditor"),
    Overlay("Motion in the Viewport", "viewport", "SpaceView3D"),
    Overlay("Motion in the Clip Editor", "clip_editor", "SpaceClipEditor"),
    Overlay("Floor Grid in the Viewport", "floor_grid", "SpaceView3D"),
    Overlay("Floor Grid in the Clip Editor", "floor_grid", "SpaceClipEditor"),
    Overlay("Camera's Lines in the Viewport", "camera_lines", "SpaceView3D"),
    Overlay("Camera's Lines in the Clip Editor", "camera_lines", "SpaceClipEditor"),
    Overlay("Measuring in the Viewport", "measuring", "SpaceView3D"),
    Overlay("Measuring in the Clip Editor", "measuring", "SpaceClipEditor"),
    Overlay("Requests in the Viewport", "request", "SpaceView3D"),
    Overlay("Requests in the Clip Editor", "request", "SpaceClipEditor"),
    Overlay("Joints to Drag", "handles", "SpaceView3D"),
    Overlay("Speed and Confidence in the Timeline", "timeline", "SpaceDopeSheetEditor"),
)
"""All overlays; those of one editor are drawn in this order."""

_handlers: list[tuple[Overlay, Any]] = []
_failures: dict[Overlay, str] = {}


def guarded(overlay: Overlay, draw: DrawFunction) -> Callable[[], None]:
    """A draw handler: `draw` with blending, disabled after its first unexpected failure.

    A failure is logged once: logged at every redraw it would flood the console.
    """

    def handler() -> None:
        if overlay in _failures:
            return
        gpu.state.blend_set("ALPHA")
        try:
            draw(bpy.context)
        except KeymarkError:
            pass  # a camera of an unsupported type, for example: nothing can be drawn until that is changed
        except Exception as error:
            _failures[overlay] = str(error) or type(error).__name__
            logger.exception("Keymark's overlay '%s' failed and is switched off", overlay.name)
        finally:
            gpu.state.blend_set("NONE")

    return handler


def failures() -> dict[str, str]:
    """Messages of the failures, by name of the disabled overlay."""
    return {overlay.name: sentence for overlay, sentence in _failures.items()}


def try_again() -> None:
    """Enable overlays that failed."""
    _failures.clear()


def redraw(context: bpy.types.Context) -> None:
    """Redraw every editor that shows an overlay."""
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if any(isinstance(area.spaces.active, getattr(bpy.types, it.space)) for it in OVERLAYS):
                area.tag_redraw()


def register() -> None:
    """Add the draw handlers, unless Blender runs in the background."""
    if bpy.app.background:
        return
    for overlay in OVERLAYS:
        draw = import_module(f".{overlay.module}", __package__).draw
        space = getattr(bpy.types, overlay.space)
        handler = space.draw_handler_add(guarded(overlay, draw), (), overlay.region, overlay.phase)
        _handlers.append((overlay, handler))


def unregister() -> None:
    """Remove them."""
    while _handlers:
        overlay, handler = _handlers.pop()
        getattr(bpy.types, overlay.space).draw_handler_remove(handler, overlay.region)
    _failures.clear()
