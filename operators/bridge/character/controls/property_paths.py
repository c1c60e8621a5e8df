"""Data paths of custom properties of pose bones."""

import bpy


def property_path(bone: str, name: str) -> str:
    """Data path of a pose bone's custom property."""
    bone, name = bpy.utils.escape_identifier(bone), bpy.utils.escape_identifier(name)
    return f'pose.bones["{bone}"]["{name}"]'
