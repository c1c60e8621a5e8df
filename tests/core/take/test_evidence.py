"""Evidence of a take: markers, keypoints, hints of depth and contours, each of which may be missing."""

import json
from pathlib import Path
from typing import Any

import pytest
from _synthetic_take import (
    CAMERA,
    MATRIX_WORLD,
    edit_json,
    true_postures,
    write_keypoints,
    write_synthetic_take,
)
from keymark.core.errors import InputError
from keymark.core.take.conversion_settings import MOST_KEYPOINT_FILES
from keymark.core.take.description import describe
from keymark.core.take.evidence import CONTOURS, DEPTH_HINTS, EVIDENCE, KEYPOINTS, MARKERS
from keymark.core.take.read_footage import check_frame_count, open_clip
from keymark.core.take.take import Take, check_method, evidence_of
from keymark.core.take.take_file import read_take, write_take

FRAMES = 16
MOVING = {**CAMERA, "matrix_world": None, "matrix_world_frames": FRAMES * [MATRIX_WORLD]}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return write_synthetic_take(tmp_path / "take", FRAMES)


def hinted(folder: Path, name: str = "keypoints.json") -> Path:
    path = write_keypoints(folder / name, true_postures(FRAMES))
    points = len(json.loads(path.read_text(encoding="utf-8"))["names"])
    return write_keypoints(path, true_postures(FRAMES), world=FRAMES * [points * [[0.1, 0.2, 0.3]]])


def marked(take: Take) -> bool:
    return len(take.markers) == 5


@pytest.mark.parametrize("markers", [None, {}])
def test_markers_may_be_missing(folder: Path, markers: object) -> None:
    edit_json(folder / "take.json", markers=None)
    edit_json(folder / "take.json", **({} if markers is None else {"markers": markers}))
    assert evidence_of(read_take(folder)) == (CONTOURS,)


def test_a_missing_clip_that_keypoints_need_is_told_with_the_takes_file(folder: Path) -> None:
    hinted(folder)
    edit_json(folder / "take.json", frame_count=None, clip="elsewhere.mp4")
    with pytest.raises(
        InputError, match=r"take.json: frame_count is not given, and .*elsewhere.mp4: no such"
    ):
        read_take(folder)


def test_evidence_names_what_is_used(folder: Path) -> None:
    hinted(folder)
    edit_json(folder / "take.json", evidence=["contours", "keypoints"])
    take = read_take(folder)
    assert evidence_of(take) == (KEYPOINTS, CONTOURS) and take.markers == ()
    assert evidence_of(read_take(folder, whole=True)) == EVIDENCE
    assert describe(folder).settings.evidence == (CONTOURS, KEYPOINTS)
    edit_json(folder / "take.json", evidence=["markers"])
    (folder / "keypoints.json").write_text("no JSON", encoding="utf-8")
    take = read_take(folder)
    assert evidence_of(take) == (MARKERS,) and marked(take) and not take.contours


def test_a_camera_that_moves_has_no_contours(folder: Path) -> None:
    edit_json(folder / "take.json", camera=MOVING)
    assert evidence_of(read_take(folder)) == (MARKERS,)
    edit_json(folder / "take.json", markers=None)
    with pytest.raises(InputError, match=r"take\.json: has nothing to follow, neither markers nor keypoints"):
        read_take(folder)
    assert evidence_of(read_take(folder, whole=True)) == ()
    write_keypoints(folder / "keypoints.json", true_postures(FRAMES))
    assert evidence_of(read_take(folder)) == (KEYPOINTS,)


@pytest.mark.parametrize(
    ("fields", "sentence"),
    [
        (
            {"evidence": ["keypoints"]},
            "names keypoints, which this take has not got .*it has markers, contours",
        ),
        ({"evidence": ["markers"], "markers": None}, r"names markers, .*\(markers must say which are worn\)"),
        ({"evidence": ["contours"], "camera": MOVING}, "need a camera that stands still.*it has markers"),
        (
            {"evidence": ["sound"]},
            r"evidence\[0\] is 'sound'; it must be one of markers, keyp",
        ),
        ({"evidence": []}, "evidence has 0 of them; it must be a list of 1 to 4 kinds of evidence"),
        ({"evidence": "markers"}, "evidence is 'markers'; it must be a list"),
        ({"evidence": ["markers", "markers"]}, "evidence names the kind 'markers' twice"),
        ({"evidence": ["markers", "depth_hints"]}, "depth_hints, guesses for keypoints, without these"),
        ({"keypoints": "../keypoints.json"}, "it must be a file or folder inside the take's folder"),
        ({"keypoints": "/etc/passwd"}, "it must be a file or folder inside the take's folder"),
        ({"keypoints": ["keypoints.json", 3]}, r"keypoints\[1\] is 3; it must be"),
        ({"keypoints": []}, "keypoints has 0 of them; it must be a list of 1 to 16 files"),
        (
            {"keypoints": (MOST_KEYPOINT_FILES + 1) * ["k.json"]},
            "keypoints has 17 of them; it must be a list of 1 to 16 files",
        ),
        ({"keypoints": ["k.json", "./k.json"]}, "keypoints names a file twice"),
        ({"keypoints": "missing.json"}, r"missing\.json: "),
    ],
)
def test_a_mistake_in_the_evidence_is_one_sentence(folder: Path, fields: Any, sentence: str) -> None:
    edit_json(folder / "take.json", **fields)
    with pytest.raises(InputError, match=sentence) as caught:
        read_take(folder)
    assert str(folder) in str(caught.value) and "\n" not in str(caught.value)


