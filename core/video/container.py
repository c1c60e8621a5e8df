"""Workarounds for OpenCV: log messages on standard error, and rows that it leaves uninitialized."""

import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np

from .. import MOST_PIXELS
from ..arrays import Array, Image
from ..errors import InputError
from ..files.paths import regular_file_size

DEEP_YUV420 = b"Y3\x0b"  # FFmpeg's code for planar 4:2:0 YCbCr of more than eight bits; the bit depth follows
ROWS = 3


@contextmanager
def opencv_silence() -> Iterator[None]:
    """Suppress OpenCV's log, so that standard error has our one sentence alone."""
    level = cv2.getLogLevel()
    cv2.setLogLevel(0)
    try:
        yield
    finally:
        cv2.setLogLevel(level)


def fill_last_rows(capture: cv2.VideoCapture, image: Image) -> None:
    """Repeat the last written row in the uninitialized rows below it, in place.

    OpenCV 4.11 does not write the last three rows of pictures of more than eight bits in 4:2:0 whose height
    is no multiple of 16, such as phones' 1080 rows: their content differs from run to run. The image is
    rotated as the file asks for.
    """
    code = int(capture.get(cv2.CAP_PROP_CODEC_PIXEL_FORMAT)) & 0xFFFFFFFF
    name = code.to_bytes(4, "little")
    if name[:3] != DEEP_YUV420 or name[3] <= 8:
        return
    turned = int(capture.get(cv2.CAP_PROP_ORIENTATION_META)) // 90
    coded = np.rot90(image, turned)
    if coded.shape[0] % 16 and coded.shape[0] > ROWS:  # coded rows are a multiple
        coded[-ROWS:] = coded[-ROWS - 1]


VALID = "a video that OpenCV can read"

BOXES = (
    *(b"ftyp", b"moov", b"mdat", b"free", b"skip", b"wide", b"pnot"),
    *(b"styp", b"uuid", b"moof", b"udta", b"prfl", b"PICT", b"junk"),
)
"""MP4 and QuickTime: types of the first box, which follow its size."""
BEGINNINGS = (
    b"\x1a\x45\xdf\xa3",  # Matroska, WebM
    b"\x30\x26\xb2\x75\x8e\x66\xcf\x11",  # ASF, WMV
    b"\x00\x00\x01",  # MPEG program streams, and raw MPEG-1, -2, -4, H.264, H.265
    b"\x00\x00\x00\x01",  # the same with a longer start code
    b"FLV",
    b"OggS",
    b"DKIF",  # IVF
    b"nut/multimedia container\x00",
    b"YUV4MPEG2 ",
    b"GIF8",
    b"\x89PNG\r\n\x1a\n",  # animated PNG
    b"\xff\xd8\xff",  # Motion JPEG without a container
    b"\x1f\x07\x00",  # DV
    b"\x12\x00\x0a",  # AV1 without a container
    b".RMF",
    b"BBCD",  # Dirac
    b"\x06\x0e\x2b\x34\x02\x05\x01\x01\x0d\x01\x02",  # MXF
)
RIFF = (b"AVI ", b"AVIX")
TRANSPORT = ((188, 0), (192, 4), (204, 0))
"""Packet lengths of MPEG transport streams, and the offset of the sync byte, G, in a packet."""


def check_container(path: Path) -> None:
    """Refuse files that are missing, irregular, empty, or do not begin like a video container."""
    if regular_file_size(path, VALID) == 0:
        raise InputError(f"{path}: the file is empty; it must be a video")
    try:
        with path.open("rb") as file:
            beginning = file.read(4096)
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror}); it must be {VALID}") from error
    known = beginning[4:8] in BOXES or beginning.startswith(BEGINNINGS)
    riff = beginning[:4] in (b"RIFF", b"RIFX") and beginning[8:12] in RIFF
    sync = (beginning[start::length][:5] for length, start in TRANSPORT)
    if not known and not riff and not any(len(mark) > 1 and set(mark) == {ord("G")} for mark in sync):
        what = "text" if _is_text(beginning[:512]) else "data of another kind"
        raise InputError(
            f"{path}: cannot be decoded; it holds {what} and must be {VALID}, no playlist or other file"
        )


def check_pixels(path: Path, width: float, height: float) -> None:
    """Refuse pictures larger than `MOST_PIXELS`."""
    if width * height > MOST_PIXELS:
        raise InputError(
            f"{path}: its pictures have {width:.0f} x {height:.0f} pixels; at most {MOST_PIXELS} pixels, as "
            "in 16384 x 8192, are read"
        )


def _is_text(data: bytes) -> bool:
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        text = data[: error.start].decode("utf-8-sig")
        if error.start < len(data) - 4:  # not merely cut within a character
            return False
    return all(letter.isprintable() or letter.isspace() for letter in text)


MOST_PACKETS = 20_000  # packets read of a longer file: ten minutes tell whether the frame rate varies
SEARCH_BEGINS = 16  # frames before a wanted one from which OpenCV seeks backwards for a video keyframe


@dataclass(frozen=True, eq=False)
class Packets:
    """Presentation times of a video file's first pictures."""

    time_s: Array  # (N,) time of each picture, ascending
    complete: bool  # whether these are all of the file's pictures


def read_packets(path: Path, most: int = MOST_PACKETS) -> Packets | None:
    """Read the times of a file's pictures; None if its packets cannot be read."""
    times: list[float] = []
    with _packets(path) as capture:
        while len(times) < most and capture.grab():
            times.append(float(capture.get(cv2.CAP_PROP_POS_MSEC)) / 1000.0)
    if not times or not np.isfinite(times).all():
        return None
    return Packets(np.sort(np.array(times)), len(times) < most)


def quickly_found(path: Path, wanted: Sequence[int]) -> list[int]:
    """Indices near the wanted ones, ascending, that can be decoded with few other frames.

    Frames beyond the file's actual end are left out.
    """
    found = set()
    with _packets(path) as capture:
        for index in wanted:
            if not capture.set(cv2.CAP_PROP_POS_FRAMES, index):
                continue
            begins = int(capture.get(cv2.CAP_PROP_POS_FRAMES))
            # So that seeking never meets the end.
            if 0 <= begins <= index and all(capture.grab() for _ in range(SEARCH_BEGINS + 2)):
                found.add(begins + SEARCH_BEGINS)
    return sorted(found)


@contextmanager
def _packets(path: Path) -> Iterator[cv2.VideoCapture]:
    capture = cv2.VideoCapture()
    with opencv_silence():
        try:
            capture.open(os.path.abspath(path), cv2.CAP_FFMPEG, [cv2.CAP_PROP_FORMAT, -1])
            yield capture
        finally:
            capture.release()
