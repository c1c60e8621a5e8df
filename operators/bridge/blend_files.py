""".blend files, written and looked at, and scenes for the time being: what is open is not touched."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import bpy
from bpy.types import ID, BlendData, Scene

from ...core.errors import ConversionError, InputError
from ...core.files.paths import real_path, regular_file_size


@contextmanager
def own_scene(name: str) -> Iterator[Scene]:
    """A scene for the time being; it and everything made or loaded meanwhile is removed again."""
    before = {block.as_pointer() for block in bpy.data.user_map()}
    scene = bpy.data.scenes.new(name)
    try:
        yield scene
    finally:
        bpy.data.scenes.remove(scene)
        made = [block for block in bpy.data.user_map() if block.as_pointer() not in before]
        bpy.data.batch_remove(made)


@contextmanager
def showing_scene(scene: Scene) -> Iterator[None]:
    """Let a scene be the one that operators work in; then the one before is again."""
    window = bpy.context.window
    if window is None:  # operators find the scene in the context alone
        with bpy.context.temp_override(scene=scene, view_layer=scene.view_layers[0]):
            yield
        return
    before = window.scene
    window.scene = scene
    try:
        yield
    finally:
        window.scene = before


BLEND_MAGIC = (b"BLENDER", b"\x28\xb5\x2f\xfd", b"\x1f\x8b")  # plain, Zstandard and gzip


def check_blend(path: Path, what: str, largest_bytes: int | None = None) -> None:
    """Raise InputError where a file is missing, no .blend, or too large for `what` it should hold."""
    size = regular_file_size(path, "a .blend")
    try:
        with path.open("rb") as file:
            magic = file.read(8)
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror or error}); name a .blend") from error
    if largest_bytes is not None and size > largest_bytes:
        raise InputError(
            f"{path}: has {size / 2**20:.0f} MiB; a .blend of {what} has at most {largest_bytes >> 20} MiB"
        )
    if not magic.startswith(BLEND_MAGIC):
        raise InputError(f"{path}: is no .blend; it must be a file that Blender saved")


def load_blocks(
    path: Path, kind: str, advice: str, choose: Callable[[list[str]], list[str]], **options: object
) -> list[Any]:
    """Append datablocks of a kind out of a .blend, by chosen names; where Blender cannot, with `advice`."""
    try:
        with bpy.data.libraries.load(str(real_path(path)), link=False, **options) as (inside, wanted):
            setattr(wanted, kind, choose(list(getattr(inside, kind))))
    except (OSError, RuntimeError, UnicodeDecodeError) as error:
        raise InputError(f"{path}: Blender cannot read it ({one_line(error)}); {advice}") from error
    return [block for block in getattr(wanted, kind) if block is not None]


def write_blend(
    path: Path, blocks: set[ID], data: BlendData | None = None, named: Path | None = None, **options: object
) -> None:
    """Write datablocks and all that they use into a .blend, or raise ConversionError on the file `named`."""
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
