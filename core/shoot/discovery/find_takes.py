"""Finding the takes below a folder."""

import os
from collections import Counter
from pathlib import Path

from ...errors import InputError
from ...footage.clips.image_sequence import is_image, stem_of_number
from ...take.conversion_record import NAME as RECORD
from ...take.description import OWN, clip_name
from ...take.shoot_file import NAME, shoot_files
from ..shoot import Shoot, ShootTake
from .take_names import check_names, name_of_way

VIDEOS = frozenset({".avi", ".m4v", ".mkv", ".mov", ".mp4", ".mpeg", ".mpg", ".mts", ".mxf", ".webm", ".wmv"})
MOST_TAKES = 100_000
NO_TAKE = f"holds no take; a take is a folder with {OWN}, or a clip with a {NAME}, which keymark new writes"
NO_CLIP = "holds no clip; a clip is a video or a folder of numbered images"
DEEPEST = 64
"""Folders below each other that are looked through: more are a circle that a file system has made."""


def find_takes(folder: Path, without: Path | None = None, undescribed: bool = False) -> Shoot:
    """Find every take below a folder.

    Takes are folders with `take.json`, and, where a `shoot.json` describes them, videos and folders of
    images. Inside a take nothing else is looked for, nor in hidden folders, in results of a conversion, or
    behind links to folders. A folder that cannot be read counts as a take that will fail: it may hold some.

    Args:
        folder: The shoot's folder.
        without: A folder that is left out with all in it, as that of the results.
        undescribed: Whether clips count that no `shoot.json` describes yet.

    Raises:
        InputError: There is no such folder, it cannot be read, is itself left out, or holds no take or two
            of one name.
    """
    if not folder.is_dir():
        wrong = "is no folder" if os.path.exists(folder) else "no such folder"
        raise InputError(f"{folder}: {wrong}; a shoot is a folder of takes, or a list of them (.jsonl)")
    left_out = None if without is None else os.path.realpath(without)
    if os.path.realpath(folder) == left_out:
        raise InputError(f"{without}: is the shoot's own folder; name another one, which may lie in it")
    search = _Search(folder, left_out)
    search.look_through(folder, described=undescribed or bool(shoot_files(folder)))
    if not search.takes:
        raise InputError(f"{folder}: {NO_CLIP if undescribed else NO_TAKE}")
    takes = tuple(sorted(search.takes, key=lambda take: take.name))
    check_names(folder, takes)
    return Shoot(folder, takes)


class _Search:
    def __init__(self, folder: Path, left_out: str | None) -> None:
        self.folder = folder
        self.left_out = left_out
        self.takes: list[ShootTake] = []

    def look_through(self, folder: Path, described: bool, depth: int = 0) -> None:
        """Add the takes in a folder and below it; `described`: whether a shoot above tells of mere clips."""
        if os.path.realpath(folder) == self.left_out:
            return
        if depth > DEEPEST:
            raise InputError(
                f"{folder}: lies more than {DEEPEST} folders deep; name a folder nearer to the takes"
            )
        try:
            inside = sorted(file for file in folder.iterdir() if not file.name.startswith("."))
            names = {file.name for file in inside}
            kinds = [(file, file.is_dir(), file.is_symlink()) for file in inside]
        except OSError as error:
            if depth == 0:
                raise InputError(
                    f"{folder}: cannot be read ({error.strerror}); a shoot is a folder of takes"
                ) from error
            self._add(folder)
            return
        described = described or NAME in names
        if OWN in names:
            self._add(folder)
            return
        if RECORD in names and NAME not in names:
            return
        below = [file for file, is_folder, is_link in kinds if is_folder and not is_link]
        videos = [file for file, is_folder, _ in kinds if not is_folder and file.suffix.lower() in VIDEOS]
        if described and not videos and _is_sequence(inside, alone=not below):
            self._add(folder)
            return
        for video in videos if described else ():
            self._add(video)
        for place in below:
            self.look_through(place, described, depth + 1)

    def _add(self, place: Path) -> None:
        way = place.relative_to(self.folder)
        if way.parts and place.is_file():
            way = way.with_name(clip_name(place))
        self.takes.append(ShootTake(name_of_way(way), place))
        if len(self.takes) > MOST_TAKES:
            raise InputError(f"{self.folder}: holds more than {MOST_TAKES} takes; name a folder of fewer")


def _is_sequence(inside: list[Path], alone: bool) -> bool:
    """Whether a folder's images are a clip: all there is, or numbered; else they are stills beside takes."""
    images = [file for file in inside if is_image(file)]
    stems = Counter(stem_of_number(file) for file in images)
    return bool(images) and (alone or any(count > 1 for stem, count in stems.items() if stem is not None))
