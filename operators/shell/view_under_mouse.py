"""The 3D view under the mouse: places of the world to positions in its region, and back."""

from dataclasses import dataclass

import bpy
import numpy as np
from bpy_extras.view3d_utils import (
    location_3d_to_region_2d,
    region_2d_to_location_3d,
    region_2d_to_vector_3d,
)

from ...core.arrays import Array


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
    """The 3D view that lies under the mouse; None over another editor, a sidebar or a header.

    Args:
        context: Its window is searched.
        mouse_x: Mouse position in the window, from its left edge [px].
        mouse_y: The same from its bottom edge [px].
    """
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
