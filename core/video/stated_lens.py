"""The focal length that a phone states in its video: Apple's metadata in the boxes of QuickTime and MP4.

A box begins with its length and its type, four bytes each (ISO/IEC 14496-12). A box `meta`, of the movie or
of a track, lists names in `keys`, and in `ilst` their values by number (QuickTime File Format, Metadata).
"""

import struct
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

FOCAL_LENGTH = b"com.apple.quicktime.camera.focal_length.35mm_equivalent"
LARGEST_MOVIE_BYTES = 64 * 2**20
"""Of the index, which grows with the number of frames: hours have less."""
SHORTEST_MM, LONGEST_MM = 5.0, 1000.0
TEXT, FLOATS = 1, {23: ">f", 24: ">d"}
"""Well-known types of values; those of whole numbers are all others that are read here."""


def stated_lens_mm(path: Path) -> float | None:
    """The full-frame equivalent of the lens by the picture's diagonal [mm]; None where nothing states it."""
    with suppress(OSError, struct.error, ValueError, IndexError):
        movie = _movie(path)
        metas = [movie, *(inside for kind, inside in _boxes(movie) if kind == b"trak")]
        for holder in metas:
            for kind, inside in _boxes(holder):
                value = _value(inside) if kind == b"meta" else None
                if value is not None and SHORTEST_MM <= value <= LONGEST_MM:
                    return value
    return None


def _movie(path: Path) -> bytes:
    """The content of the box `moov`; empty where the file has none."""
    size = path.stat().st_size if path.is_file() else 0
    with path.open("rb") as file:
        at = 0
        while at + 8 <= size:
            file.seek(at)
            head = file.read(16)
            length, kind = struct.unpack(">I4s", head[:8])
            begin = 8
            if length == 1:
                length, begin = struct.unpack(">Q", head[8:16])[0], 16
            length = size - at if length == 0 else length
            if length < begin:
                break
            if kind == b"moov":
                file.seek(at + begin)
                return file.read(min(length - begin, LARGEST_MOVIE_BYTES))
            at += length
    return b""


def _boxes(data: bytes) -> Iterator[tuple[bytes, bytes]]:
    """The boxes in a box, by type and content."""
    at = 0
    while at + 8 <= len(data):
        length, kind = struct.unpack_from(">I4s", data, at)
        if length < 8:
            return
        yield kind, data[at + 8 : at + length]
        at += length


def _value(meta: bytes) -> float | None:
    inside = dict(_boxes(meta)) or {}
    if b"keys" not in inside:
        inside = dict(_boxes(meta[4:]))  # in MP4 version and flags come first
    keys, values = inside.get(b"keys", b""), inside.get(b"ilst", b"")
    names = [name[4:] if name.startswith(b"mdta") else name for name in _names(keys)]
    if FOCAL_LENGTH not in names:
        return None
    wanted = struct.pack(">I", names.index(FOCAL_LENGTH) + 1)
    item = dict(_boxes(values)).get(wanted, b"")
    data = dict(_boxes(item)).get(b"data", b"")
    kind, raw = struct.unpack_from(">I", data)[0], data[8:]
    if kind == TEXT:
        return float(raw.decode("ascii").lower().removesuffix("mm").strip())
    if kind in FLOATS:
        return float(struct.unpack(FLOATS[kind], raw)[0])
    return float(int.from_bytes(raw[:8], "big"))


def _names(keys: bytes) -> Iterator[bytes]:
    at = 8  # after version, flags and count
    while at + 8 <= len(keys):
        length = struct.unpack_from(">I", keys, at)[0]
        if length < 8:
            return
        yield keys[at + 4 : at + length]
        at += length
