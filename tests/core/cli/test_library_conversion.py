"""`keymark convert --keyframes auto` and `--library`: takes without posed keyframes, and refusals."""

import json
import re
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from _synthetic_take import BODY, true_postures, write_json, write_synthetic_take
from keymark.core.poses.found_poses import Candidate, FoundPoses, MatchedFrame
from keymark.core.prior.learning import LibraryMetadata, learn_library
from keymark.core.prior.library import library_digest, read_library, write_library
from keymark.core.session import pose as pose_stage
from keymark.core.take.conversion_record import read_record
from keymark.operators.cli.conversion import blender_files
from keymark.operators.cli.main import main

FRAMES = 24

pytestmark = pytest.mark.usefixtures("no_blender")


@pytest.fixture
def take(tmp_path: Path) -> Path:
    folder = write_synthetic_take(tmp_path / "take", FRAMES)
    (folder / "keyframes.json").rename(tmp_path / "posed.json")
    return folder


@pytest.fixture
def library(tmp_path: Path) -> Path:
    posture = true_postures(FRAMES)
    learned = learn_library(BODY, posture, np.arange(FRAMES) / 30.0, LibraryMetadata("Swaying", "Nobody"))
    write_library(tmp_path / "swaying.json", learned)
    return tmp_path / "swaying.json"


def convert(take: Path, out: Path, *more: object) -> int:
    return main(["convert", str(take), "--output", str(out), "--method", "interpolation", *map(str, more)])


def said_as_json(capsys: pytest.CaptureFixture[str]) -> dict[str, Any]:
    return dict(json.loads(capsys.readouterr().out))


