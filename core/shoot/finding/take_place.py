"""Which take a file means that a person has chosen."""

from pathlib import Path

from ...errors import InputError
from ..description import OWN, clip_name
from .find_takes import VIDEOS


def take_place(file: Path) -> Path:
    """The folder of a take for its `take.json`, the clip for `NAME.take.json`; all else is the take itself.

    Raises:
        InputError: There is not one clip beside `NAME.take.json` that it tells of.
    """
    if file.name == OWN:
        return file.parent
    name = file.name.removesuffix(f".{OWN}")
    if name == file.name or file.is_dir():
        return file
    beside = [other for other in sorted(file.parent.glob("*")) if clip_name(other) == name]
    clips = [clip for clip in beside if clip.is_dir() or clip.suffix.lower() in VIDEOS]
    if len(clips) != 1:
        raise InputError(f"{file}: {len(clips)} clips beside it are called {name}; it must tell of one")
    return clips[0]
