"""A .blend of assets, and the file of their catalogs beside it."""

import shutil
from collections.abc import Iterable
from pathlib import Path

import bpy

from ....core.errors import InputError
from ....core.files.output_folder import output_folder
from ..blend_writer import write_blend
from .catalogs import NAME, ensure_catalog, read_catalogs


def write_asset_blend(
    path: Path, root: Path, data: bpy.types.BlendData, assets: Iterable[tuple[bpy.types.ID, str]]
) -> None:
    """Write assets, with what they need and nothing else, into a .blend, and their catalogs into a file.

    Both files appear whole, or neither.

    Args:
        path: The .blend; one that is there is replaced.
        root: Folder of the asset library that `path` lies in, whose catalogs are kept there.
        data: Where the assets are made.
        assets: Data-blocks that are marked as assets, and the catalog of each; made while they are asked for.

    Raises:
        InputError: The file of catalogs is of another kind, nothing can be written there, or it is the open
            file.
        ConversionError: A file cannot be written.
    """
    if bpy.data.filepath and Path(bpy.data.filepath).resolve() == path.resolve():
        raise InputError(f"{path}: is the open file, of which only assets would be left; name another")
    read_catalogs(root / NAME)  # a sentence on its copy would name a file that is gone by then
    with output_folder(root) as new:
        if (root / NAME).exists():
            shutil.copyfile(root / NAME, new / NAME)
        made: set[bpy.types.ID] = set()
        for asset, catalog in assets:
            asset.asset_data.catalog_id = ensure_catalog(new / NAME, catalog)
            made.add(asset)
        blend = new / path.relative_to(root)
        blend.parent.mkdir(parents=True, exist_ok=True)
        write_blend(blend, made, data, path, fake_user=True)
