"""Overlay of the Movie Clip editor: the reconstructed motion over the footage."""

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


def draw(context: bpy.types.Context) -> None:
    """Draw into the region that Blender is drawing."""
    scene, what = context.scene, shown(context.scene)
    if what is None or context.space_data.view != "CLIP" or what.take.camera is None:
        return
    footage = footage_view(scene, what.take, context.area, context.region)
    if footage is not None:
        paint(picture(context, what, clip_view(scene, what.take, footage), scene.keymark.overlays))
