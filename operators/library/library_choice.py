"""The library an operator is run on: a registered one, or the one that is made in this file."""

from typing import TYPE_CHECKING

import bpy

from .editing.scene_libraries import library_here

if TYPE_CHECKING:
    from ...core.library.library import Library


def chosen_library(context: bpy.types.Context, identifier: str) -> "Library":
    """The registered library of an identifier; without one, that which is made in this file.

    Raises:
        InputError: There is none, or it is not complete.
    """
    from .editing.library_from_scene import library_from_scene
    from .registry_files import load_registered

    if identifier:
        return load_registered(identifier)
    return library_from_scene(library_here(context.scene))
