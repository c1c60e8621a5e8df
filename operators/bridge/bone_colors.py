"""Colors of an actor's bones by the side of the body: those of the overlays and the reports."""

import bpy

from ...core.body.side_colors import LIGHT, SHADED, Rgb, side_of

WHITER = 0.55
"""Share of white in the color of the active bone, which outshines the selected ones."""
EARLIER = {"L": "THEME01", "R": "THEME04", "": "THEME09"}
"""Palettes that actors of earlier versions have: red on the left and blue on the right."""


def color_bones(armature: bpy.types.Armature) -> None:
    """Give every bone the color of its side: the strong one, lighter where it is selected or active."""
    for bone in armature.bones:
        _color(bone)


def recolor_earlier(armature: bpy.types.Armature) -> None:
    """Give the bones of an actor of an earlier version their colors, except those colored by hand."""
    for bone in armature.bones:
        if bone.color.palette == EARLIER[side_of(bone.name)]:
            _color(bone)


def _color(bone: bpy.types.Bone) -> None:
    side = side_of(bone.name)
    bone.color.palette = "CUSTOM"
    custom = bone.color.custom
    custom.normal = _floats(SHADED[side])
    custom.select = _floats(LIGHT[side])
    custom.active = [level + WHITER * (1.0 - level) for level in _floats(LIGHT[side])]


def _floats(rgb: Rgb) -> tuple[float, ...]:
    return tuple(level / 255.0 for level in rgb)
