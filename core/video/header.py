"""What the header of a video says beside its pictures: pixels, dynamic range, trimming, lens, and its turn.

MP4 and QuickTime are boxes, each of which begins with its length and its type, four bytes each (ISO/IEC
14496-12); `moov` describes the tracks. A box `meta`, of the movie or of a track, lists names in `keys`, and
in `ilst` their values by number (QuickTime File Format, Metadata).
"""

import math
import os
import re
import shutil
import struct
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import BinaryIO

import cv2

from ..errors import InputError

LARGEST_MOVIE_BYTES = 64 * 2**20
"""Of the index, which grows with the number of frames: hours have less."""
MOST_OBLONG = 4.0
"""Of pixels; widths beyond it are faults of the file."""
HDR_TRANSFERS = {16: "PQ", 18: "HLG"}  # transfer characteristics of ITU-T H.273
MP4 = re.compile(rb"colrncl[xc].{2}\x00(.)", re.DOTALL)
"""The color box of MP4 and QuickTime: primaries, then transfer characteristics, two bytes each."""
MATROSKA = re.compile(rb"\x55\xba\x81(.)", re.DOTALL)
Content = memoryview
NOTHING = Content(b"")
DAMAGED = (OSError, struct.error, ValueError, LookupError, ZeroDivisionError)
FOCAL_LENGTH = b"com.apple.quicktime.camera.focal_length.35mm_equivalent"
SHORTEST_MM, LONGEST_MM = 5.0, 1000.0
TEXT, FLOATS = 1, {23: ">f", 24: ">d"}
"""Well-known types of values; those of whole numbers are all others that are read here."""


def pixel_shape(capture: cv2.VideoCapture) -> float:
    """How many times as wide as high the pixels of an open video are, turned as it asks for; 1 if square."""
    across, down = capture.get(cv2.CAP_PROP_SAR_NUM), capture.get(cv2.CAP_PROP_SAR_DEN)
    shape = across / down if across > 0.0 and down > 0.0 else 1.0
    if abs(shape - 1.0) < 0.01 or not 1.0 / MOST_OBLONG <= shape <= MOST_OBLONG:
        return 1.0
    return 1.0 / shape if capture.get(cv2.CAP_PROP_ORIENTATION_META) % 180 else shape


def dynamic_range_note(path: Path) -> str | None:
    """A sentence on a video of high dynamic range."""
    transfer = None
    with suppress(*DAMAGED), path.open("rb") as file:
        start = file.read(2**16)  # Matroska describes its tracks within these
        is_matroska = start.startswith(b"\x1a\x45\xdf\xa3")
        found = MATROSKA.search(start) if is_matroska else MP4.search(_movie(file)[1])
        transfer = HDR_TRANSFERS.get(found[1][0]) if found else None
    if transfer is None:
        return None
    return (
        f"{path.name} is of high dynamic range ({transfer}): read as it is, its colors are pale and "
        "markers harder to tell apart; film in standard range or convert it, and pick the markers' "
        "colors anew"
    )


def trimmed_s(path: Path) -> float | None:
    """The time [s] that a trimmed video shows of all its pictures; None where it shows them all.

    Phones trim MP4 and QuickTime by an edit list alone (ISO/IEC 14496-12, 8.6.6): the pictures before and
    after stay in the file, are counted by it, and are never shown.
    """
    with suppress(*DAMAGED), path.open("rb") as file:
        _, movie = _movie(file)
        clock, _ = _timing(dict(_boxes(movie))[b"mvhd"])
        for track, media in _video_tracks(movie):
            edits = dict(_boxes(track.get(b"edts", NOTHING))).get(b"elst", NOTHING)
            rate, whole = _timing(media[b"mdhd"])
            form = ">QqI" if bytes(edits[:1]) == b"\x01" else ">IiI"  # duration, where it begins, rate
            count = struct.unpack_from(">I", edits, 4)[0] if edits else 0
            starts = [8 + number * struct.calcsize(form) for number in range(min(count, 1000))]
            parts = [struct.unpack_from(form, edits, start) for start in starts]
            shown = sum(duration for duration, begins, _ in parts if begins >= 0) / clock
            # A frame or two at the ends are left out by encoders, whose first pictures come late.
            return shown if 0.0 < shown < whole / rate - 0.1 else None
    return None


def _timing(header: Content) -> tuple[int, int]:
    """Time scale and duration in a header of a movie or a track's media."""
    form, at = (">IQ", 20) if bytes(header[:1]) == b"\x01" else (">II", 12)
    scale, duration = struct.unpack_from(form, header, at)
    return int(scale), int(duration)


def stated_lens_mm(path: Path) -> float | None:
    """The full-frame equivalent of the lens by the picture's diagonal [mm]; None where nothing states it."""
    with suppress(*DAMAGED), path.open("rb") as file:
        _, movie = _movie(file)
        metas = [movie, *(inside for kind, inside in _boxes(movie) if kind == b"trak")]
        for holder in metas:
            for kind, inside in _boxes(holder):
                value = _value(inside) if kind == b"meta" else None
                if value is not None and SHORTEST_MM <= value <= LONGEST_MM:
                    return value
    return None


