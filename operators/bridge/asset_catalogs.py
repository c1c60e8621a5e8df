"""Blender's file of asset catalogs, `blender_assets.cats.txt`, and .blend files of assets beside it.

Each line is `UUID:path/of/catalog:simple name`; empty lines and lines that begin with `#` are ignored.
"""

import shutil
import uuid
from collections.abc import Iterable
from pathlib import Path

import bpy
from bpy.types import ID, BlendData

from ...core.errors import InputError
from ...core.files.json_file import write_atomically
from ...core.files.output_folder import output_folder
from .blend_files import write_blend

NAME = "blender_assets.cats.txt"
VERSION = "VERSION 1"
HEADER = (
    "# This is an Asset Catalog Definition file for Blender.\n#\n"
    "# Empty lines and lines starting with `#` will be ignored.\n"
    "# The first non-ignored line should be the version indicator.\n"
    '# Other lines are of the format "UUID:catalog/path/for/assets:simple catalog name"\n\n'
    f"{VERSION}\n\n"
)
NAMESPACE = uuid.UUID("5b1f3c0e-6a52-4a43-9b57-3d1f6f4c2a90")  # one path has one identifier in all files


def catalog_file() -> Path:
    """The catalog file of the open .blend, which must be saved: at its asset library's root, or beside it."""
    if bpy.data.filepath:
        return asset_root(Path(bpy.data.filepath).parent) / NAME
    raise InputError(
        "the asset catalog is kept beside the .blend, which has not been saved; save it first, or leave "
        "Catalog empty"
    )


def asset_root(folder: Path) -> Path:
    """The asset library of the preferences that a folder lies in; the folder itself where there is none."""
    for library in bpy.context.preferences.filepaths.asset_libraries:
        root = Path(bpy.path.abspath(library.path)) if library.path else None
        if root is not None and root in (folder, *folder.parents):
            return root
    return folder


def catalog_identifier(catalog: str) -> str:
    """The UUID of a catalog that a file does not have yet."""
    return str(uuid.uuid5(NAMESPACE, _clean(catalog)))


def ensure_catalog(file: Path, catalog: str) -> str:
    """The UUID of a catalog path such as `Keymark/Walking`; it is added to the file if missing."""
    content = read_catalogs(file)
    known: dict[str, str] = {}  # UUIDs by path; of a repeated path the first
    for line in content.splitlines():
        parts = line.strip().split(":", 2)
        if not line.startswith("#") and len(parts) > 1:
            known.setdefault(parts[1], parts[0])
    names = _clean(catalog).split("/")
    paths = ["/".join(names[: depth + 1]) for depth in range(len(names))]
    if paths[-1] not in known:
        # Parents get lines of their own: without them Blender calls the file changed as soon as it is read.
        missing = [path for path in paths if path not in known]
        known |= {path: catalog_identifier(path) for path in missing}
        start = content.rstrip("\n") + "\n" if content.strip() else HEADER
        lines = [f"{known[path]}:{path}:{path.replace('/', '-')}\n" for path in missing]
        text = start + "".join(lines)
        write_atomically(file, lambda beside: beside.write_text(text, encoding="utf-8", newline="\n"))
    return known[paths[-1]]


def _clean(catalog: str) -> str:
    parts = [part.strip() for part in catalog.replace("\\", "/").split("/")]
    path = "/".join(part for part in parts if part)
    if not path or ":" in path or any(ord(letter) < 32 for letter in path):
        raise InputError(
            f"catalog '{catalog}' is not a path of names with slashes between them, without colons, "
            "such as Keymark/Walking"
        )
    return path


def read_catalogs(file: Path) -> str:
    """The text of a file of catalogs, empty where there is none; InputError where it is of another kind."""
    try:
        content = file.read_text("utf-8")
    except FileNotFoundError:
        return ""
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{file}: cannot be read as a file of asset catalogs ({error})") from error
    meant = [line for line in content.splitlines() if line.strip() and not line.startswith("#")]
    if not meant or meant[0].strip() == VERSION:
        return content
    raise InputError(f"{file}: begins with '{meant[0][:40]}'; a file of asset catalogs begins with {VERSION}")


def write_asset_blend(path: Path, root: Path, data: BlendData, assets: Iterable[tuple[ID, str]]) -> None:
    """Write assets, made meanwhile, alone into a .blend, and their catalogs; both whole, or neither."""
    if bpy.data.filepath and Path(bpy.data.filepath).resolve() == path.resolve():
        raise InputError(f"{path}: is the open file, of which only assets would be left; name another")
    read_catalogs(root / NAME)  # a sentence on its copy would name a file that is gone by then
    with output_folder(root) as new:
        if (root / NAME).exists():
            shutil.copyfile(root / NAME, new / NAME)
        made: set[ID] = set()
        for asset, catalog in assets:
            asset.asset_data.catalog_id = ensure_catalog(new / NAME, catalog)
            made.add(asset)
        blend = new / path.relative_to(root)
        blend.parent.mkdir(parents=True, exist_ok=True)
        write_blend(blend, made, data, path, fake_user=True)
