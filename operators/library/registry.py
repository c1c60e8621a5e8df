"""The libraries at hand: those that come with Keymark, and the user's own.

The disk is read once the sidebar is looked at, and by operators that change what lies there; drawing only
sees what was found then.
"""

from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING
from zlib import crc32

import bpy
from bpy.app import timers

from ...core.library.texts import EVERY_LIBRARY
from ..shell.redraw import redraw_sidebars
from ..shell.results import EXTENSION

if TYPE_CHECKING:
    from ...core.library.library import Library

OWN = "libraries"
"""Name of the user's folder."""
SOON_S = 0.1
"""Before the shelf is read, so that what asks for it is drawn first."""
Item = tuple[str, str, str, str, int]
_items: list[Item] = []
"""Blender keeps no copy of a menu's words: they must stay as long as it is shown."""


def own_folder() -> Path:
    """Where the user's libraries lie; made where it is missing."""
    try:
        return Path(bpy.utils.extension_path_user(EXTENSION, path=OWN, create=True))
    except ValueError:  # not installed as an extension
        folder = Path(bpy.app.tempdir) / OWN
        folder.mkdir(parents=True, exist_ok=True)
        return folder


def folders() -> list[Path]:
    """Where libraries are looked for; of two with the same identifier the first counts, the user's own."""
    from ...core.library.registry import SHIPPED

    return [own_folder(), SHIPPED]


def library_called(identifier: str) -> "Library":
    """A library on the shelf, read from its file.

    Raises:
        InputError: There is none, or its file is unusable.
    """
    from ...core.library.registry import find_library

    return find_library(identifier, folders())


def chosen(context: bpy.types.Context) -> bpy.types.PropertyGroup | None:
    """The library that is chosen in the list."""
    shelf = context.window_manager.keymark_shelf
    return shelf.libraries[shelf.active] if shelf.active < len(shelf.libraries) else None


def library_items(_properties: object, context: bpy.types.Context | None) -> list[Item]:
    """What a menu of libraries shows: all that can be used, and first the choice by itself."""
    manager = (context or bpy.context).window_manager
    if bpy.app.background and not len(manager.keymark_shelf.libraries):
        fill()  # no timer runs, and nothing is drawn
    automatic = "Choose the library that fits the footage best, and say how sure that is"
    found: list[Item] = [(EVERY_LIBRARY, "Automatic", automatic, "VIEWZOOM", 0)]
    found += [
        (library.name, library.title, library.description, "ASSET_MANAGER", _number(library.name))
        for library in manager.keymark_shelf.libraries
        if not library.problem
    ]
    if found != _items:
        _items[:] = found
    return _items


def _number(identifier: str) -> int:
    """What a file keeps of a choice among menu entries: the same for a library, whatever others there are."""
    return 1 + crc32(identifier.encode()) % (2**31 - 2)


def fill(choose: str = "") -> None:
    """Read what lies on the shelf.

    Args:
        choose: Identifier of the library that the list shall point to; by default the same as before.
    """
    from ...core.library.registry import registered_libraries

    manager = bpy.context.window_manager
    shelf, own = manager.keymark_shelf, own_folder()
    before = chosen(bpy.context)
    wanted = choose or (before.name if before is not None else "")
    shelf.libraries.clear()
    for found in registered_libraries(folders()):
        item = shelf.libraries.add()
        item.name, item.title, item.problem = found.identifier, found.title, found.problem
        item.version, item.is_own, item.path = found.version, found.path.parent == own, str(found.path)
        if found.library is not None:
            _describe(item, found.library)
    names = [item.name for item in shelf.libraries]
    shelf.active = names.index(wanted) if wanted in names else 0


def _describe(item: bpy.types.PropertyGroup, library: "Library") -> None:
    item.author, item.license, item.description = library.author, library.license, library.description
    item.motions = len(library.motions)
    for posture in library.postures:
        item.postures.add().name = posture.name


def need() -> None:
    """Read the shelf soon if that was not done since Blender started or opened a file; drawing may ask."""
    empty = not len(bpy.context.window_manager.keymark_shelf.libraries)
    if empty and not bpy.app.background and not timers.is_registered(_fill_now):
        timers.register(_fill_now, first_interval=SOON_S)


def forget() -> None:
    """No longer read the shelf by itself."""
    if timers.is_registered(_fill_now):
        timers.unregister(_fill_now)
    _items.clear()


def _fill_now() -> None:
    with suppress(ModuleNotFoundError):  # without the libraries that Keymark brings; operators say so
        fill()
        redraw_sidebars(bpy.context)
