"""Registry of keyframe libraries, shipped and the user's own: their files, and how lists show them.

Folders are read when the sidebar is first drawn, and by operators that change files.
"""

from collections.abc import Iterable, Sequence
from contextlib import suppress
from functools import lru_cache
from pathlib import Path
from zlib import crc32

import bpy
from bpy.app import timers
from bpy.types import Context, PropertyGroup

from ...core.errors import InputError
from ...core.prior import registry as prior_registry
from ...core.prior.library import Library, write_library
from ...core.prior.registry import find_library, identifier_of, registered_libraries
from ...core.prior.texts import EVERY_LIBRARY
from ..shell.fields import SKIP_SAVE, Entries, Group, Integer, Switch, Text
from ..shell.results import EXTENSION
from ..shell.takes import redraw_sidebars

Item = tuple[str, str, str, str, int]
_items: list[Item] = []  # Blender keeps no copy of a menu's strings, which must live as long as it is shown


def own_folder() -> Path:
    """Folder of the user's libraries; created if missing."""
    try:
        return Path(bpy.utils.extension_path_user(EXTENSION, path="libraries", create=True))
    except ValueError:  # not installed as an extension
        folder = Path(bpy.app.tempdir) / "libraries"
        folder.mkdir(parents=True, exist_ok=True)
        return folder


def folders() -> list[Path]:
    """Folders of libraries; of two libraries with the same identifier that of the first folder counts."""
    return [own_folder(), prior_registry.SHIPPED]


def load_registered(identifier: str) -> Library:
    """The registered library of an identifier; an InputError without a usable file of it."""
    return find_library(identifier, folders())


def named_libraries(name: str) -> Sequence[Library]:
    """All libraries where `EVERY_LIBRARY` or nothing is named, else that of an identifier, title or file."""
    return all_libraries() if name in ("", EVERY_LIBRARY) else [load_registered(name)]


def all_libraries() -> Sequence[Library]:
    """All registered libraries, the same objects until a file changes: what is made of them stays known."""
    files = sorted(file for folder in folders() if folder.is_dir() for file in folder.glob("*.json"))
    stats = [(file, file.stat()) for file in files]
    return _libraries(tuple((file, stat.st_mtime_ns, stat.st_size) for file, stat in stats))


@lru_cache(maxsize=1)
def _libraries(_files: tuple[tuple[Path, int, int], ...]) -> Sequence[Library]:
    return prior_registry.find_libraries(EVERY_LIBRARY, folders())


def write_to_registry(libraries: Iterable[Library]) -> None:
    """Write libraries into the user's folder; InputError where that would lose a file of another content."""
    folder = own_folder()
    there = registered_libraries([folder])
    files = []
    for library in libraries:  # people may have put files there under any name
        name = library.identifier
        own = [entry.path for entry in there if entry.content and identifier_of(entry) == name]
        path = own[0] if own else prior_registry.library_path(folder, name)
        other = next((entry for entry in there if entry.path == path and path not in own), None)
        if other is not None:
            held = f"the library '{other.title}'" if other.content else "something that is no library"
            raise InputError(f"{path}: holds {held}, which would be lost; give that file another name first")
        files.append((path, library))
    for path, library in files:
        write_library(path, library)


def chosen_entry(context: Context) -> PropertyGroup | None:
    """The entry that is chosen in the list."""
    listed = context.window_manager.keymark_shelf
    return listed.libraries[listed.active] if listed.active < len(listed.libraries) else None


def chosen_identifier(context: Context) -> str:
    """Identifier of the library that is chosen in the list; empty where there is none."""
    entry = chosen_entry(context)
    return "" if entry is None else str(entry.name)


def library_items(_properties: object, context: Context | None) -> list[Item]:
    """Items of a menu of all libraries that can be used."""
    manager = (context or bpy.context).window_manager
    if bpy.app.background and not len(manager.keymark_shelf.libraries):
        refresh()  # no timer runs, and nothing is drawn
    found: list[Item] = [
        # Files store the number of an item: the same whichever other libraries there are.
        (one.name, one.title, one.description, "ASSET_MANAGER", 1 + crc32(one.name.encode()) % (2**31 - 2))
        for one in manager.keymark_shelf.libraries
        if not one.problem
    ]
    if found != _items:
        _items[:] = found
    return _items


def refresh(choose: str = "") -> None:
    """Read the folders, fill the list, and choose the library of an identifier, else the same as before."""
    listed, own = bpy.context.window_manager.keymark_shelf, own_folder()
    wanted = choose or chosen_identifier(bpy.context)
    listed.libraries.clear()
    for found in registered_libraries(folders()):
        item = listed.libraries.add()
        item.name, item.title, item.problem = identifier_of(found), found.title, found.problem
        item.is_own = found.path.parent == own
        if (library := found.content) is not None:
            item.version = library.version
            item.author, item.license, item.description = library.author, library.license, library.description
            item.motions, item.postures = len(library.motions), len(library.postures)
    names = [item.name for item in listed.libraries]
    listed.active = names.index(wanted) if wanted in names else 0


def refresh_if_empty() -> None:
    """Read the folders soon if the list is empty, as after Blender's start or a new file; for drawing."""
    empty = not len(bpy.context.window_manager.keymark_shelf.libraries)
    if empty and not bpy.app.background and not timers.is_registered(_refresh_now):
        timers.register(_refresh_now, first_interval=0.1)  # the panel is drawn first


def _refresh_now() -> None:
    with suppress(ModuleNotFoundError):  # SciPy or OpenCV is missing, which operators report
        refresh()
        redraw_sidebars(bpy.context)


class KEYMARK_PG_shelved(bpy.types.PropertyGroup):
    """A registered library; `name` is its identifier."""

    title: Text("Title")
    version: Integer("Version")
    author: Text("Author")
    license: Text("License")
    description: Text("Description")
    motions: Integer("Motions")
    is_own: Switch("Own", "It lies in the user's folder and can be removed")
    problem: Text("Problem", "Why the file cannot be used")
    postures: Integer("Postures")


class KEYMARK_PG_shelf(bpy.types.PropertyGroup):
    """The registry."""

    libraries: Entries(type=KEYMARK_PG_shelved)
    active: Integer("Active Library", "The library that is chosen in the list", min=0)


ATTACHED = {"WindowManager.keymark_shelf": Group(type=KEYMARK_PG_shelf, options=SKIP_SAVE)}


def detach() -> None:
    """Cancel a reading of the folders that was asked for."""
    if timers.is_registered(_refresh_now):
        timers.unregister(_refresh_now)
    _items.clear()
