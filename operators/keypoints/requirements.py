"""Requirements of operators that follow the footage: what is missing in the step What to Follow."""

import bpy

from ..shell.takes import find_take
from .evidence import has_contours, has_keypoints


def anything_to_follow(context: bpy.types.Context) -> str | None:
    """The take follows markers, keypoints, tracks or contours."""
    take = find_take(context.scene)
    if take is None or _has_points(take) or has_contours(take):
        return None  # a take without footage says so itself
    if take.follow.use_contours and take.camera is not None:
        return "Load keypoints, assign tracks or add markers first: contours need a camera that stands still"
    return "Switch on the contours, load keypoints, assign tracks or add markers first (What to Follow)"


def keypoint_files(context: bpy.types.Context) -> str | None:
    """The take has a file of keypoints."""
    take = find_take(context.scene)
    return None if take and len(take.follow.files) else "Load keypoints first"


def points_to_follow(context: bpy.types.Context) -> str | None:
    """The take follows markers, keypoints or tracks; contours alone are not enough."""
    take = find_take(context.scene)
    if take is None or _has_points(take):
        return None
    return "Load keypoints, assign tracks or add markers first; this needs more than contours"


def _has_points(take: bpy.types.PropertyGroup) -> bool:
    return bool((take.follow.use_markers and len(take.markers)) or has_keypoints(take))
