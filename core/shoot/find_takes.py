"""Finding the takes below a folder."""

import os
from pathlib import Path

from ..conversion_record import NAME as RECORD
from ..errors import InputError
from ..footage.clips.image_sequence import is_image
from .description import OWN, clip_name
from .shoot import Shoot, ShootTake
from .shoot_file import shoot_files

VIDEOS = frozenset({".avi", ".m4v", ".mkv", ".mov", ".mp4", ".mpeg", ".mpg", ".mts", ".mxf", ".webm", ".wmv"})
MOST_TAKES = 100_000


def find_takes(folder: Path, without: Path | None = None, undescribed: bool = False) -> Shoot:
    """Find every take below a folder.

    Takes are folders with `take.json`, and, where a `shoot.json` describes them, videos and folders of
    images.
    Inside a take nothing else is looked for, nor in hidden folders and folders of results, nor behind links
    to folders.

    Args:
        folder: The shoot's folder.
        without: A folder that is left out with all in it, as that of the results.
        undescribed: Whether clips count that no `shoot.json` describes yet.

    Raises:
        InputError: There is no such folder, it cannot be read, it holds no take, or two takes of one name.
    """
    if not folder.is_dir():
        raise InputError(
            f"{folder}: no such folder; a shoot is a folder of takes, or a list of them (.jsonl)"
        )
    left_out = None if without is None else os.path.realpath(without)
    takes: list[ShootTake] = []
    for place in _places(folder, left_out, undescribed):
        whole = (place / OWN).exists()
        way = place.relative_to(folder)
        name = way if whole else way.with_name(clip_name(place))
        takes.append(ShootTake(name.as_posix(), place))
        if len(takes) > MOST_TAKES:
            raise InputError(f"{folder}: holds more than {MOST_TAKES} takes; name a folder of fewer")
    if not takes:
        raise InputError(
            f"{folder}: holds no take; a take is a folder with {OWN}, or a clip that a shoot.json describes"
        )
    return Shoot(folder, tuple(sorted(takes, key=lambda take: take.name)))


def _places(folder: Path, left_out: str | None, undescribed: bool) -> list[Path]:
    if os.path.realpath(folder) == left_out:
        return []
    if (folder / OWN).exists():
        return [folder]
    if (folder / RECORD).exists():
        return []
    counted = undescribed or bool(shoot_files(folder))
    inside = sorted(file for file in folder.iterdir() if not file.name.startswith("."))
    found: list[Path] = []
    for path in inside:
        if path.is_dir() and not path.is_symlink():
            found += _places(path, left_out, undescribed)
        elif counted and path.suffix.lower() in VIDEOS and path.is_file():
            found.append(path)
    # Beside takes, or above them, images are photographs of the set and no clip.
    if not found and counted and any(is_image(file) for file in inside):
        return [folder]
    return found
