"""High dynamic range: the transfer characteristics stated in a video's header."""

import re
from pathlib import Path

NAMES = {16: "PQ", 18: "HLG"}
"""Transfer characteristics of ITU-T H.273."""
MP4 = re.compile(rb"colrncl[xc].{2}\x00(.)", re.DOTALL)
"""The color box of MP4 and QuickTime: primaries, then transfer characteristics, two bytes each."""
MATROSKA = re.compile(rb"\x55\xba\x81(.)", re.DOTALL)
MATROSKA_BEGINS = b"\x1a\x45\xdf\xa3"
HEAD = 2**16
"""Bytes read of a Matroska file, within which it describes its tracks."""
LARGEST_INDEX = 2**26


def dynamic_range(path: Path) -> str | None:
    """Name of a video's high dynamic range transfer function, PQ or HLG; None for standard range."""
    try:
        with path.open("rb") as file:
            head = file.read(HEAD)
            if head.startswith(MATROSKA_BEGINS):
                found = MATROSKA.search(head)
            else:
                found = MP4.search(_movie_box(path))
    except OSError:
        return None
    return None if found is None else NAMES.get(found[1][0])


def _movie_box(path: Path) -> bytes:
    """The `moov` box of MP4 and QuickTime, which describes the tracks; empty if there is none."""
    whole = path.stat().st_size
    with path.open("rb") as file:
        while len(head := file.read(8)) == 8:
            size = int.from_bytes(head[:4], "big")
            if size == 1:
                size = int.from_bytes(file.read(8), "big") - 8
            if head[4:] == b"moov":
                return file.read(min(max(size - 8, 0), LARGEST_INDEX))
            if not 8 <= size <= whole:
                break
            file.seek(size - 8, 1)
    return b""
