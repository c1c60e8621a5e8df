"""What is given to decoders: footage, not what leads to other files, and not more than can be meant."""

import os
import struct
import zlib
from pathlib import Path

import cv2
import pytest
from _drawn_clip import write_video
from keymark.core import MOST_PIXELS
from keymark.core.errors import InputError
from keymark.core.video import image_sequence
from keymark.core.video.clip import Clip
from keymark.core.video.container import check_container, check_pixels
from keymark.core.video.image_sequence import read_image

SIZE, GRAYS = (64, 48), range(0, 240, 40)


@pytest.fixture(scope="module")
def outside(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_video(tmp_path_factory.mktemp("elsewhere") / "private.avi", GRAYS, code="MJPG")


def playlists(target: Path) -> dict[str, str]:
    hls = f"#EXTM3U\n#EXT-X-TARGETDURATION:9\n#EXTINF:1.0,\n{target}\n#EXT-X-ENDLIST\n"
    return {
        "HLS": hls,
        "HLS by address": hls.replace(str(target), f"file://{target}"),
        "HLS from the network": hls.replace(str(target), "http://127.0.0.1:9/x.ts"),
        "list to be joined": "ffconcat version 1.0\nfile inside.avi\n",
        "list with a path": f"ffconcat version 1.0\nfile '{target}'\n",
        "session": "v=0\no=- 0 0 IN IP4 127.0.0.1\ns=x\nc=IN IP4 127.0.0.1\nt=0 0\nm=video 5004 RTP/AVP 96\n",
        "DASH": f'<?xml version="1.0"?><MPD profiles="x"><BaseURL>{target}</BaseURL></MPD>',
        "Windows": f'<asx version="3.0"><entry><ref href="{target}"/></entry></asx>',
        "redirection": f"RTSPtext\nrtsp://127.0.0.1:9/{target.name}",
    }


@pytest.mark.parametrize("ending", ["mp4", "avi", "mkv", "m3u8", "ffconcat", "sdp", "mov"])
@pytest.mark.parametrize("kind", sorted(playlists(Path("x"))))
def test_a_playlist_is_no_clip_whatever_it_is_called(
    kind: str, ending: str, outside: Path, tmp_path: Path
) -> None:
    (tmp_path / "inside.avi").symlink_to(outside)
    clip = tmp_path / f"clip.{ending}"
    clip.write_text(playlists(outside)[kind], encoding="utf-8")
    with pytest.raises(InputError, match="holds text and must be a video.*no playlist"):
        Clip.open(clip)


def test_this_decoder_does_follow_a_playlist(outside: Path, tmp_path: Path) -> None:
    (tmp_path / "inside.avi").symlink_to(outside)
    clip = tmp_path / "clip.mp4"
    clip.write_text(playlists(outside)["list to be joined"], encoding="utf-8")
    assert cv2.VideoCapture(str(clip), cv2.CAP_FFMPEG).isOpened()


@pytest.mark.parametrize(
    "name", ["a:b.avi", "file:clip.avi", "concat:x.avi", "http:clip.avi", "clip %03d.avi"]
)
def test_a_name_is_no_protocol(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    if os.name == "nt" and ":" in name:
        pytest.skip("no file is called so here")
    write_video(tmp_path / "plain.avi", GRAYS, code="MJPG").rename(tmp_path / name)
    monkeypatch.chdir(tmp_path)
    assert Clip.open(name).size == SIZE


@pytest.mark.parametrize(
    "beginning",
    [
        b"G" + bytes(187) + b"G" + bytes(187),
        bytes(4) + b"G" + bytes(191) + b"G" + bytes(191),
        b"\x00\x00\x01\xba",
        b"\x00\x00\x00\x01\x67",
        b"\x06\x0e\x2b\x34\x02\x05\x01\x01\x0d\x01\x02",
        b"RIFF\x00\x00\x00\x00AVI LIST",
        b"\x00\x00\x00\x08wide\x00\x00",
        b"YUV4MPEG2 W64",
    ],
)
def test_containers_that_opencv_cannot_write_are_known(beginning: bytes, tmp_path: Path) -> None:
    (tmp_path / "clip").write_bytes(beginning)
    check_container(tmp_path / "clip")
    (tmp_path / "shifted").write_bytes(b"x" + beginning)
    with pytest.raises(InputError, match="shifted: cannot be decoded; it holds"):
        check_container(tmp_path / "shifted")


@pytest.mark.parametrize(
    "content", [b"RIFF\x00\x00\x00\x00WAVEfmt ", b"PK\x03\x04zip", b"\x7fELF", bytes(400), b"GG"]
)
def test_other_files_are_refused(content: bytes, tmp_path: Path) -> None:
    (tmp_path / "clip.mp4").write_bytes(content)
    with pytest.raises(InputError, match=r"clip\.mp4: cannot be decoded; it holds"):
        Clip.open(tmp_path / "clip.mp4")


def test_pictures_have_a_largest_size(tmp_path: Path) -> None:
    check_pixels(tmp_path, 7680, 4320)
    with pytest.raises(InputError, match=f"at most {MOST_PIXELS} pixels"):
        check_pixels(tmp_path, 20000, 20000)


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
    monkeypatch.setattr(image_sequence, "MOST_FRAMES", 5)
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
