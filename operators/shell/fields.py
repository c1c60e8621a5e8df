"""Blender's properties by name and description, as in `title: Text("Name", "Yours")`, or of a record."""

from collections.abc import Callable
from typing import Any, TypeVar

import bpy
from bpy.types import PropertyGroup

from ...core.files import kinds
from ...core.files.records import Record, declared, descriptions

HIDDEN, SKIP_SAVE = {"HIDDEN"}, {"SKIP_SAVE"}
"""Options of a property: shown nowhere; of an operator, not as it was the last time."""
TOLERANCE = {"min": 0.1, "soft_min": 1.0, "soft_max": 50.0, "max": 500.0, "precision": 1, "step": 50}
"""Settings of a distance in millimeters that keys may be off."""
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


def File(description: str, name: str = "File Path", **settings: object) -> Any:  # noqa: N802
    """An operator's path of a file, which is not as it was the last time."""
    return Text(name, description, subtype="FILE_PATH", options=SKIP_SAVE, **settings)


def Pixel(name: str, description: str) -> Any:  # noqa: N802
    """An operator's place in the footage, from its top left corner."""
    return Vector(
        name, f"{description}, in pixels of the footage from its top left corner", size=2, options=SKIP_SAVE
    )


def Pointer(name: str, description: str, kind: type, **settings: object) -> Any:  # noqa: N802
    """A property that points to a data-block of a kind."""
    return Group(name=name, description=description, type=kind, **settings)


def declared_property(record: type[Record], field: str, **settings: Any) -> Any:
    """The property of a record's field, with its default and docstring; `settings` say what else."""
    kind, _, default = declared(record)[field]
    kind = kind.item if isinstance(kind, kinds.Nullable) else kind
    title = field.replace("_", " ").title()
    words = {"name": title, "description": _tooltip(descriptions(record)[field])} | settings
    if isinstance(kind, kinds.Choice):
        choices: Any = kind.makes
        tooltips = descriptions(choices)
        items = [(one.name, _title(one.name), _tooltip(tooltips[one.name])) for one in choices]
        return bpy.props.EnumProperty(items=items, default=default.name, **words)
    if isinstance(kind, kinds.Flag):
        return bpy.props.BoolProperty(default=default, **words)
    if isinstance(kind, kinds.Text):
        return bpy.props.StringProperty(**words)
    return bpy.props.FloatProperty(**{"default": default or 0.0} | words)


R = TypeVar("R", bound=Record)


def read_declared(record: type[R], group: PropertyGroup, **names: str) -> R:
    """The record that a group's properties hold; `names` are those of properties that differ from fields."""
    values = {}
    for field, (kind, _, _) in declared(record).items():
        value = getattr(group, names.get(field, field))
        choices: Any = kind.makes if isinstance(kind, kinds.Choice) else None
        values[field] = value if choices is None else choices[value]
    return record(**values)


def _title(name: str) -> str:
    return name if name in ("FK", "IK") else name.replace("_", " ").title()


def _tooltip(text: str) -> str:
    """A description without the full stop, and what it says of files: the default, which Blender shows."""
    return text.rstrip(".").partition("; the default is")[0]
