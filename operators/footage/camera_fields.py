"""Height, tilt and roll of a take's camera as fields: they read and write the camera object."""

from dataclasses import replace
from typing import TYPE_CHECKING

import bpy

from ..bridge.camera_placement import fixed_reason, read_placement, write_placement
from ..bridge.footage_camera import may_move
from ..shell.takes import find_take

if TYPE_CHECKING:
    from ...core.footage.camera_placement import CameraPlacement

NO_GUESS = (0.0, 0.0, 0.0)
"""Height, tilt and roll of a take whose camera was not put anywhere by guess."""
DECIMALS = 5
"""Digits that are shown: Blender's own matrices have about as many, and a level camera shows 0."""
SAME = 1e-4
"""Difference from the guess [m, rad] that still counts as rounding."""


def still_camera(context: bpy.types.Context) -> str | None:
    """The take's camera stands still, and can be set."""
    take = find_take(context.scene)
    return fixed_reason(take.camera if take else None)


def placement_is_guess(take: bpy.types.PropertyGroup) -> bool:
    """Whether the take's camera still is where it was put because nobody had said where it stood."""
    if take.camera is None or tuple(take.guessed_placement) == NO_GUESS or may_move(take.camera):
        return False
    now = as_numbers(read_placement(take.camera))
    return max(abs(one - other) for one, other in zip(now, take.guessed_placement, strict=True)) < SAME


def confirm_placement(take: bpy.types.PropertyGroup) -> None:
    """Let the camera's placement count as known in every take with this camera."""
    for other in take.id_data.keymark.takes:
        if other.camera == take.camera:
            other.guessed_placement = NO_GUESS


def as_numbers(placement: "CameraPlacement") -> tuple[float, float, float]:
    """Height [m], tilt and roll [rad]."""
    return placement.height_m, placement.tilt_rad, placement.roll_rad


def get_height(take: bpy.types.PropertyGroup) -> float:
    """Height of the take's camera above the floor [m]."""
    return 0.0 if take.camera is None else round(read_placement(take.camera).height_m, DECIMALS)


def set_height(take: bpy.types.PropertyGroup, value: float) -> None:
    """Raise or lower the take's camera."""
    _change(take, height_m=value)


def get_tilt(take: bpy.types.PropertyGroup) -> float:
    """Angle of the camera's view above the horizon [rad]."""
    return 0.0 if take.camera is None else round(read_placement(take.camera).tilt_rad, DECIMALS)


def set_tilt(take: bpy.types.PropertyGroup, value: float) -> None:
    """Tilt the take's camera."""
    _change(take, tilt_rad=value)


def get_roll(take: bpy.types.PropertyGroup) -> float:
    """Turn of the camera about its view [rad]."""
    return 0.0 if take.camera is None else round(read_placement(take.camera).roll_rad, DECIMALS)


def set_roll(take: bpy.types.PropertyGroup, value: float) -> None:
    """Turn the take's camera about its view."""
    _change(take, roll_rad=value)


def _change(take: bpy.types.PropertyGroup, **change: float) -> None:
    """Change the camera's placement: one that was entered is no guess, whatever the number."""
    if fixed_reason(take.camera) is None:
        write_placement(take.camera, replace(read_placement(take.camera), **change))
        confirm_placement(take)
        take.camera_findings = ""
