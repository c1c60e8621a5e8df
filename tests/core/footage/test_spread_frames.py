"""Sampling of clips that are too long or too large to decode, and the packets of their files."""

from pathlib import Path

import cv2
import numpy as np
import pytest
from _footage import encode, write_numbered_take
from keymark.core.errors import InputError
from keymark.core.footage.clips import clip as glancing
from keymark.core.footage.clips.clip import Clip, sample_spread_frames
from keymark.core.footage.clips.container import quickly_found, read_packets
from keymark.core.footage.region_tracks import is_variable_frame_rate
from keymark.core.progress import run

SIZE = (64, 48)


def level(index: int) -> int:
    return 30 + index * 67 % 200


@pytest.fixture(scope="module")
def video(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A video of 600 frames that all differ, with a picture to begin decoding at every twelve frames."""
    path = Path(tmp_path_factory.mktemp("glance")) / "clip.mp4"
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*"mp4v"), 30.0, SIZE)
    for index in range(600):
        writer.write(np.full((SIZE[1], SIZE[0], 3), level(index), dtype=np.uint8))
    writer.release()
    return path


@pytest.fixture
def thrifty(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(glancing, "MOST_DECODED_PX", 180 * SIZE[0] * SIZE[1])


@pytest.mark.usefixtures("thrifty")
def test_frames_are_from_all_over_and_what_they_say(video: Path) -> None:
    samples = run(sample_spread_frames(Clip.open(video)))
    assert len(samples.indices) == 11 and samples.size == SIZE
    assert samples.indices[0] == 0 and samples.indices[-1] > 500 and max(np.diff(samples.indices)) < 90
    for index, image in zip(samples.indices, samples.images, strict=True):
        assert image.mean() == pytest.approx(level(index), abs=8)


def test_what_can_be_gone_through_is(video: Path) -> None:
    samples = run(sample_spread_frames(Clip.open(video), 6))
    assert samples.indices == (50, 150, 250, 350, 450, 550)


@pytest.mark.usefixtures("thrifty")
def test_of_what_cannot_be_searched_the_beginning_is_looked_at(
    video: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(glancing, "quickly_found", lambda path, wanted: [])
    samples = run(sample_spread_frames(Clip.open(video)))
    assert len(samples.indices) > 5 and samples.indices[-1] < 181


@pytest.mark.usefixtures("thrifty")
def test_a_cut_off_file_is_looked_at_as_far_as_it_goes(video: Path, tmp_path: Path) -> None:
    whole = encode_with_index_first(video, tmp_path / "whole.mp4")
    cut = tmp_path / "cut.mp4"
    cut.write_bytes(whole.read_bytes()[: whole.stat().st_size * 2 // 3])
    clip = Clip.open(cut)
    packets = read_packets(cut)
    assert packets is not None and packets.complete and 200 < len(packets.time_s) < clip.frame_count == 600
    samples = run(sample_spread_frames(clip))
    assert len(samples.indices) > 3 and samples.indices[-1] < len(packets.time_s)
    assert quickly_found(cut, [590]) == []


def encode_with_index_first(video: Path, path: Path) -> Path:
    from _footage import ffmpeg

    ffmpeg("-i", video, "-c", "copy", "-movflags", "+faststart", path)
    return path


def test_packets_tell_frames_and_times(video: Path, tmp_path: Path) -> None:
    packets = read_packets(video)
    assert packets is not None and packets.complete and len(packets.time_s) == 600
    np.testing.assert_allclose(packets.time_s, np.arange(600) / 30.0, atol=1e-3)
    some = read_packets(video, 100)
    assert some is not None and not some.complete and len(some.time_s) == 100
    (tmp_path / "text.mp4").write_text("no video", encoding="utf-8")
    assert read_packets(tmp_path / "text.mp4") is None and quickly_found(tmp_path / "text.mp4", [3]) == []


def test_packets_tell_an_uneven_rate(tmp_path: Path) -> None:
    take = write_numbered_take(tmp_path / "take", 20)
    uneven = encode(take, tmp_path / "uneven.mkv", "-vf", "select='not(eq(mod(n,7),3))'", "-fps_mode", "vfr")
    even = encode(take, tmp_path / "even.mp4")
    for path, varies in ((uneven, True), (even, False)):
        packets = read_packets(path)
        assert packets is not None and is_variable_frame_rate(packets.time_s) is varies


def test_images_are_looked_at_too(tmp_path: Path) -> None:
    for index in range(30):
        cv2.imwrite(str(tmp_path / f"{index:04d}.png"), np.full((48, 64, 3), level(index), dtype=np.uint8))
    samples = run(sample_spread_frames(Clip.open(tmp_path), 5))
    assert samples.indices == (3, 9, 15, 21, 27)
    (tmp_path / "0009.png").write_bytes(b"no image")
    with pytest.raises(InputError, match=r"0009\.png"):
        run(sample_spread_frames(Clip.open(tmp_path), 5))
