"""Which take a file means that a person has chosen, and where a new take may lie."""

from pathlib import Path

from ...errors import InputError
from ...take.description import OWN, clip_name
from ...take.shoot_file import shoot_files
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


def check_free(folder: Path) -> None:
    """Refuse a folder in which a new `take.json` would hide takes: inside a take no other is looked for.

    Raises:
        InputError: Clips of a shoot lie in it, or folders that are takes.
    """
    if not folder.is_dir() or (folder / OWN).exists():
        return
    shared = bool(shoot_files(folder))
    for other in sorted(folder.iterdir()):
        if other.name.startswith("."):
            continue
        if (other / OWN).is_file() or (shared and other.suffix.lower() in VIDEOS):
            raise InputError(
                f"{folder}: holds other takes, as {other.name}, which a {OWN} there would hide; name a "
                "folder of its own"
            )
