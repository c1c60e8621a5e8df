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
            "{path}: cannot be read ({strerror}); it must be a .blend",
            path=path,
            strerror=error.strerror or error,
        ) from error
    if largest_bytes is not None and size > largest_bytes:
        raise InputError(
            "{path}: has {size:.0f} MiB; a .blend of {what} has at most {largest_bytes} MiB",
            path=path,
            size=size / 2**20,
            what=what,
            largest_bytes=largest_bytes >> 20,
        )
    if not magic.startswith(BLEND_MAGIC):
        raise InputError("{path}: is no .blend; it must be a file that Blender saved", path=path)
