"""Regions of the 3D viewport and of the Movie Clip editor as views of the motion."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from bpy.types import Context, PropertyGroup, Region, RegionView3D

from ...core.arrays import Array, IndexArray
from ...core.camera.camera import Camera
from ..bridge.footage import read_lens
from ..shell.footage_view import FootageView, footage_view
from ..shell.takes import footage_of

if TYPE_CHECKING:
    from ...core.review.review import Review


@dataclass(frozen=True, eq=False)
class WorldView:
    """A region of a 3D viewport as a view of the motion."""

    footage: FootageView | None
    matrix: Array  # (4, 4) from the world to the region's homogeneous coordinates, -1 to 1 after division
    right: Array  # (3,) the viewer's right in the world
    size: Array  # (2,) of the region [px]

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


def world_view(region: Region, view: RegionView3D, footage: FootageView | None) -> WorldView:
    """A region of a 3D viewport as a view of the motion."""
    right = np.array(view.view_matrix, dtype=np.float64)[0, :3]
    return WorldView(
        footage,
        np.array(view.perspective_matrix, dtype=np.float64),
        right / np.linalg.norm(right),
        np.array([region.width, region.height], dtype=np.float64),
    )


@dataclass(frozen=True, eq=False)
class ClipView:
    """A region of the Movie Clip editor as a view of the motion."""

    footage: FootageView
    to_camera: Array  # (4, 4) from the world to the footage's camera
    lens: Camera  # of that camera

    def point_positions(self, review: "Review", indices: IndexArray) -> Array:
        """Region pixels (I, 13, 2) of the points, each as the camera of its own frame saw it."""
        return self.footage.to_region(review.image_points[indices])

    def pixels_per_meter(self, review: "Review", index: int) -> Array:
        """Size (13,) of a meter across the view at each point."""
        depth = -(review.points[index] @ self.to_camera[2, :3] + self.to_camera[2, 3])
        magnified = abs(self.footage.extent[0]) / self.footage.size[0]
        return np.asarray(magnified * self.lens.focal_px / np.where(depth > 0.0, depth, np.nan))

    def project(self, points: Array) -> Array:
        """Region pixels (..., 2) of points (..., 3) as the camera sees them now; NaN behind it."""
        pixels, depth = self.lens.project(points @ self.to_camera[:3, :3].T + self.to_camera[:3, 3])
        return self.footage.to_region(np.where((depth > 0.0)[..., None], pixels, np.nan))


MotionView = WorldView | ClipView


def motion_view(context: Context, take: PropertyGroup) -> MotionView | None:
    """The region that is drawn as a view of a take's motion; None where overlays are off or show nothing."""
    in_space = context.space_data.type == "VIEW_3D"
    if in_space and not context.space_data.overlay.show_overlays:
        return None
    footage = footage_view(context.scene, take, context.area, context.region)
    if in_space:
        return world_view(context.region, context.region_data, footage)
    if footage is None or take.camera is None:
        return None
    source = footage_of(context.scene, take)
    to_camera = np.array(source.camera.matrix_world.normalized().inverted(), dtype=np.float64)
    return ClipView(footage, to_camera, read_lens(source))