def test_hints_that_no_file_has_are_missed(folder: Path) -> None:
    write_keypoints(folder / "keypoints.json", true_postures(FRAMES))
    edit_json(folder / "take.json", evidence=["keypoints", "depth_hints"])
    with pytest.raises(
        InputError, match="names depth_hints, .*none of its files of keypoints guesses depths"
    ):
        read_take(folder)


def _nobody(value: dict[str, Any]) -> None:
    value["frames"] = [None] * len(value["frames"])


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (lambda v: v.update(layout="coco19"), "layout"),
        (lambda v: v.update(size=[120, 160]), "size"),
        (lambda v: v.update(fps=25, frames=v["frames"][: FRAMES * 5 // 6]), "frames"),
        (lambda v: v.update(frames=v["frames"] * 2), f"{2 * FRAMES} frames"),
        (lambda v: v["frames"].clear(), "frames"),
        (lambda v: v["frames"][3].pop(), r"frames\[3\]"),
        (_nobody, "nobody"),
    ],
    ids=["layout", "size", "rate", "count", "empty", "points", "nobody"],
)
def test_keypoints_of_another_clip_are_one_sentence(folder: Path, change: Any, sentence: str) -> None:
    path = write_keypoints(folder / "keypoints.json", true_postures(FRAMES))
    edit_json(path, change)
    with pytest.raises(InputError, match=sentence) as caught:
        read_take(folder)
    assert "keypoints.json: " in str(caught.value) and "\n" not in str(caught.value)


def test_a_clip_without_a_count_is_counted_for_its_keypoints(folder: Path) -> None:
    edit_json(folder / "take.json", frame_count=None)
    write_keypoints(folder / "keypoints.json", true_postures(FRAMES))
    assert open_clip(read_take(folder)).frame_count == FRAMES
    write_keypoints(folder / "keypoints.json", true_postures(FRAMES // 2))
    with pytest.raises(InputError, match=rf"keypoints\.json: has {FRAMES // 2} frames, the clip {FRAMES}"):
        read_take(folder)


def test_a_clip_that_is_shorter_than_it_claims_has_other_keypoints(folder: Path) -> None:
    write_keypoints(folder / "keypoints.json", true_postures(FRAMES))
    edit_json(folder / "take.json", frame_count=None)
    take = read_take(folder)
    check_frame_count(take, FRAMES)
    with pytest.raises(InputError, match=rf"keypoints of {FRAMES} frames; frames has 10; it claims 16"):
        check_frame_count(take, 10, FRAMES)


def test_keypoints_may_not_leave_the_folder_by_a_link(folder: Path, tmp_path: Path) -> None:
    outside = write_keypoints(tmp_path / "outside.json", true_postures(FRAMES))
    (folder / "keypoints.json").symlink_to(outside)
    with pytest.raises(InputError, match=r"keypoints\.json: leads by a link"):
        read_take(folder)
    (folder / "keypoints.json").unlink()
    (folder / "openpose").mkdir()
    (folder / "openpose" / "clip_000000000000_keypoints.json").symlink_to(outside)
    edit_json(folder / "take.json", keypoints="openpose")
    with pytest.raises(InputError, match="leads by a link"):
        read_take(folder)


def test_the_papers_filter_needs_markers(folder: Path) -> None:
    take = read_take(folder)
    check_method(take, "ekf")
    edit_json(folder / "take.json", markers=None)
    bare = read_take(folder)
    check_method(bare, "map")
    check_method(bare, "interpolation")
    with pytest.raises(InputError, match="method is ekf, .* follows markers alone.*; map is valid"):
        check_method(bare, "ekf")


def test_a_written_take_has_its_evidence(folder: Path, tmp_path: Path) -> None:
    hinted(folder)
    write_keypoints(folder / "other.json", true_postures(FRAMES), detector="other")
    edit_json(folder / "take.json", keypoints=["other.json", "keypoints.json"], markers=None)
    take = read_take(folder)
    write_take(take, tmp_path / "copy", evidence=("keypoints",))
    back = read_take(tmp_path / "copy", whole=True)
    assert back.markers == () and evidence_of(back) == (KEYPOINTS, DEPTH_HINTS, CONTOURS)
    assert [people.source for people in back.keypoints] == ["other", "drawn"]
    assert evidence_of(read_take(tmp_path / "copy")) == (KEYPOINTS,)
    before = {path: path.read_bytes() for path in (folder / "other.json", folder / "keypoints.json")}
    write_take(take, folder)
    assert {path: path.read_bytes() for path in before} == before
    assert [people.source for people in read_take(folder).keypoints] == ["other", "drawn"]
