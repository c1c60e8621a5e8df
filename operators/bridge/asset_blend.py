"""A .blend of Actions marked as assets, and the file of their catalogs beside it."""

import shutil
from collections.abc import Callable, Iterable
from pathlib import Path

import bpy

from ...core.errors import ConversionError, InputError
from ...core.files.output_folder import output_folder
from .asset_catalogs import NAME, ensure_catalog, read_catalogs

Add = Callable[[bpy.types.BlendData], Iterable[tuple[bpy.types.Action, str]]]
"""Makes Actions, marked as assets, and names the catalog of each."""


def write_asset_blend(path: Path, root: Path, add: Add) -> None:
    """Write Actions and nothing else into a .blend, and their catalogs into the file of catalogs.

    The open file is not touched. Both files appear whole, or neither.

    Args:
        path: The .blend; one that is there is replaced.
        root: Folder of the asset library that `path` lies in, whose catalogs are kept there.
        add: Makes the Actions, in the file that it is given.

    Raises:
        InputError: The file of catalogs is of another kind, nothing can be written there, or it is the open
            file.
        ConversionError: A file cannot be written.
    """
    if bpy.data.filepath and Path(bpy.data.filepath).resolve() == path.resolve():
        raise InputError(f"{path}: is the open file, of which only assets would be left; name another")
    read_catalogs(root / NAME)  # a sentence on its copy would name a file that is gone by then
    with output_folder(root) as new, bpy.data.temp_data() as data:
        if (root / NAME).exists():
            shutil.copyfile(root / NAME, new / NAME)
        actions: list[bpy.types.Action] = []
        for action, catalog in add(data):
            action.asset_data.catalog_id = ensure_catalog(new / NAME, catalog)
            actions.append(action)
        blend = new / path.relative_to(root)
        blend.parent.mkdir(parents=True, exist_ok=True)
        try:
            data.libraries.write(str(blend), set(actions), fake_user=True, compress=True)
        except RuntimeError as error:
            reason = " ".join(str(error).split())[:200]
            raise ConversionError(f"{path}: cannot be written ({reason})") from error
