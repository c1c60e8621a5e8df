"""Keyframe libraries as .blend files of pose assets with their catalogs: written, and read from strangers."""

from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import bpy

from ....core.arrays import Image
from ....core.errors import InputError
from ....core.library.library import Library
from ....core.library.library_fields import MOST_POSTURES
from ..assets.asset_blend import write_asset_blend
from ..blend_writer import one_line
from .pose_assets import add_assets, catalog_of, is_posture, library_from_assets

LARGEST_BYTES = 256 * 2**20
"""A library of a thousand postures with pictures fits; a film's scene handed in by mistake does not."""
BEGINNINGS = (b"BLENDER", b"\x28\xb5\x2f\xfd", b"\x1f\x8b")
"""Of .blend files: plain, and packed in the two ways that Blender knows."""


def write_library_blend(
    path: Path, library: Library, root: Path | None = None, pictures: Iterable[Image] | None = None
) -> None:
    """Write a library's pose assets and nothing else into a .blend, and its catalogs into their file.

    The open file is not touched. Both files appear whole, or neither.

    Args:
        path: The .blend.
        library: What to write.
        root: Folder of the asset library that `path` lies in, whose catalogs are kept there; by default that
            of the .blend itself.
        pictures: Of each posture; drawn by default.

    Raises:
        InputError: The file of catalogs is of another kind, nothing can be written there, or it is the open
            file.
        ConversionError: A file cannot be written.
    """
    catalogs = [catalog_of(library, posture) for posture in library.postures]
    with bpy.data.temp_data() as data:
        assets = zip(add_assets(library, data, pictures), catalogs, strict=True)
        write_asset_blend(path, root or path.parent, data, assets)


def read_library_blend(path: Path) -> tuple[Library, ...]:
    """The libraries whose pose assets a .blend holds; nothing of it stays in the open file.

    Only Actions marked as assets are loaded, and of these only curves and texts are looked at: what scripts,
    drivers or other data there may be is neither loaded nor run.

    Raises:
        InputError: It is no .blend, it is damaged or too large, or it holds no library.
    """
    _check(path)
    with _loaded_actions(path) as actions:
        libraries = library_from_assets(actions)
    if not libraries:
        raise InputError(
            f"{path}: holds no pose assets of a keyframe library; export one with Keymark, as .blend or .json"
        )
    return libraries


def _check(path: Path) -> None:
    try:
        size = path.stat().st_size
        with path.open("rb") as file:
            beginning = file.read(8)
    except OSError as error:
        reason = error.strerror or error
        raise InputError(f"{path}: cannot be read ({reason}); it must be a .blend") from error
    if size > LARGEST_BYTES:
        raise InputError(
            f"{path}: has {size / 2**20:.0f} MiB; a .blend of a library has at most {LARGEST_BYTES >> 20} MiB"
        )
    if not beginning.startswith(BEGINNINGS):
        raise InputError(f"{path}: is no .blend; it begins as none does")


@contextmanager
def _loaded_actions(path: Path) -> Iterator[Sequence[bpy.types.Action]]:
    """The Actions of a .blend that are marked as assets; afterwards all that came with them is removed."""
    before = set(bpy.data.user_map())
    try:
        try:
            with bpy.data.libraries.load(str(path), link=False, assets_only=True) as (found, wanted):
                names = list(found.actions)
                if len(names) <= MOST_POSTURES:
                    wanted.actions = names
        except (OSError, RuntimeError, UnicodeDecodeError) as error:
            raise InputError(
                f"{path}: Blender cannot read it ({one_line(error)}); it may be damaged or cut off"
            ) from error
        if len(names) > MOST_POSTURES:
            raise InputError(
                f"{path}: holds {len(names)} Actions marked as assets; at most {MOST_POSTURES} are read"
            )
        yield [action for action in wanted.actions if action is not None and is_posture(action)]
    finally:
        bpy.data.batch_remove(set(bpy.data.user_map()) - before)
