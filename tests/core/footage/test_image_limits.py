"""Images that claim more than they hold, and folders with more than can be meant."""

import struct
import zlib
from pathlib import Path

import pytest
from keymark.core.errors import InputError
from keymark.core.footage.clips import image_sequence
from keymark.core.footage.clips.clip import Clip
from keymark.core.footage.clips.image_sequence import read_image


def png(width: int, height: int) -> bytes:

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    parts = (chunk(b"IHDR", header), chunk(b"IDAT", zlib.compress(bytes(10_000))), chunk(b"IEND", b""))
    return b"\x89PNG\r\n\x1a\n" + b"".join(parts)


@pytest.mark.parametrize(
    "size", [(60_000, 60_000), (20_000, 20_000), (2**31 - 1, 1), (2**31 - 1, 2**31 - 1), (0, 9)]
)
def test_an_image_that_claims_gigabytes_is_refused(size: tuple[int, int], tmp_path: Path) -> None:
    (tmp_path / "bomb.png").write_bytes(png(*size))
    with pytest.raises(InputError, match=r"bomb\.png: cannot be decoded.*at most 134217728 pixels"):
        read_image(tmp_path / "bomb.png")


def test_a_folder_of_too_many_images_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(image_sequence, "MOST_IMAGES", 5)
    for number in range(6):
        (tmp_path / f"{number}.png").touch()
    with pytest.raises(InputError, match="holds more than 5 images"):
        Clip.open(tmp_path)
    with pytest.raises(InputError, match="holds more than 5 images"):
        Clip.open(tmp_path / "#.png")


def test_digits_that_are_no_number_are_letters(tmp_path: Path) -> None:
    for name in ("m\u00b2.png", "2.png", "\u0663.png"):
        (tmp_path / name).write_bytes(b"")
    with pytest.raises(InputError, match="cannot be decoded|sequence"):
        Clip.open(tmp_path)
