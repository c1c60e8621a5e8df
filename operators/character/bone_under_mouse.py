"""The bone of a character under the mouse, in any 3D viewport of the window."""

import bpy
import numpy as np
from bpy_extras.view3d_utils import location_3d_to_region_2d

from ...core.arrays import Array

NEAR_PX = 25.0
"""Farthest that a click may be from a bone, at a UI scale of 1."""
SAME_PX = 3.0
"""Bones that are hardly farther than the nearest lie over it; the one nearest to the viewer counts."""


def bone_under(
    context: bpy.types.Context, armature_object: bpy.types.Object, mouse_x: int, mouse_y: int
) -> str | None:
    """Return the name of the visible bone nearest to the mouse; None where none is near.

    Args:
        context: Its window is searched for a 3D viewport.
        armature_object: The character.
        mouse_x: Mouse position in the window, from its left edge [px].
        mouse_y: The same from its bottom edge [px].
    """
    for area in context.screen.areas:
        if area.type != "VIEW_3D":
            continue
        for region in area.regions:
            inside = 0 <= mouse_x - region.x < region.width and 0 <= mouse_y - region.y < region.height
            if region.type == "WINDOW" and inside:
                near = NEAR_PX * context.preferences.system.ui_scale
                mouse = np.array([mouse_x - region.x, mouse_y - region.y], dtype=np.float64)
                return _nearest(context, armature_object, region, mouse, near)
    return None


def _nearest(
    context: bpy.types.Context,
    armature_object: bpy.types.Object,
    region: bpy.types.Region,
    mouse: Array,
    near: float,
) -> str | None:
    view = region.data
    shown = armature_object.evaluated_get(context.evaluated_depsgraph_get())
    names, ends, depths = [], [], []
    for bone in shown.pose.bones:
        if not is_visible(bone):
            continue
        places = [shown.matrix_world @ end for end in (bone.head, bone.tail)]
        pixels = [location_3d_to_region_2d(region, view, place) for place in places]
        if any(pixel is None for pixel in pixels):
            continue
        names.append(bone.name)
        ends.append([tuple(pixel) for pixel in pixels])
        depths.append(-(view.view_matrix @ ((places[0] + places[1]) / 2.0)).z)
    if not names:
        return None
    index = nearest_segment(mouse, np.array(ends, dtype=np.float64), np.array(depths), near)
    return None if index is None else names[index]


def nearest_segment(point: Array, ends: Array, depths: Array, near: float) -> int | None:
    """Index of the segment nearest to a point; None where all are farther than `near`.

    Args:
        point: (2,) [px].
        ends: (N, 2, 2) first and second end of each segment [px].
        depths: (N,) distance of each from the viewer; of segments over each other the nearest counts.
        near: Largest distance [px].
    """
    start, along = ends[:, 0], ends[:, 1] - ends[:, 0]
    squared = np.maximum(np.sum(along**2, axis=1), 1e-12)
    share = np.clip(np.sum((point - start) * along, axis=1) / squared, 0.0, 1.0)
    distance = np.linalg.norm(start + share[:, None] * along - point, axis=1)
    if distance.min() > near:
        return None
    level = np.flatnonzero(distance <= distance.min() + SAME_PX)
    return int(level[np.argmin(depths[level])])


def is_visible(pose_bone: bpy.types.PoseBone) -> bool:
    """Whether the viewport shows a bone: not hidden, and in a visible collection or in none."""
    bone = pose_bone.bone
    if bone.hide or getattr(pose_bone, "hide", False):  # Blender 5 hides pose bones, 4.5 bones
        return False
    return not len(bone.collections) or any(each.is_visible_effectively for each in bone.collections)
