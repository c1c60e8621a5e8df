"""The reconstructed motion over the footage in the Movie Clip editor."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import bpy
import numpy as np

from ...core.arrays import Array, IndexArray
from ..bridge.camera_from_scene import read_lens
from ..shell.footage_view import FootageView, footage_view
from ..shell.takes import footage_of
from .motion import picture, shown
from .picture import paint

if TYPE_CHECKING:
    from ...core.review.review import Review


@dataclass(frozen=True, eq=False)
class ClipView:
    """A region that shows the footage."""

    footage: FootageView
    to_camera: Array
    """(4, 4) from the world to the camera that the footage was taken with."""
    focal_px: float
    """Its focal length [px of the footage]."""

    def places(self, review: "Review", indices: IndexArray) -> Array:
        """Places (I, 13, 2) of the points in the region; a moving camera's, each as its own frame saw it."""
        return self.footage.to_region(review.image_points[indices])

    def pixels_per_meter(self, review: "Review", index: int) -> Array:
        """Size (13,) of a meter across the view at each point."""
        depth = -(review.points[index] @ self.to_camera[2, :3] + self.to_camera[2, 3])
        magnified = abs(self.footage.extent[0]) / self.footage.size[0]
        return np.asarray(magnified * self.focal_px / np.where(depth > 0.0, depth, np.nan))


def clip_view(scene: bpy.types.Scene, take: bpy.types.PropertyGroup, footage: FootageView) -> ClipView:
    """How a region of a Movie Clip editor shows a take.

    Raises:
        InputError: The take's camera is missing, or of a kind that no footage has.
    """
    source = footage_of(scene, take)
    to_camera = np.array(source.camera.matrix_world.normalized().inverted(), dtype=np.float64)
    return ClipView(footage, to_camera, read_lens(source).focal_px)


def draw(context: bpy.types.Context) -> None:
    """Draw into the region that Blender is drawing."""
    scene, what = context.scene, shown(context.scene)
    if what is None or context.space_data.view != "CLIP" or what.take.camera is None:
        return
    footage = footage_view(scene, what.take, context.area, context.region)
    if footage is not None:
        paint(picture(context, what, clip_view(scene, what.take, footage), scene.keymark.overlays))
