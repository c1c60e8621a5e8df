"""Magic numbers of video containers: no other file is given to a decoder.

Decoders look at content, not at names. A text called `clip.mp4` may be a playlist (HLS, a list of files to be
joined, a session description), which makes them open other files or the network. All of these are text; none
begins like the containers and streams here.
"""

from pathlib import Path

from ... import MOST_PIXELS
from ...errors import InputError
from ...files.regular_file import regular_file_size

HEAD_BYTES = 4096
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
"""Packet lengths of MPEG transport streams, and the offset of the sync byte in a packet."""


def check_container(path: Path) -> None:
    """Refuse files that are no video container.

    Args:
        path: A supposed video file.

    Raises:
        InputError: It is missing, no regular file, empty, or does not begin like a video.
    """
    if regular_file_size(path, VALID) == 0:
        raise InputError(f"{path}: the file is empty; it must be a video")
    try:
        with path.open("rb") as file:
            beginning = file.read(HEAD_BYTES)
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror}); it must be {VALID}") from error
    if not _begins_as_video(beginning):
        what = "text" if _is_text(beginning[:512]) else "data of another kind"
        raise InputError(
            f"{path}: cannot be decoded; it holds {what} and must be {VALID}, no playlist or other file"
        )


def check_pixels(path: Path, width: float, height: float) -> None:
    """Refuse pictures larger than `MOST_PIXELS`.

    Raises:
        InputError: The picture is too large.
    """
    if width * height > MOST_PIXELS:
        raise InputError(
            f"{path}: its pictures have {width:.0f} x {height:.0f} pixels; at most {MOST_PIXELS} pixels, as "
            "in 16384 x 8192, are read"
        )


def _begins_as_video(data: bytes) -> bool:
    return (
        data[4:8] in BOXES
        or data.startswith(BEGINNINGS)
        or (data[:4] in (b"RIFF", b"RIFX") and data[8:12] in RIFF)
        or any(_is_transport(data[start::length]) for length, start in TRANSPORT)
    )


def _is_transport(marks: bytes) -> bool:
    """Whether the bytes at the offsets of sync bytes are sync bytes."""
    return bool(marks) and marks[:5] == b"G" * min(len(marks), 5) and len(marks) > 1


def _is_text(data: bytes) -> bool:
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        text = data[: error.start].decode("utf-8-sig")
        if error.start < len(data) - 4:  # not merely cut within a character
            return False
    return all(letter.isprintable() or letter.isspace() for letter in text)
