"""A shoot: the takes below a folder, or those of a list."""

import os
import unicodedata
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path, PurePath, PurePosixPath
from typing import Any

from ..errors import InputError, shown
from ..files.fields import COMMENT_PREFIX, Fields
from ..files.json_file import parse_json
from ..files.kinds import safe_path
from ..files.paths import VIDEOS, check_symlinks, regular_file_size
from ..take.conversion_record import RECORD_FILE, find_record
from ..take.description import (
    SETTING_FIELDS,
    SHARED_FIELDS,
    SHOOT_FILE,
    TAKE_FILE,
    Description,
    clip_name,
    describe,
    find_shoot_files,
)
from ..video.image_sequence import is_image, stem_of_number

MOST_TAKES, DEEPEST = 100_000, 64


@dataclass(frozen=True, eq=False)
class ShootTake:
    """One take of a shoot; none of its files has been read yet."""

    name: str
    """Its path from the shoot's folder, with slashes, without a clip's ending; also that of its results."""
    path: Path
    """The take's folder, or a bare clip."""
    overrides: Mapping[str, Any] | None = None
    """Fields in a line of a list, which override all files."""
    overrides_location: str = ""

    def describe(self) -> Description:
        """Merge all files that describe the take."""
        return describe(self.path, self.overrides, self.overrides_location)


@dataclass(frozen=True, eq=False)
class Shoot:
    """Takes that are converted together."""

    path: Path
    takes: tuple[ShootTake, ...]
    """In the order of their names, each name once."""

    @property
    def folder(self) -> Path:
        """The folder that the takes' names are relative to."""
        return self.path if self.path.is_dir() else self.path.parent


RESERVED = (".keymark", "summary.html", "summary.jsonl")
"""Files and folders that a batch itself writes into the folder of the results."""


def take_name(path: PurePath) -> str:
    """The name of a take from its path relative to the shoot: with slashes, and always valid text."""
    return path.as_posix().encode("utf-8", "backslashreplace").decode("utf-8")


def check_output(shoot: Shoot, output: Path) -> None:
    """Refuse an output folder in which results would lie among the takes."""
    target = Path(os.path.realpath(output))
    if target.exists() and not target.is_dir():
        raise InputError(f"{output}: is a file; the output must be a folder, new or old")
    if target == Path(os.path.realpath(shoot.folder)):
        raise InputError(f"{output}: is the shoot's own folder; name another one, which may lie in it")
    paths = [Path(os.path.realpath(take.path)) for take in shoot.takes]
    taken = {folder for path in paths for folder in (path, *path.parents)}
    for take in shoot.takes:
        if target / take.name in taken:
            raise InputError(
                f"{output}: the results of {shown(take.name)} would lie in {target / take.name}, which holds "
                "takes; name another folder"
            )


def _folded(name: str) -> str:
    """A name as the least discerning file system compares it: Windows drops dots and spaces at ends."""
    parts = [part.rstrip(". ") or part for part in name.split("/")]
    return unicodedata.normalize("NFC", "/".join(parts)).casefold()


LARGEST_BYTES = 64 * 2**20
LONGEST_LINE_BYTES = 2**20
TAKE_FIELD = "take"
KNOWN_FIELDS = (TAKE_FIELD, "clip", "frame_count", "keyframes", *SHARED_FIELDS, *SETTING_FIELDS)


def read_take_list(path: Path) -> Shoot:
    """Read a list of takes; the values of their fields are checked where each take uses them.

    Raises:
        InputError: The list cannot be read, is too large or holds no take; or a line is no object, or has
            an unknown field, a path outside the folder or the name of another take.
    """
    valid = "a list of takes in UTF-8, one JSON object a line"
    regular_file_size(path, valid)
    try:
        with path.open("rb") as file:
            content = file.read(LARGEST_BYTES + 1)
        if len(content) > LARGEST_BYTES:
            raise InputError(f"{path}: is longer than {LARGEST_BYTES // 2**20} MiB; it must be {valid}")
        lines = content.decode("utf-8-sig").split("\n")
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else error
        raise InputError(f"{path}: cannot be read ({reason}); it must be {valid}") from error
    numbered = [(number, line) for number, line in enumerate(lines, 1) if line.strip()]
    if len(numbered) > MOST_TAKES:
        raise InputError(f"{path}: lists more than {MOST_TAKES} takes; make several lists of it")
    if not numbered:
        raise InputError(f'{path}: lists no take; it must hold lines such as {{"take": "day1/clip01.mp4"}}')
    return _shoot(path, [_listed_take(path, f"{path}, line {number}", line) for number, line in numbered])


def _listed_take(path: Path, where: str, line: str) -> ShootTake:
    if len(line) > LONGEST_LINE_BYTES:
        raise InputError(f"{where}: has {len(line)} characters; at most {LONGEST_LINE_BYTES} are read")
    values: dict[str, Any] = parse_json(line, where)
    fields, valid = Fields(values, where), "a path inside the list's folder, as in day1/clip01.mp4"
    fields.refuse_others([*KNOWN_FIELDS, *(name for name in values if name.startswith(COMMENT_PREFIX))])
    take = safe_path(fields, TAKE_FIELD, path.parent, valid)
    check_symlinks([take], [path.parent])
    relative = take.relative_to(path.parent)
    if not relative.parts:
        raise InputError(f"{where}: {TAKE_FIELD} is {shown(values[TAKE_FIELD])}; it must be {valid}")
    if os.path.isfile(take):  # which is false for an impossible file name, too
        relative = relative.with_name(clip_name(take))
    overrides = {name: value for name, value in values.items() if name != TAKE_FIELD}
    return ShootTake(take_name(relative), take, overrides, where)


