"""Keymark's properties of a scene: its takes, and which is active."""

import bpy

from ..footage.take_footage import is_missing
from ..overlays.properties import KEYMARK_PG_overlays
from ..shell.takes import find_take, show_active_take
from .take_properties import KEYMARK_PG_take


def _active_take_changed(settings: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    show_active_take(settings.id_data)
    take = find_take(settings.id_data)
    if take is not None:
        take.clip_state.missing = is_missing(take.clip)


class KEYMARK_PG_settings(bpy.types.PropertyGroup):
    """Keymark's properties of a scene."""

    version: bpy.props.IntProperty(
        name="Version", description="Version of Keymark's properties in this file", options={"HIDDEN"}
    )
    takes: bpy.props.CollectionProperty(type=KEYMARK_PG_take)
    active_take: bpy.props.IntProperty(
        name="Active Take",
        description="The take that is worked on; its footage and camera become the scene's",
        default=0,
        min=0,
        update=_active_take_changed,
    )
    overlays: bpy.props.PointerProperty(type=KEYMARK_PG_overlays)


def register() -> None:
    """Add the properties to scenes."""
    bpy.utils.register_class(KEYMARK_PG_settings)
    bpy.types.Scene.keymark = bpy.props.PointerProperty(type=KEYMARK_PG_settings)


def unregister() -> None:
    """Remove them."""
    del bpy.types.Scene.keymark
    bpy.utils.unregister_class(KEYMARK_PG_settings)
