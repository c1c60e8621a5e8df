"""Whether a take's camera still stands where it was put by guess."""

from typing import TYPE_CHECKING

import bpy

from ..bridge.camera_placement import read_placement
from ..bridge.footage_camera import may_move

if TYPE_CHECKING:
    from ...core.footage.camera_placement import CameraPlacement

NO_GUESS = (0.0, 0.0, 0.0)
"""Height, tilt and roll of a take whose camera was not put anywhere by guess."""
SAME = 1e-4
"""Difference from the guess [m, rad] that still counts as rounding."""


def placement_is_guess(take: bpy.types.PropertyGroup) -> bool:
    """Whether the take's camera still is where it was put because nobody had said where it stood."""
    if take.camera is None or tuple(take.guessed_placement) == NO_GUESS or may_move(take.camera):
        return False
    now = as_numbers(read_placement(take.camera))
    return max(abs(one - other) for one, other in zip(now, take.guessed_placement, strict=True)) < SAME


def as_numbers(placement: "CameraPlacement") -> tuple[float, float, float]:
    """Height [m], tilt and roll [rad]."""
    return placement.height_m, placement.tilt_rad, placement.roll_rad
