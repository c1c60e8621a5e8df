"""What of an animated .blend is the same in every run: its curves. The file itself holds memory addresses."""

import hashlib

import bpy
import numpy as np

from .actions import existing_channelbag


def curve_digest(animated: bpy.types.Object) -> str:
    """SHA-256 of the curves that animate an object, to the last digit."""
    hashed = hashlib.sha256()
    for curve in sorted(_curves(animated), key=lambda curve: (curve.data_path, curve.array_index)):
        points = np.empty(2 * len(curve.keyframe_points), dtype="<f4")
        curve.keyframe_points.foreach_get("co", points)
        hashed.update(f"{curve.data_path} {curve.array_index} {len(points)}:".encode())
        hashed.update(points.tobytes())
    return hashed.hexdigest()


def _curves(animated: bpy.types.Object) -> list[bpy.types.FCurve]:
    animation = animated.animation_data
    if animation is None or animation.action is None:
        return []
    bag = existing_channelbag(animation.action, animated)
    return [] if bag is None else list(bag.fcurves)
