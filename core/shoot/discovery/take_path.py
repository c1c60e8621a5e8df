"""The take that a chosen file belongs to, and folders in which a new take may be written."""

from pathlib import Path

from ...errors import InputError
from ...take.description import TAKE_FILE, clip_name
from ...take.shoot_file import find_shoot_files
from .find_takes import VIDEOS


def take_path(file: Path) -> Path:
    """The path of a file's take: the folder of a `take.json`, the clip of a `NAME.take.json`, else itself.

    Raises:
        InputError: Not exactly one clip beside `NAME.take.json` has that name.
    """
    if file.name == TAKE_FILE:
        return file.parent
    name = file.name.removesuffix(f".{TAKE_FILE}")
    if name == file.name or file.is_dir():
        return file
    beside = [other for other in sorted(file.parent.glob("*")) if clip_name(other) == name]
    clips = [clip for clip in beside if clip.is_dir() or clip.suffix.lower() in VIDEOS]
    if len(clips) != 1:
        raise InputError(f"{file}: {len(clips)} clips beside it are called {name}; it must tell of one")
    return clips[0]


def check_hides_no_take(folder: Path) -> None:
    """Refuse a folder in which a new `take.json` would hide takes: inside a take no other is searched.

    Raises:
        InputError: The folder holds clips of a shoot, or folders that are takes.
    """
    if not folder.is_dir() or (folder / TAKE_FILE).exists():
        return
    shared = bool(find_shoot_files(folder))
    for other in sorted(folder.iterdir()):
        if other.name.startswith("."):
            continue
        if (other / TAKE_FILE).is_file() or (shared and other.suffix.lower() in VIDEOS):
            raise InputError(
                f"{folder}: holds other takes, as {other.name}, which a {TAKE_FILE} there would hide; name a "
                "folder of its own"
            )
