""".blend files from strangers, looked at before Blender opens them."""

from pathlib import Path

from ...core.errors import InputError
from ...core.files.regular_file import regular_file_size

BLEND_MAGIC = (b"BLENDER", b"\x28\xb5\x2f\xfd", b"\x1f\x8b")
"""First bytes of .blend files: plain, Zstandard and gzip."""


def check_blend(path: Path, what: str, largest_bytes: int | None = None) -> None:
    """Refuse a file that is no .blend, or too large for what it should hold.

    Args:
        path: The file.
        what: What it holds, with its article, for the sentence.
        largest_bytes: A larger one is refused.

    Raises:
        InputError: It is missing, no regular file, no .blend, or too large.
    """
    size = regular_file_size(path, "a .blend")
    try:
        with path.open("rb") as file:
            magic = file.read(8)
    except OSError as error:
        raise InputError(
            f"{path}: cannot be read ({(error.strerror or error)}); it must be a .blend"
        ) from error
    if largest_bytes is not None and size > largest_bytes:
        raise InputError(
            f"{path}: has {size / 2**20:.0f} MiB; a .blend of {what} has at most {largest_bytes >> 20} MiB"
        )
    if not magic.startswith(BLEND_MAGIC):
        raise InputError(f"{path}: is no .blend; it must be a file that Blender saved")
