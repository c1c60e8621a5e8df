"""The reconstructed motion in the 3D viewport; marker outlines where it looks through the take's camera."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import bpy
import numpy as np

from ...core.arrays import Array, IndexArray
from ..shell.footage_view import FootageView, footage_view
from .motion import picture, shown
from .picture import paint

if TYPE_CHECKING:
    from ...core.review.review import Review


@dataclass(frozen=True, eq=False)
class WorldView:
    """A region that looks at the world."""

    footage: FootageView | None
    matrix: Array
    """(4, 4) from the world to the region's homogeneous coordinates, -1 to 1 after division."""
    right: Array
    """(3,) the viewer's right in the world."""
    size: Array
    """(2,) of the region [px]."""

    def places(self, review: "Review", indices: IndexArray) -> Array:
        """Places (I, 13, 2) of the points in the region, NaN behind the viewer."""
        return self.project(review.points[indices])

    def pixels_per_meter(self, review: "Review", index: int) -> Array:
        """Size (13,) of a meter across the view at each point."""
        points = review.points[index]
        depth = self._before(points)
        return np.asarray(0.5 * self.size[0] * np.linalg.norm(self.matrix[0, :3] @ self.right) / depth)

    def project(self, points: Array) -> Array:
        """Places (..., 2) in the region of points (..., 3) of the world."""
        flat = points @ self.matrix[:2, :3].T + self.matrix[:2, 3]
        return np.asarray(0.5 * self.size * (1.0 + flat / self._before(points)[..., None]))

    def _before(self, points: Array) -> Array:
        """(...) what places are divided by, which grows with the distance; NaN behind the viewer."""
        divisor = points @ self.matrix[3, :3] + self.matrix[3, 3]
        return np.where(divisor > 1e-6, divisor, np.nan)


def world_view(
    region: bpy.types.Region, view: bpy.types.RegionView3D, footage: FootageView | None
) -> WorldView:
    """How a region of a 3D viewport sees the world."""
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
