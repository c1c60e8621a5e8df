""".blend files: written, and looked at afterwards, since Blender is silent about a disk that was full."""

from pathlib import Path

import bpy

from ...core.errors import ConversionError


def write_blend(
    path: Path,
    blocks: set[bpy.types.ID],
    data: bpy.types.BlendData | None = None,
    named: Path | None = None,
    **options: object,
) -> None:
    """Write datablocks and all that they use into a compressed .blend.

    Args:
        path: The file.
        blocks: The datablocks.
        data: Where they are; by default in the open file.
        named: The file's name in sentences, where it will have another.
        options: More for `bpy.data.libraries.write`.

    Raises:
        ConversionError: Blender could not write the file, or not all of it.
    """
    where = named or path
    try:
        (data or bpy.data).libraries.write(str(path), blocks, compress=True, **options)
    except (RuntimeError, OSError) as error:
        raise ConversionError(f"{where}: Blender could not write the file ({one_line(error)})") from error
    names = {block.name for block in blocks}
    try:
        with bpy.data.libraries.load(str(path)) as (found, _):
            there = {name for kind in dir(found) for name in getattr(found, kind)}
    except (RuntimeError, OSError) as error:
        raise ConversionError(
            f"{where}: Blender could not write the whole file ({one_line(error)}); the disk may be full"
        ) from error
    if not names <= there:
        raise ConversionError(f"{where}: Blender has left out {', '.join(sorted(names - there))}")


def one_line(error: Exception) -> str:
    """What Blender says of a failure, short enough for a sentence."""
    return " ".join(str(error).split())[:200]
