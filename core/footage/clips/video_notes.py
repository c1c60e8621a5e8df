"""Notes on a video file's header: non-square pixels and high dynamic range."""

import re
from pathlib import Path

import cv2

NOTICEABLE_SHAPE = 0.01
"""Difference from square pixels that is worth a note."""
HDR_TRANSFERS = {16: "PQ", 18: "HLG"}
"""Transfer characteristics of ITU-T H.273."""
MP4 = re.compile(rb"colrncl[xc].{2}\x00(.)", re.DOTALL)
"""The color box of MP4 and QuickTime: primaries, then transfer characteristics, two bytes each."""
MATROSKA = re.compile(rb"\x55\xba\x81(.)", re.DOTALL)
MATROSKA_BEGINS = b"\x1a\x45\xdf\xa3"
HEAD = 2**16
"""Bytes read of a Matroska file, within which it describes its tracks."""
LARGEST_INDEX = 2**26


def video_notes(path: Path, capture: cv2.VideoCapture) -> tuple[str, ...]:
    """Sentences on faults of an open video."""
    return (*_shape_notes(path, capture), *_range_notes(path))


def _shape_notes(path: Path, capture: cv2.VideoCapture) -> tuple[str, ...]:
    across, down = capture.get(cv2.CAP_PROP_SAR_NUM), capture.get(cv2.CAP_PROP_SAR_DEN)
    if not (across > 0.0 and down > 0.0) or abs(across / down - 1.0) < NOTICEABLE_SHAPE:
        return ()
    return (
        (
            f"the pixels of {path.name} are {across / down:.3g} times as wide as high, and Keymark and "
            "Blender take them for square: the motion is out of shape; convert the clip first, as with "
            "ffmpeg -i CLIP -vf scale=iw*sar:ih,setsar=1"
        ),
    )


def _range_notes(path: Path) -> tuple[str, ...]:
    transfer = dynamic_range(path)
    if transfer is None:
        return ()
    return (
        (
            f"{path.name} is of high dynamic range ({transfer}): read as it is, its colors are pale and "
            "markers harder to tell apart; film in standard range or convert it, and pick the markers' "
            "colors anew"
        ),
    )


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
    return None if found is None else HDR_TRANSFERS.get(found[1][0])


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