def _movie(file: BinaryIO) -> tuple[int, Content]:
    """Where the content of the box `moov` begins, and a copy of it; empty where the file has none."""
    at, stop = 0, file.seek(0, os.SEEK_END)
    while at + 8 <= stop:
        file.seek(at)
        head = file.read(16)
        length, kind = struct.unpack(">I4s", head[:8])
        begin = 8
        if length == 1:
            length, begin = struct.unpack(">Q", head[8:16])[0], 16
        length = stop - at if length == 0 else length
        if length < begin:
            break
        if kind == b"moov":
            file.seek(at + begin)
            return at + begin, memoryview(bytearray(file.read(min(length - begin, LARGEST_MOVIE_BYTES))))
        at += length
    return 0, NOTHING


def _boxes(data: Content) -> Iterator[tuple[bytes, Content]]:
    """The boxes in a box, by type and content."""
    at = 0
    while at + 8 <= len(data):
        length, kind = struct.unpack_from(">I4s", data, at)
        if length < 8:
            return
        yield kind, data[at + 8 : at + length]
        at += length


def _video_tracks(movie: Content) -> Iterator[tuple[dict[bytes, Content], dict[bytes, Content]]]:
    """The boxes of each track of pictures, and those of its media."""
    for track in (dict(_boxes(content)) for kind, content in _boxes(movie) if kind == b"trak"):
        media = dict(_boxes(track.get(b"mdia", NOTHING)))
        if bytes(media.get(b"hdlr", NOTHING)[8:12]) == b"vide":
            yield track, media


def _value(meta: Content) -> float | None:
    inside = dict(_boxes(meta))
    if b"keys" not in inside:
        inside = dict(_boxes(meta[4:]))  # in MP4 version and flags come first
    keys, values = inside.get(b"keys", NOTHING), inside.get(b"ilst", NOTHING)
    names = [bytes(name) for _, name in _boxes(keys[8:])]  # after version, flags and count
    if FOCAL_LENGTH not in names:
        return None
    wanted = struct.pack(">I", names.index(FOCAL_LENGTH) + 1)
    item = dict(_boxes(values)).get(wanted, NOTHING)
    data = bytes(dict(_boxes(item)).get(b"data", NOTHING))
    kind, raw = struct.unpack_from(">I", data)[0], data[8:]
    if kind == TEXT:
        return float(raw.decode("ascii").lower().removesuffix("mm").strip())
    if kind in FLOATS:
        return float(struct.unpack(FLOATS[kind], raw)[0])
    return float(int.from_bytes(raw[:8], "big"))


TURNS = (0, 90, 180, 270)  # degrees clockwise
ENDINGS = (".mp4", ".mov", ".m4v")
MATRIX = {0: 40, 1: 52}
"""Where a track's header has its matrix, by the version of the box (ISO/IEC 14496-12, 8.3.2)."""
MATRIX_AND_SIZE = ">9i2I"
ONE, SMALL_ONE = 2.0**16, 2.0**30  # fixed point of the matrix: 16.16, its last column 2.30


def can_turn(path: Path) -> bool:
    """Whether a file is one whose header may turn it."""
    with suppress(*DAMAGED), path.open("rb") as file:
        return path.suffix.lower() in ENDINGS and bool(_matrices(_movie(file)[1]))
    return False


def write_turned(path: Path, turn_deg: int, copy: Path) -> None:
    """Write a copy of an MP4 or QuickTime file that is shown turned clockwise, 90, 180 or 270 degrees more.

    Raises:
        InputError: It is no such file, or its header cannot be read.
    """
    if not can_turn(path):
        turn = {90: "transpose=1", 180: "hflip,vflip", 270: "transpose=2"}[turn_deg]
        raise InputError(
            f"{path}: is no MP4 or QuickTime file, whose header can turn it; turn it first, as with "
            f"ffmpeg -i CLIP -vf {turn} turned.mp4"
        )
    shutil.copyfile(path, copy)
    os.chmod(copy, 0o644)
    with copy.open("r+b") as file:
        begin, movie = _movie(file)
        for place in _matrices(movie):
            *matrix, width, height = struct.unpack(MATRIX_AND_SIZE, place)
            before_deg = math.degrees(math.atan2(matrix[1], matrix[0]))
            turned_deg = round((before_deg + turn_deg) / 90.0) * 90 % 360
            cos, sin = (round(part(math.radians(turned_deg))) for part in (math.cos, math.sin))
            moved = {0: (0, 0), 90: (height, 0), 180: (width, height), 270: (0, width)}[turned_deg]
            values = (cos * ONE, sin * ONE, 0, -sin * ONE, cos * ONE, 0, moved[0], moved[1], SMALL_ONE)
            struct.pack_into(">9i", place, 0, *map(int, values))
        file.seek(begin)
        file.write(movie)


def _matrices(movie: Content) -> list[Content]:
    """Where the header of each track of pictures has their matrix and fixed point size."""
    headers = [track[b"tkhd"] for track, _ in _video_tracks(movie) if b"tkhd" in track]
    length = struct.calcsize(MATRIX_AND_SIZE)
    places = [header[(at := MATRIX[header[0]]) : at + length] for header in headers]
    return [place for place in places if len(place) == length]