def _shoot(path: Path, takes: Sequence[ShootTake]) -> Shoot:
    """A shoot of takes whose results lie in folders of their own on any file system, none below another."""
    known: dict[str, ShootTake] = {}
    for take in takes:
        if _folded(take.name.split("/")[0]) in RESERVED:
            raise InputError(
                f"{take.path}: its results would lie where a batch keeps its own {take.name.split('/')[0]}; "
                "rename it"
            )
        twin = known.setdefault(_folded(take.name), take)
        if twin is not take:
            raise InputError(
                f"{path}: the takes {shown(str(twin.path))} and {shown(str(take.path))} have one name, "
                f"{shown(take.name)}, and their results would lie in one folder; rename one of them"
            )
    for take in takes:
        for parent in PurePosixPath(_folded(take.name)).parents:
            above = known.get(str(parent))
            if above is not None and above is not take:
                raise InputError(
                    f"{path}: the results of {shown(str(take.path))} would lie among those of "
                    f"{shown(str(above.path))}; rename one of them"
                )
    return Shoot(path, tuple(sorted(takes, key=lambda take: take.name)))


def open_shoot(path: Path, excluded: Path | None = None) -> Shoot:
    """Find the takes of a folder, a list (.jsonl) or one video; their files are not read yet."""
    if path.suffix.lower() == ".jsonl" and not path.is_dir():
        return read_take_list(path)
    if path.suffix.lower() in VIDEOS and path.is_file():
        return _shoot(path, [ShootTake(take_name(Path(path.stem)), path)])
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
    found: list[Path] = []
    described = undescribed or bool(find_shoot_files(folder))
    for path in _paths_below(folder, folder, real_excluded, described):
        found.append(path)
        if len(found) > MOST_TAKES:
            raise InputError(f"{folder}: holds more than {MOST_TAKES} takes; name a folder of fewer")
    if not found:
        if undescribed:
            raise InputError(f"{folder}: holds no clip; a clip is a video or a folder of numbered images")
        raise InputError(
            f"{folder}: holds no take; a take is a folder with {TAKE_FILE}, or a clip with a {SHOOT_FILE}, "
            "which keymark new writes"
        )
    takes = []
    for path in found:
        relative = path.relative_to(folder)
        if relative.parts and path.is_file():
            relative = relative.with_name(clip_name(path))
        takes.append(ShootTake(take_name(relative), path))
    return _shoot(folder, takes)


def _paths_below(top: Path, folder: Path, excluded: str | None, described: bool) -> Iterator[Path]:
    """The takes in a folder and below it; `described`: whether a `shoot.json` describes clips."""
    if os.path.realpath(folder) == excluded:
        return
    if len(folder.relative_to(top).parts) > DEEPEST:  # a cycle in the file system
        raise InputError(
            f"{folder}: lies more than {DEEPEST} folders deep; name a folder nearer to the takes"
        )
    try:
        inside = sorted(file for file in folder.iterdir() if not file.name.startswith("."))
        names = {file.name for file in inside}
        kinds = [(file, file.is_dir(), file.is_symlink()) for file in inside]
    except OSError as error:
        if folder == top:
            reason = f"cannot be read ({error.strerror})"
            raise InputError(f"{folder}: {reason}; a shoot is a folder of takes") from error
        yield folder
        return
    described = described or SHOOT_FILE in names
    if TAKE_FILE in names:
        if folder == top or RECORD_FILE not in names or not is_result_take(folder):
            yield folder
        return
    if RECORD_FILE in names and SHOOT_FILE not in names:
        return
    below = [file for file, is_folder, is_link in kinds if is_folder and not is_link]
    videos = [file for file, is_folder, _ in kinds if not is_folder and file.suffix.lower() in VIDEOS]
    # Images are a clip where they are a folder's only content, or numbered; else they are stills.
    images = [file for file in inside if is_image(file)]
    stems = Counter(stem_of_number(image) for image in images)
    numbered = any(count > 1 for stem, count in stems.items() if stem is not None)
    if described and not videos and images and (numbered or not below):
        yield folder
        return
    yield from videos if described else ()
    for child in below:
        yield from _paths_below(top, child, excluded, described)


def is_result_take(folder: Path) -> bool:
    """Whether a conversion has made the take in a folder, as where it found the camera: it is a result."""
    with suppress(InputError):
        record = find_record(folder)
        return record is not None and TAKE_FILE in record.files
    return False


def take_path(file: Path) -> Path:
    """The path of a file's take: the folder of a `take.json`, the clip of a `NAME.take.json`, else itself."""
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
    """Refuse a folder in which a new `take.json` would hide takes: inside a take no other is searched."""
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
