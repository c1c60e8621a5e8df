"""Whether a video says that its levels are those of high dynamic range."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Final

_NAMES: Final = {16: "PQ", 18: "HLG"}
"""Transfer characteristics of ITU-T H.273."""
_MP4: Final = re.compile(rb"colrncl[xc].{2}\x00(.)", re.DOTALL)
"""The box of colors in MP4 and QuickTime: primaries, then the transfer, two bytes each."""
_MATROSKA: Final = re.compile(rb"\x55\xba\x81(.)", re.DOTALL)
_MATROSKA_BEGINS: Final = b"\x1a\x45\xdf\xa3"
_HEAD: Final = 2**16
"""Bytes in which Matroska describes its tracks."""
_LARGEST_INDEX: Final = 2**26


def dynamic_range(path: Path) -> str | None:
    """Return the name of the transfer of high dynamic range that a video states, PQ or HLG; else None."""
    try:
        with path.open("rb") as file:
            head = file.read(_HEAD)
            if head.startswith(_MATROSKA_BEGINS):
                found = _MATROSKA.search(head)
            else:
                found = _MP4.search(_movie_box(path))
    except OSError:
        return None
    return None if found is None else _NAMES.get(found[1][0])


def _movie_box(path: Path) -> bytes:
    """Return the box in which MP4 and QuickTime describe their tracks; nothing where there is none."""
    whole = path.stat().st_size
    with path.open("rb") as file:
        while len(head := file.read(8)) == 8:
            size = int.from_bytes(head[:4], "big")
            if size == 1:
                size = int.from_bytes(file.read(8), "big") - 8
            if head[4:] == b"moov":
                return file.read(min(max(size - 8, 0), _LARGEST_INDEX))
            if not 8 <= size <= whole:
                break
            file.seek(size - 8, 1)
    return b""