def test_matched_keyframes_can_be_given_back(
    take: Path, library: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out"
    assert convert(take, out, "--library", library, "--quiet", "--no-report") == 0
    kept = (out / "keyframes.json").read_bytes()
    assert convert(take, out, "--keyframes", out / "keyframes.json", "--json", "--no-report") == 0
    said = said_as_json(capsys)
    frames = [row["frame"] for row in json.loads(kept)["keyframes"]]
    assert said["keyframes"] == frames and "library" not in said
    assert (out / "keyframes.json").read_bytes() == kept


@pytest.fixture
def few_libraries(library: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The one library as if it came with Keymark, and no other."""
    monkeypatch.setattr(blender_files, "SHIPPED", library.parent)
    return library


def test_keyframes_are_found_with_all_libraries(
    take: Path, few_libraries: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    made = []
    for name, words in (("one", ["--keyframes", "auto"]), ("other", ["--library", "auto"])):
        out = tmp_path / name
        assert convert(take, out, *words, "--json") == 0
        said = said_as_json(capsys)
        assert said["library"] == "swaying" and said["reason"] in said["notes"]  # the only one there is
        rows = json.loads((out / "keyframes.json").read_text(encoding="utf-8"))["keyframes"]
        assert [row["frame"] for row in rows] == [one["frame"] for one in said["matches"]] != []
        assert {row["matched"]["library"] for row in rows} == {"composed"}
        record = read_record(out)
        assert record.library == "swaying" and record.matched == record.keyframes
        assert record.libraries == {"swaying": library_digest(read_library(few_libraries))}
        assert list(record.doubtful) == [one["frame"] for one in said["matches"] if one["doubtful"]]
        made.append((said["matches"], record.digest))
    assert made[0] == made[1]


def test_posed_keyframes_stay_and_the_others_are_found(
    take: Path, few_libraries: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    posed = Path(shutil.copy(tmp_path / "posed.json", take / "keyframes.json"))
    assert convert(take, tmp_path / "found", "--keyframes", "auto", "--json", "--no-report") == 0
    (note, *_) = said_as_json(capsys)["notes"]
    assert note == f"{posed} is left aside; --keyframes {posed} --library auto would use it too"
    rows = json.loads(posed.read_text(encoding="utf-8"))["keyframes"]
    match = {"library": "x", "posture": "y", "mirrored": False, "confidence": 0.5}
    write_json(tmp_path / "one.json", {"keyframes": [rows[1], {**rows[-1], "matched": match}]})
    more = ("--keyframes", tmp_path / "one.json", "--library", "auto", "--json", "--no-report")
    assert convert(take, tmp_path / "both", *more) == 0
    assert not any("left aside" in note for note in said_as_json(capsys)["notes"])
    found = json.loads((tmp_path / "both" / "keyframes.json").read_text(encoding="utf-8"))["keyframes"]
    assert [row["frame"] for row in found if "matched" not in row] == [rows[1]["frame"]]
    assert {row["matched"]["library"] for row in found if "matched" in row} == {"composed"}


def test_found_keyframes_are_said_to_be_doubtful_and_contradictions_are_named(
    take: Path, few_libraries: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Any
) -> None:
    def pose(given: Any, _libraries: object, _floor_m: object, _count: object, **_more: object) -> Any:
        yield from ()
        truth = true_postures(FRAMES)
        sure = {0: 0.9, 12: 0.2, 23: 0.4}
        frames = tuple(
            MatchedFrame(index, (Candidate(truth[index], "Sway", False, confidence),))
            for index, confidence in sure.items()
        )
        against = {12: (given.take.markers[0].name, "wrist.L"), 23: ("wrist.L",)}
        return FoundPoses(frames, truth, 0.7, 0.0, "two frames are in doubt", against)

    monkeypatch.setattr(pose_stage, "pose_clip", pose)
    assert convert(take, tmp_path / "out", "--keyframes", "auto", "--json", "--no-report") == 0
    said = said_as_json(capsys)
    first = json.loads((take / "take.json").read_text(encoding="utf-8"))["frame_start"]
    marker = next(iter(json.loads((take / "take.json").read_text(encoding="utf-8"))["markers"]))
    assert said["notes"] == list(read_record(tmp_path / "out").notes)
    assert set(said["notes"]) >= {
        "two frames are in doubt",
        f"frames {first + 12}, {first + 23}: no plausible pose explains keypoint wrist.L",
        f"frame {first + 12}: no plausible pose explains marker {marker}",
        f"2 of 3 found keyframes are doubtful; pose frames {first + 12}, {first + 23} to set them right",
    }
    assert said["contradictions"][0] == {"frame": first + 12, "evidence": [marker, "wrist.L"]}
    assert [one["doubtful"] for one in said["matches"]] == [False, True, True]


def test_without_a_library_nothing_can_be_found(
    take: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "none").mkdir()
    monkeypatch.setattr(blender_files, "SHIPPED", tmp_path / "none")
    assert convert(take, tmp_path / "out", "--keyframes", "auto", "--quiet") == 2
    said = capsys.readouterr().err
    assert "there is no keyframe library" in said and len(said.splitlines()) == 1
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("more", "sentence"),
    [
        (["--library", "swayin"], "'swayin'.*'swaying'"),
        (["--library", "no/such.json"], "no/such.json: no such file"),
        (["--library", "swaying", "--floor", "nan"], "--floor is nan"),
        (["--library", "swaying", "--floor", "high"], "--floor.*high"),
        (["--floor", "0"], "--floor is given without --keyframes auto or --library"),
        (["--keyframes", "auto", "--library", "swaying"], "--keyframes auto finds .*swaying.*one of them"),
    ],
)
def test_what_cannot_be_matched_with_is_one_line(
    more: list[str],
    sentence: str,
    take: Path,
    library: Path,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv(blender_files.VARIABLE, str(library.parent))
    assert convert(take, tmp_path / "out", *more, "--quiet") == 2
    said = capsys.readouterr().err
    assert len(said.splitlines()) == 1
    assert re.search(sentence, said)
    assert not (tmp_path / "out").exists()


def test_matched_keyframes_never_replace_posed_ones(
    take: Path, library: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert convert(take, take, "--library", library, "--quiet") == 2
    assert "own folder" in capsys.readouterr().err and not (take / "keyframes.json").exists()
