"""Lists of takes, as JSON Lines: each line has `take`, a path, and may override fields of `take.json`."""

import os
from pathlib import Path
from typing import Any

from ...errors import InputError
from ...files.fields import Fields
from ...files.inherited_fields import COMMENT_PREFIX
from ...files.json_file import parse_json, shown
from ...files.regular_file import regular_file_size
from ...files.safe_path import check_symlinks, safe_path
from ...take.description import clip_name
from ...take.shoot_file import SETTING_FIELDS, SHARED_FIELDS
from ..shoot import MOST_TAKES, Shoot, ShootTake
from .take_names import check_names, take_name

ENDING = ".jsonl"
LARGEST_BYTES = 64 * 2**20
LONGEST_LINE_BYTES = 2**20
TAKE_FIELD = "take"
TAKE_VALID = "a path inside the list's folder, as in day1/clip01.mp4"
KNOWN_FIELDS = (TAKE_FIELD, "clip", "frame_count", "keyframes", *SHARED_FIELDS, *SETTING_FIELDS)


def read_take_list(path: Path) -> Shoot:
    """Read a list of takes; the values of their fields are checked where each take uses them.

    Args:
        path: The list, UTF-8. Takes are relative to its folder, paths in a take's own fields to the take's.

    Raises:
        InputError: The list cannot be read, is too large or holds no take; or a line is no object, or has an
            unknown field, a path outside the folder or the name of another take.
    """
    takes: list[ShootTake] = []
    for number, line in enumerate(_lines(path), 1):
        if not line.strip():
            continue
        takes.append(_take(path, f"{path}, line {number}", line))
        if len(takes) > MOST_TAKES:
            raise InputError(f"{path}: lists more than {MOST_TAKES} takes; make several lists of it")
    if not takes:
        raise InputError(f'{path}: lists no take; it must hold lines such as {{"take": "day1/clip01.mp4"}}')
    check_names(path, takes)
    return Shoot(path, tuple(sorted(takes, key=lambda take: take.name)))


def _lines(path: Path) -> list[str]:
    valid = "it must be a list of takes in UTF-8, one JSON object a line"
    regular_file_size(path, "a list of takes in UTF-8, one JSON object a line")
    try:
        with path.open("rb") as file:
            content = file.read(LARGEST_BYTES + 1)
        if len(content) > LARGEST_BYTES:
            raise InputError(f"{path}: is longer than {LARGEST_BYTES // 2**20} MiB; {valid}")
        lines = content.decode("utf-8-sig").split("\n")
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror}); {valid}") from error
    except ValueError as error:
        raise InputError(f"{path}: cannot be read ({error}); {valid}") from error
    return lines


def _take(path: Path, where: str, line: str) -> ShootTake:
    if len(line) > LONGEST_LINE_BYTES:
        raise InputError(f"{where}: has {len(line)} characters; at most {LONGEST_LINE_BYTES} are read")
    values: dict[str, Any] = parse_json(line, where)
    fields = Fields(values, where)
    fields.refuse_others([*KNOWN_FIELDS, *(name for name in values if name.startswith(COMMENT_PREFIX))])
    take = safe_path(fields, TAKE_FIELD, path.parent, TAKE_VALID)
    check_symlinks([take], [path.parent])
    relative = take.relative_to(path.parent)
    if not relative.parts:
        raise InputError(f"{where}: {TAKE_FIELD} is {shown(values[TAKE_FIELD])}; it must be {TAKE_VALID}")
    if os.path.isfile(take):  # which is false for an impossible file name, too
        relative = relative.with_name(clip_name(take))
    overrides = {name: value for name, value in values.items() if name != TAKE_FIELD}
    return ShootTake(take_name(relative), take, overrides, where)
