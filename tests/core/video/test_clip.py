"""Clips of every kind: order, time stamps, sizes, samples on a budget, and what is said of unusable ones."""

import struct
from pathlib import Path
from types import SimpleNamespace

import cv2
import numpy as np
import pytest
from _drawn_clip import write_video
from keymark.core.errors import InputError
from keymark.core.markers.reading import read_clip
from keymark.core.markers.region_tracks import is_variable_frame_rate
from keymark.core.progress import run
from keymark.core.shoot.check.evidence_check import count_frames
from keymark.core.take.read_footage import clip_notes, picture_count
from keymark.core.video import clip as glancing
from keymark.core.video.clip import Clip, sample_spread_frames
from keymark.core.video.container import quickly_found, read_packets
from keymark.core.video.header import trimmed_s
from keymark.core.video.video_file import VideoFile


def picture(level: int, size: tuple[int, int] = (64, 48)) -> np.ndarray:
    return np.full((size[1], size[0], 3), level, dtype=np.uint8)


LEVELS = [30 + index * 67 % 200 for index in range(600)]
"""Gray levels so far from their neighbors' that the encoder cannot leave a frame out."""


def test_a_video_yields_its_frames_in_order_with_their_times(tmp_path: Path) -> None:
    clip = Clip.open(write_video(tmp_path / "clip.mp4", LEVELS[:30]))
    frames = list(clip.frames())
    assert [index for index, _, _ in frames] == list(range(30))
    np.testing.assert_allclose([time for _, time, _ in frames], np.arange(30) / 25.0, atol=1e-6)
    means = [image.mean() for _, _, image in frames]
    np.testing.assert_allclose(means, LEVELS[:30], atol=8)
    assert clip.size == (64, 48) and clip.fps == pytest.approx(25.0) and clip.frame_count == 30
    assert not is_variable_frame_rate(list(clip.source.time_stamps()))
    np.testing.assert_allclose(list(clip.source.time_stamps()), np.arange(30) / 25.0, atol=1e-6)


@pytest.mark.parametrize(("count", "frames"), [(5, 50), (2, 400), (80, 30)])
def test_samples_are_spread_over_the_clip_and_are_the_frames_they_say(
    tmp_path: Path, count: int, frames: int
) -> None:
    path = write_video(tmp_path / "clip.mp4", LEVELS[:frames], 30.0)
    sampled = list(Clip.open(path).sample(count))
    assert len(sampled) == min(count, frames)
    for index, image in sampled:
        assert image.mean() == pytest.approx(LEVELS[index], abs=8)
    spread = np.diff([index for index, _ in sampled])
    assert spread.min() >= 1 and spread.max() - spread.min() <= 1


def test_images_follow_their_numbers(tmp_path: Path) -> None:
    for number in (10, 2, 1, 33):
        cv2.imwrite(str(tmp_path / f"img_{number}.png"), picture(number))
    (tmp_path / "notes.txt").write_text("no image")
    for path in (tmp_path, tmp_path / "img_2.png", tmp_path / "img_##.png", tmp_path / "img_%04d.png"):
        clip = Clip.open(path, fps=10.0)
        frames = list(clip.frames())
        assert [int(image[0, 0, 0]) for _, _, image in frames] == [1, 2, 10, 33]
        np.testing.assert_allclose([time for _, time, _ in frames], np.arange(4) / 10.0)
        assert clip.frame_count == 4 and clip.size == (64, 48)
    assert [index for index, _ in Clip.open(tmp_path).sample(2)] == [1, 3]


def test_one_of_two_sequences_in_a_folder_is_told_by_its_name(tmp_path: Path) -> None:
    for number in (1, 2):
        cv2.imwrite(str(tmp_path / f"left{number}.png"), picture(10 + number))
        cv2.imwrite(str(tmp_path / f"right{number}.png"), picture(20 + number))
    frames = [int(image[0, 0, 0]) for _, _, image in Clip.open(tmp_path / "right1.png").frames()]
    assert frames == [21, 22]


