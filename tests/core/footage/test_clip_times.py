"""Times of a clip's frames: one pass a session, and another where the file has changed."""

import os
import shutil
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
from _boot import ROOT
from keymark.core.footage.clips.clip import Clip
from keymark.core.footage.clips.video_file import VideoFile
from keymark.core.footage.reading import MOST_CLIPS, clip_times, read_clip, reading_key
from keymark.core.footage.region_tracks import MarkerStyle
from keymark.core.progress import run

DEMO = ROOT / "presets" / "demo" / "aerobic"


@pytest.fixture
def passes(monkeypatch: pytest.MonkeyPatch) -> list[Path]:
    """The clips that are decoded for their times, one entry a pass."""
    seen: list[Path] = []
    decode = VideoFile.time_stamps

    def counted(video: VideoFile):  # noqa: ANN202
        seen.append(video.path)
        return decode(video)

    monkeypatch.setattr(VideoFile, "time_stamps", counted)
    return seen


@pytest.fixture
def clip(tmp_path: Path) -> Path:
    return Path(shutil.copy(DEMO / "clip.mp4", tmp_path))


def test_a_clip_is_decoded_once_for_its_times(clip: Path, passes: list[Path]) -> None:
    first, second = (run(clip_times(Clip.open(clip))) for _ in range(2))
    assert passes == [clip]
    np.testing.assert_array_equal(first, list(Clip.open(clip).source.time_stamps()))
    np.testing.assert_array_equal(second, first)
    assert len(first) > 1


def test_a_clip_that_has_changed_is_decoded_again(clip: Path, passes: list[Path]) -> None:
    first = run(clip_times(Clip.open(clip)))
    video = cv2.VideoWriter(str(clip), cv2.VideoWriter.fourcc(*"mp4v"), 30.0, (64, 48))
    for level in range(0, 100, 10):
        video.write(np.full((48, 64, 3), level, dtype=np.uint8))
    video.release()
    assert len(run(clip_times(Clip.open(clip)))) == 10 != len(first)
    assert passes == [clip, clip]


def test_a_reading_of_the_clip_knows_its_times(clip: Path, passes: list[Path]) -> None:
    """The same to the last digit; a reading of another file, or of other markers, is not asked."""
    opened = Clip.open(clip)
    reading = run(read_clip(opened, (), with_album=False))
    style = MarkerStyle("trunk", "trunk", (70, 106, 213))
    found = run(clip_times(opened, reading))
    assert passes == []
    np.testing.assert_array_equal(found, list(opened.source.time_stamps()))
    os.utime(clip, (1, 1))
    run(clip_times(opened, reading))
    os.utime(clip, (2, 2))
    run(clip_times(opened, replace(reading, key=reading_key(clip, opened.fps, (style,), None))))
    assert passes == [clip] * 3  # one of them just now, to compare


def test_a_pass_that_was_broken_off_leaves_nothing(clip: Path, passes: list[Path]) -> None:
    broken = clip_times(Clip.open(clip))
    next(broken)
    broken.close()
    assert len(run(clip_times(Clip.open(clip)))) > 1
    assert len(passes) == 2


def test_only_the_last_clips_are_remembered(clip: Path, tmp_path: Path, passes: list[Path]) -> None:
    others = [tmp_path / f"{number}.mp4" for number in range(MOST_CLIPS)]
    for number, other in enumerate(others):
        other.write_bytes(clip.read_bytes())
        os.utime(other, (100 + number, 100 + number))  # the fingerprint has the time
    for path in (clip, *others, clip):
        run(clip_times(Clip.open(path)))
    assert passes == [clip, *others, clip]
