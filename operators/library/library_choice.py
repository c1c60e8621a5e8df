"""Which library an operator is about: one at hand, or the one that is made in this file."""

from typing import TYPE_CHECKING

import bpy

from .editing.scene_libraries import library_here, library_of
from .registry import library_called

if TYPE_CHECKING:
    from ...core.library.library import Library


def chosen_library(context: bpy.types.Context, identifier: str) -> "Library":
    """The library of an identifier on the shelf; without one, that which is made in this file.

    Raises:
        InputError: There is none, or it is not complete.
    """
    return library_called(identifier) if identifier else library_of(library_here(context.scene))
