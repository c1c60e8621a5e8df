"""Keyframe libraries in files: .json, or .blend files of pose assets, written and read with suspicion."""

from pathlib import Path

import bpy

from ....core.errors import InputError
from ....core.prior.library import MOST_POSTURES, Library, read_library
from ..asset_catalogs import write_asset_blend
from ..blend_files import check_blend, load_blocks
from .pose_assets import add_assets, catalog_of, library_from_assets

LARGEST_BYTES = 256 * 2**20  # enough for a thousand postures with pictures; a film's scene is refused


def write_library_blend(path: Path, library: Library, root: Path | None = None) -> None:
    """Write a library's pose assets alone into a .blend, and its catalogs into `root` or else beside it."""
    catalogs = [catalog_of(library, posture) for posture in library.postures]
    with bpy.data.temp_data() as data:
        assets = zip(add_assets(library, data), catalogs, strict=True)
        write_asset_blend(path, root or path.parent, data, assets)


def read_library_blend(path: Path) -> tuple[Library, ...]:
    """The libraries whose pose assets a .blend holds; nothing of it stays in the open file.

    Only Actions marked as assets are loaded, and of these only curves and texts are read: scripts, drivers
    and other data are neither loaded nor run. InputError where the file has no library, or is unusable.
    """
    check_blend(path, "a library", LARGEST_BYTES)
    before, names = set(bpy.data.user_map()), []

    def few(there: list[str]) -> list[str]:
        names.extend(there)
        return there if len(there) <= MOST_POSTURES else []

    try:
        actions = load_blocks(path, "actions", "it may be damaged or cut off", few, assets_only=True)
        if len(names) > MOST_POSTURES:
            raise InputError(
                f"{path}: holds {len(names)} Actions marked as assets; at most {MOST_POSTURES} are read"
            )
        libraries = library_from_assets(actions)
    finally:
        bpy.data.batch_remove(set(bpy.data.user_map()) - before)
    if not libraries:
        raise InputError(
            f"{path}: holds no pose assets of a keyframe library; export one with Keymark, as .blend or .json"
        )
    return libraries


def read_libraries(path: Path) -> tuple[Library, ...]:
    """The libraries of a file: one in a .json, one or more in a .blend; InputError for another."""
    suffix = path.suffix.lower()
    if suffix == ".blend":
        return read_library_blend(path)
    if suffix == ".json":
        return (read_library(path),)
    raise InputError(f"{path}: is neither a .json nor a .blend; libraries are kept in these")
