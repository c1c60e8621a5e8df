"""The keyframe libraries that are made in a scene: which one is worked on, and what is chosen in it."""

from collections.abc import Iterable, Iterator
from contextlib import contextmanager

import bpy

from ....core.errors import InputError

TAG_SEPARATOR = ", "
"""Between the tags in a text field."""
_suspensions: list[None] = []
"""Not empty while many properties change, so that pose assets follow once and not at each."""


def find_library_here(scene: bpy.types.Scene) -> bpy.types.PropertyGroup | None:
    """The library that is worked on in a scene; None where there is none."""
    settings = scene.keymark
    count = len(settings.libraries)
    return settings.libraries[min(settings.active_library, count - 1)] if count else None


def library_here(scene: bpy.types.Scene) -> bpy.types.PropertyGroup:
    """The library that is worked on in a scene.

    Raises:
        InputError: The scene has none.
    """
    library = find_library_here(scene)
    if library is None:
        raise InputError("no keyframe library is made in this file; make a new one, or edit one of the list")
    return library


def active_posture(library: bpy.types.PropertyGroup) -> bpy.types.PropertyGroup | None:
    """The posture chosen in a library's list."""
    chosen = library.active_posture
    return library.postures[chosen] if chosen < len(library.postures) else None


def active_motion(library: bpy.types.PropertyGroup) -> bpy.types.PropertyGroup | None:
    """The motion chosen in a library's list."""
    chosen = library.active_motion
    return library.motions[chosen] if chosen < len(library.motions) else None


@contextmanager
def updates_suspended() -> Iterator[None]:
    """Do not write changed properties to the pose assets meanwhile."""
    _suspensions.append(None)
    try:
        yield
    finally:
        _suspensions.pop()


def updates_are_suspended() -> bool:
    """Whether changed properties are not to be written to the pose assets yet."""
    return bool(_suspensions)


def library_containing(part: bpy.types.PropertyGroup) -> bpy.types.PropertyGroup | None:
    """The scene's library that a part of one belongs to: a motion, a step, a line of its sources."""
    for library in part.id_data.keymark.libraries:
        if part == library or any(part == other for other in _parts(library)):
            return library
    return None


def _parts(library: bpy.types.PropertyGroup) -> Iterable[bpy.types.PropertyGroup]:
    yield from library.sources
    yield from library.postures
    for motion in library.motions:
        yield motion
        yield from motion.steps
