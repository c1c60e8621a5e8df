"""Hostile files of other programs: each is read, or refused with one sentence."""

import json
import os
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from _fuzz import FUZZ, files, is_sentence
from _keypoints import (
    BLAZEPOSE33,
    BODY25,
    COCO17,
    FRAMES,
    SIZE,
    coco_value,
    mediapipe_value,
    mmpose_value,
    moving_person,
    openpose_frame,
    write,
    write_openpose,
)
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from keymark.core.detect import detected_frames, detector_formats
from keymark.core.detect.keypoint_file import read_keypoints
from keymark.core.errors import InputError

VALUES: dict[str, Callable[[], Any]] = {
    "mmpose": lambda: mmpose_value(moving_person(COCO17)),
    "mmpose list": lambda: mmpose_value(moving_person(COCO17))["instance_info"],
    "coco": lambda: coco_value(moving_person(COCO17)),
    "mediapipe": lambda: mediapipe_value(moving_person(BLAZEPOSE33, 3)),
    "openpose": lambda: openpose_frame([moving_person(BODY25)[0]]),
}


def read_or_refuse(path: Path, frame_count: int | None, frame_start: int) -> None:
    """Read keypoints; anything but people or one sentence is an error."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            people = read_keypoints(path, frame_count, SIZE, 30.0, frame_start)
        except InputError as error:
            assert is_sentence(" ".join(str(error).split()))
        else:
            assert frame_count is None or len(people.frames) == frame_count
            assert people.most_people > 0


@pytest.mark.parametrize("name", VALUES)
@pytest.mark.fuzz
@settings(max_examples=25 * FUZZ, suppress_health_check=list(HealthCheck))
@given(data=st.data())
def test_any_content_is_read_or_refused(
    tmp_path_factory: pytest.TempPathFactory, name: str, data: st.DataObject
) -> None:
    folder = tmp_path_factory.mktemp("hostile")
    path = folder / "results.json"
    if name == "openpose":
        write_openpose(folder / "json", moving_person(BODY25))
        path = folder / "json" / "clip_000000000003_keypoints.json"
    path.write_bytes(data.draw(files(VALUES[name]())))
    frames = data.draw(st.sampled_from([None, 1, 3, FRAMES, 40_000]))
    read_or_refuse(
        path.parent if name == "openpose" else path, frames, data.draw(st.sampled_from([0, 1, -5, 1001]))
    )


@pytest.mark.fuzz
@settings(max_examples=25 * FUZZ, suppress_health_check=list(HealthCheck))
@given(
    numbers=st.sets(st.one_of(st.integers(0, 20), st.integers(0, 10**15)), min_size=1, max_size=6),
    data=st.data(),
)
def test_any_numbers_of_files_are_read_or_refused(
    tmp_path_factory: pytest.TempPathFactory, numbers: set[int], data: st.DataObject
) -> None:
    folder = tmp_path_factory.mktemp("numbers")
    for number in numbers:
        write(folder / f"clip{number}.json", openpose_frame([moving_person(BODY25)[0]]))
    read_or_refuse(folder, data.draw(st.sampled_from([None, 5, 21, 40_000])), data.draw(st.integers(-3, 30)))


@pytest.mark.parametrize("kind", ["pipe", "device", "folder", "loop"])
def test_special_files_in_a_folder_do_not_block(tmp_path: Path, kind: str) -> None:
    folder = write_openpose(tmp_path / "json", moving_person(BODY25))
    path = folder / "clip_000000000003_keypoints.json"
    path.unlink()
    try:
        if kind == "pipe":
            os.mkfifo(path)
        elif kind == "folder":
            path.mkdir()
        else:
            path.symlink_to({"device": Path("/dev/zero"), "loop": path}[kind])
    except (OSError, AttributeError, NotImplementedError):
        pytest.skip("this system has no such thing")
    with pytest.raises(InputError, match="000003_keypoints"):
        read_keypoints(folder, FRAMES, SIZE)


def test_all_points_together_are_bounded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(detected_frames, "MOST_POINTS", 5 * BODY25.count)
    folder = write_openpose(tmp_path / "json", moving_person(BODY25))
    (folder / "clip_000000000009_keypoints.json").write_text("never read", encoding="utf-8")
    with pytest.raises(InputError, match="has 150 points in all frames; at most 125"):
        read_keypoints(folder, FRAMES, SIZE)
    path = write(tmp_path / "results.json", coco_value(moving_person(COCO17)))
    with pytest.raises(InputError, match="has 136 points"):
        read_keypoints(path, FRAMES, SIZE)


def test_numbered_files_are_bounded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(detector_formats, "MOST_FRAMES", 5)
    with pytest.raises(InputError, match="more than 5 numbered files"):
        read_keypoints(write_openpose(tmp_path / "json", moving_person(BODY25)), FRAMES, SIZE)


def test_names_with_control_characters_reach_no_sentence_on_people(tmp_path: Path) -> None:
    path = tmp_path / "evil\x1b[31m\u202e.json"
    path.write_text(json.dumps(coco_value(moving_person(COCO17))), encoding="utf-8")
    assert read_keypoints(path, FRAMES, SIZE).source == "evil?[31m?.json"
