"""Properties of the registry of libraries, as lists and menus show them; no file stores them."""

import bpy

from . import registry


class KEYMARK_PG_shelved(bpy.types.PropertyGroup):
    """A registered library; `name` is its identifier."""

    title: bpy.props.StringProperty(name="Title")
    version: bpy.props.IntProperty(name="Version")
    author: bpy.props.StringProperty(name="Author")
    license: bpy.props.StringProperty(name="License")
    description: bpy.props.StringProperty(name="Description")
    motions: bpy.props.IntProperty(name="Motions")
    is_own: bpy.props.BoolProperty(name="Own", description="It lies in the user's folder and can be removed")
    problem: bpy.props.StringProperty(name="Problem", description="Why the file cannot be used")
    postures: bpy.props.IntProperty(name="Postures")


class KEYMARK_PG_shelf(bpy.types.PropertyGroup):
    """The registry."""

    libraries: bpy.props.CollectionProperty(type=KEYMARK_PG_shelved)
    active: bpy.props.IntProperty(
        name="Active Library", description="The library that is chosen in the list", default=0, min=0
    )


_register_classes, _unregister_classes = bpy.utils.register_classes_factory(
    (KEYMARK_PG_shelved, KEYMARK_PG_shelf)
)


def register() -> None:
    """Register the groups, and add the registry to the window manager."""
    _register_classes()
    bpy.types.WindowManager.keymark_shelf = bpy.props.PointerProperty(
        type=KEYMARK_PG_shelf, options={"SKIP_SAVE"}
    )


def unregister() -> None:
    """Take it all back."""
    registry.cancel_refresh()
    del bpy.types.WindowManager.keymark_shelf
    _unregister_classes()
