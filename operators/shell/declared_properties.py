"""Blender's properties of choices that a record of the core declares."""

from typing import Any, TypeVar

import bpy
from bpy.types import PropertyGroup

from ...core.files.kinds import Choice, Flag, Nullable, Text
from ...core.files.records import Record, declared, descriptions


def declared_property(record: type[Record], field: str, **settings: Any) -> Any:
    """The property of a record's field: a choice, a flag, a number or a text, with its default.

    The tooltip is the field's docstring; `settings` are what else Blender shows.
    """
    kind, _, default = declared(record)[field]
    kind = kind.item if isinstance(kind, Nullable) else kind
    title = field.replace("_", " ").title()
    words = {"name": title, "description": _tooltip(descriptions(record)[field])} | settings
    if isinstance(kind, Choice):
        kinds: Any = kind.makes
        tooltips = descriptions(kinds)
        items = [(one.name, _title(one.name), _tooltip(tooltips[one.name])) for one in kinds]
        return bpy.props.EnumProperty(items=items, default=default.name, **words)
    if isinstance(kind, Flag):
        return bpy.props.BoolProperty(default=default, **words)
    if isinstance(kind, Text):
        return bpy.props.StringProperty(**words)
    return bpy.props.FloatProperty(**{"default": default or 0.0} | words)


R = TypeVar("R", bound=Record)


def read_declared(record: type[R], group: PropertyGroup, **names: str) -> R:
    """The record that a group's properties hold; `names` are those of properties that differ from fields."""
    values = {}
    for field, (kind, _, _) in declared(record).items():
        value = getattr(group, names.get(field, field))
        kinds: Any = kind.makes if isinstance(kind, Choice) else None
        values[field] = value if kinds is None else kinds[value]
    return record(**values)


def _title(name: str) -> str:
    return name if name in ("FK", "IK") else name.replace("_", " ").title()


def _tooltip(text: str) -> str:
    """A description without the full stop, and what it says of files: the default, which Blender shows."""
    return text.rstrip(".").partition("; the default is")[0]
