"""A copy of a video that is shown turned: its header alone says so, and no picture is coded anew."""

import math
import os
import shutil
import struct
from contextlib import suppress
from pathlib import Path

from ..errors import InputError
from .header import DAMAGED, boxes_at

TURNS = (0, 90, 180, 270)  # degrees clockwise
ENDINGS = (".mp4", ".mov", ".m4v")
MATRIX = {0: 40, 1: 52}
"""Where a track's header has its matrix, by the version of the box (ISO/IEC 14496-12, 8.3.2)."""
ONE, SMALL_ONE = 2.0**16, 2.0**30  # fixed point of the matrix: 16.16, its last column 2.30


def can_turn(path: Path) -> bool:
    """Whether a file is one whose header may turn it."""
    return path.suffix.lower() in ENDINGS and bool(_matrices(path))


def write_turned(path: Path, turn_deg: int, copy: Path) -> None:
    """Write a copy of an MP4 or QuickTime file that is shown turned clockwise, 90, 180 or 270 degrees more.

    Raises:
        InputError: It is no such file, or its header cannot be read.
    """
    places = _matrices(path) if can_turn(path) else []
    if not places:
        turn = {90: "transpose=1", 180: "hflip,vflip", 270: "transpose=2"}[turn_deg]
        raise InputError(
            f"{path}: is no MP4 or QuickTime file, whose header can turn it; turn it first, as with "
            f"ffmpeg -i CLIP -vf {turn} turned.mp4"
        )
    shutil.copyfile(path, copy)
    os.chmod(copy, 0o644)
    with copy.open("r+b") as file:
        for at, matrix, (width, height) in places:
            before_deg = math.degrees(math.atan2(matrix[1], matrix[0]))
            turned_deg = round((before_deg + turn_deg) / 90.0) * 90 % 360
            cos, sin = (round(part(math.radians(turned_deg))) for part in (math.cos, math.sin))
            moved = {0: (0, 0), 90: (height, 0), 180: (width, height), 270: (0, width)}[turned_deg]
            values = (cos * ONE, sin * ONE, 0, -sin * ONE, cos * ONE, 0, moved[0], moved[1], SMALL_ONE)
            file.seek(at)
            file.write(struct.pack(">9i", *map(int, values)))


def _matrices(path: Path) -> list[tuple[int, tuple[int, ...], tuple[int, int]]]:
    """Place, matrix and fixed point size of the pictures of each video track."""
    found = []
    with suppress(*DAMAGED), path.open("rb") as file:
        for track, track_end in boxes_at(file, b"moov", b"trak"):
            media = next(boxes_at(file, b"mdia", b"hdlr", within=(track, track_end)), None)
            header = next(boxes_at(file, b"tkhd", within=(track, track_end)), None)
            if media is None or header is None:
                continue
            file.seek(media[0] + 8)
            if file.read(4) != b"vide":
                continue
            file.seek(header[0])
            content = file.read(header[1] - header[0])
            at = MATRIX[content[0]]
            *matrix, width, height = struct.unpack_from(">9i2I", content, at)
            found.append((header[0] + at, tuple(matrix), (width, height)))
    return found
