"""Discovery of takes: those below a folder, those of a list, or one clip."""

import os
from collections import Counter
from pathlib import Path

from ...errors import InputError
from ...footage.clips.image_sequence import is_image, stem_of_number
from ...take.conversion_record import RECORD_FILE
from ...take.description import TAKE_FILE, clip_name
from ...take.shoot_file import SHOOT_FILE, find_shoot_files
from ..shoot import MOST_TAKES, Shoot, ShootTake
from .take_list import ENDING, read_take_list
from .take_names import check_names, take_name

VIDEOS = frozenset({".avi", ".m4v", ".mkv", ".mov", ".mp4", ".mpeg", ".mpg", ".mts", ".mxf", ".webm", ".wmv"})
NO_TAKE = (
    f"holds no take; a take is a folder with {TAKE_FILE}, or a clip with a {SHOOT_FILE}, "
    "which keymark new writes"
)
NO_CLIP = "holds no clip; a clip is a video or a folder of numbered images"
DEEPEST = 64
"""Levels of folders that are searched: more are a cycle in the file system."""


def open_shoot(path: Path, excluded: Path | None = None) -> Shoot:
    """Find the takes of a shoot as the command line names it; their files are not read yet.

    Args:
        path: A folder of takes or one take, a list of takes (.jsonl), or one video.
        excluded: A folder that is not searched, as that of the results.

    Raises:
        InputError: There is no such shoot, it cannot be read, it has no take, or two takes of one name.
    """
    if path.suffix.lower() == ENDING and not path.is_dir():
        return read_take_list(path)
    if path.suffix.lower() in VIDEOS and path.is_file():
        takes = (ShootTake(take_name(Path(path.stem)), path),)
        check_names(path, takes)
        return Shoot(path, takes)
    return find_takes(path, excluded)


def find_takes(folder: Path, excluded: Path | None = None, undescribed: bool = False) -> Shoot:
    """Find every take below a folder.

    Takes are folders with `take.json`, and, where a `shoot.json` describes them, videos and folders of
    images. Takes, hidden folders, results of a conversion and links to folders are not searched. A folder
    that cannot be read counts as a take that will fail: it may hold some.

    Args:
        folder: The shoot's folder.
        excluded: A folder that is not searched, as that of the results.
        undescribed: Whether clips count that no `shoot.json` describes yet.

    Raises:
        InputError: There is no such folder, it cannot be read, is itself excluded, or holds no take or two
            of one name.
    """
    if not folder.is_dir():
        wrong = "is no folder" if os.path.exists(folder) else "no such folder"
        raise InputError(f"{folder}: {wrong}; a shoot is a folder of takes, or a list of them (.jsonl)")
    real_excluded = None if excluded is None else os.path.realpath(excluded)
    if os.path.realpath(folder) == real_excluded:
        raise InputError(f"{excluded}: is the shoot's own folder; name another one, which may lie in it")
    search = _Search(folder, real_excluded)
    search.visit(folder, described=undescribed or bool(find_shoot_files(folder)))
    if not search.takes:
        raise InputError(f"{folder}: {NO_CLIP if undescribed else NO_TAKE}")
    takes = tuple(sorted(search.takes, key=lambda take: take.name))
    check_names(folder, takes)
    return Shoot(folder, takes)


class _Search:
    """A depth-first search for takes."""

    def __init__(self, folder: Path, excluded: str | None) -> None:
        self.folder = folder
        self.excluded = excluded
        self.takes: list[ShootTake] = []

    def visit(self, folder: Path, described: bool, depth: int = 0) -> None:
        """Add the takes in a folder and below it; `described`: whether a `shoot.json` describes clips."""
        if os.path.realpath(folder) == self.excluded:
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
        described = described or SHOOT_FILE in names
        if TAKE_FILE in names:
            self._add(folder)
            return
        if RECORD_FILE in names and SHOOT_FILE not in names:
            return
        below = [file for file, is_folder, is_link in kinds if is_folder and not is_link]
        videos = [file for file, is_folder, _ in kinds if not is_folder and file.suffix.lower() in VIDEOS]
        if described and not videos and _is_sequence(inside, alone=not below):
            self._add(folder)
            return
        for video in videos if described else ():
            self._add(video)
        for child in below:
            self.visit(child, described, depth + 1)

    def _add(self, path: Path) -> None:
        relative = path.relative_to(self.folder)
        if relative.parts and path.is_file():
            relative = relative.with_name(clip_name(path))
        self.takes.append(ShootTake(take_name(relative), path))
        if len(self.takes) > MOST_TAKES:
            raise InputError(f"{self.folder}: holds more than {MOST_TAKES} takes; name a folder of fewer")


def _is_sequence(inside: list[Path], alone: bool) -> bool:
    """Whether a folder's images are a clip: its only content, or numbered; else they are stills."""
    images = [file for file in inside if is_image(file)]
    stems = Counter(stem_of_number(file) for file in images)
    return bool(images) and (alone or any(count > 1 for stem, count in stems.items() if stem is not None))
