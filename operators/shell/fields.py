"""Blender's properties by name and description, as in `title: Text("Name", "Your name for it")`."""

from collections.abc import Callable
from typing import Any

import bpy

HIDDEN, SKIP_SAVE = {"HIDDEN"}, {"SKIP_SAVE"}
"""Options of a property: shown nowhere; of an operator, not as it was the last time."""
RELATIVE_PATH = {"ANIMATABLE", "PATH_SUPPORTS_BLEND_RELATIVE"}


def _by_name(define: Callable[..., Any]) -> Callable[..., Any]:
    def field(name: str = "", description: str = "", **settings: object) -> Any:
        return define(name=name, description=description, **settings)

    return field


Text = _by_name(bpy.props.StringProperty)
Switch = _by_name(bpy.props.BoolProperty)
Integer = _by_name(bpy.props.IntProperty)
Number = _by_name(bpy.props.FloatProperty)
Vector = _by_name(bpy.props.FloatVectorProperty)
Choice = _by_name(bpy.props.EnumProperty)
Entries = bpy.props.CollectionProperty
Group = bpy.props.PointerProperty