@pytest.mark.parametrize(
    "image",
    [
        np.full((8, 9), 200, dtype=np.uint8),
        np.full((8, 9, 3), 200 * 257, dtype=np.uint16),
        np.full((8, 9, 4), 200, dtype=np.uint8),
        np.full((8, 9), 200 * 257, dtype=np.uint16),
    ],
    ids=["gray", "16 bit", "alpha", "16 bit gray"],
)
def test_every_depth_and_channel_count_becomes_eight_bit_color(tmp_path: Path, image: np.ndarray) -> None:
    cv2.imwrite(str(tmp_path / "a1.png"), image)
    _, _, frame = next(Clip.open(tmp_path).frames())
    assert frame.dtype == np.uint8 and frame.shape == (8, 9, 3)
    assert (frame == 200).all()


def test_unusable_files_are_named_in_one_sentence_and_the_decoder_is_silent(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    empty = tmp_path / "empty.mp4"
    empty.touch()
    text = tmp_path / "text.mp4"
    text.write_text("this is no video " * 100)
    whole = write_video(tmp_path / "whole.mp4", LEVELS[:10]).read_bytes()
    cut = tmp_path / "cut.mp4"
    cut.write_bytes(whole[:60])
    folder = tmp_path / "folder"
    folder.mkdir()
    broken = tmp_path / "broken1.png"
    broken.write_bytes(b"\x89PNG nothing more")
    cases = {
        tmp_path / "missing.mp4": "no such file",
        tmp_path / "missing_####.png": "no file fits",
        empty: "empty",
        text: "decoded",
        cut: "decoded",
        folder: "no image",
        broken: "decoded",
    }
    for path, word in cases.items():
        with pytest.raises(InputError, match=word) as caught:
            Clip.open(path)
        assert str(path) in str(caught.value) and "\n" not in str(caught.value)
    assert capfd.readouterr().err == ""


def test_the_only_video_beside_a_missing_one_is_named(tmp_path: Path) -> None:
    (tmp_path / "renamed.MOV").touch()
    with pytest.raises(InputError, match=r"image; the only video beside it is 'renamed\.MOV'$"):
        Clip.open(tmp_path / "clip.mp4")
    (tmp_path / "other.mp4").touch()
    with pytest.raises(InputError, match="or a numbered image$"):
        Clip.open(tmp_path / "clip.mp4")


def test_an_image_of_another_size_is_named_when_it_comes(tmp_path: Path) -> None:
    cv2.imwrite(str(tmp_path / "a1.png"), picture(5))
    cv2.imwrite(str(tmp_path / "a2.png"), picture(5, (32, 48)))
    frames = Clip.open(tmp_path).frames()
    next(frames)
    with pytest.raises(InputError, match=r"a2\.png.*32 x 48.*64 x 48"):
        next(frames)


def test_rates_that_are_no_rates_are_refused(tmp_path: Path) -> None:
    cv2.imwrite(str(tmp_path / "a1.png"), picture(5))
    with pytest.raises(InputError, match="fps"):
        Clip.open(tmp_path, fps=-3.0)


@pytest.mark.parametrize(
    ("time_s", "variable"),
    [
        (np.arange(50) / 30.0, False),
        (np.round(np.arange(50) / 30.0, 3), False),
        (np.round(np.arange(50) / 240.0, 3), False),
        (np.delete(np.arange(50), 20) / 30.0, True),
        (np.cumsum(np.random.default_rng(0).uniform(0.02, 0.05, 50)), True),
        (np.array([0.0, 0.04]), False),
        (np.array([]), False),
    ],
    ids=["even", "milliseconds", "fast milliseconds", "dropped frame", "phone", "two frames", "none"],
)
def test_uneven_stamps_are_told_from_rounded_ones(time_s: np.ndarray, variable: bool) -> None:
    assert is_variable_frame_rate(time_s) is variable


SIZE = (64, 48)


@pytest.fixture(scope="module")
def video(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A video of 600 frames that all differ, with a picture to begin decoding at every twelve frames."""
    return write_video(tmp_path_factory.mktemp("glance") / "clip.mp4", LEVELS, 30.0)


@pytest.fixture
def thrifty(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(glancing, "MOST_DECODED_PX", 180 * SIZE[0] * SIZE[1])


@pytest.mark.usefixtures("thrifty")
def test_frames_are_from_all_over_and_what_they_say(video: Path) -> None:
    samples = run(sample_spread_frames(Clip.open(video)))
    assert len(samples.indices) == 11 and samples.size == SIZE
    assert samples.indices[0] == 0 and samples.indices[-1] > 500 and max(np.diff(samples.indices)) < 90
    for index, image in zip(samples.indices, samples.images, strict=True):
        assert image.mean() == pytest.approx(LEVELS[index], abs=8)


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


def trimmed(path: Path, first_s: float, length_s: float) -> Path:
    """A copy that shows a part only, by the edit list of its video, as phones trim."""
    content = bytearray(path.read_bytes())
    header, edit = content.find(b"mdhd"), content.find(b"elst")
    clock = int.from_bytes(content[content.find(b"mvhd") + 16 :][:4], "big")
    rate = int.from_bytes(content[header + 16 :][:4], "big")
    content[edit + 12 : edit + 20] = struct.pack(">Ii", round(clock * length_s), round(rate * first_s))
    copy = path.with_name("trimmed.mp4")
    copy.write_bytes(content)
    return copy


def test_a_clip_trimmed_on_a_phone_is_not_damaged(tmp_path: Path) -> None:
    whole = write_video(tmp_path / "clip.mp4", LEVELS[:60], 30.0)
    assert trimmed_s(whole) is None and not VideoFile(whole).is_trimmed
    path = trimmed(whole, 0.5, 1.0)
    clip = Clip.open(path)
    assert trimmed_s(path) == pytest.approx(1.0) and clip.frame_count == 30 == picture_count(path, 30.0)
    means = [image.mean() for _, _, image in clip.frames()]
    np.testing.assert_allclose(means, LEVELS[15:45], atol=8)
    take = SimpleNamespace(fps=30.0, frame_start=1, clip=path, file=path)
    reading = run(read_clip(clip, ()))
    assert not [note for note in clip_notes(take, clip, reading) if "claims" in note]
    findings = SimpleNamespace(warn=pytest.fail)
    assert count_frames(clip, findings) == 30


@pytest.mark.parametrize("start", [b"elst", b"mdhd", b"mvhd", b"moov"])
def test_an_edit_list_is_not_believed_blindly(tmp_path: Path, start: bytes) -> None:
    path = write_video(tmp_path / "clip.mp4", LEVELS[:10], 30.0)
    content = path.read_bytes()
    at = content.find(start) + 4
    for junk in (b"\xff" * 40, bytes(40), content[at + 4 : at + 44]):
        (tmp_path / "odd.mp4").write_bytes(content[:at] + junk + content[at + 40 :])
        length = trimmed_s(tmp_path / "odd.mp4")
        assert length is None or length > 0.0


def test_images_are_looked_at_too(tmp_path: Path) -> None:
    for index in range(30):
        cv2.imwrite(str(tmp_path / f"{index:04d}.png"), np.full((48, 64, 3), LEVELS[index], dtype=np.uint8))
    samples = run(sample_spread_frames(Clip.open(tmp_path), 5))
    assert samples.indices == (3, 9, 15, 21, 27)
    (tmp_path / "0009.png").write_bytes(b"no image")
    with pytest.raises(InputError, match=r"0009\.png"):
        run(sample_spread_frames(Clip.open(tmp_path), 5))
