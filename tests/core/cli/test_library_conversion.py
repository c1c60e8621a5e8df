"""`keymark convert --library`: takes without posed keyframes, their results, and refusals."""

import json
import re
import shutil
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from _synthetic_take import BODY, true_postures, write_json, write_synthetic_take
from keymark.core.library.learning import LibraryMetadata, learn_library
from keymark.core.library.library_file import write_library
from keymark.core.take.motion_file import read_motion
from keymark.operators.cli import library_search_path
from keymark.operators.cli.main import main

FRAMES = 24

pytestmark = pytest.mark.usefixtures("no_blender")


@pytest.fixture(scope="module")
def pristine(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A take that tests must not change."""
    return write_synthetic_take(tmp_path_factory.mktemp("takes") / "pristine", FRAMES)


@pytest.fixture
def take(pristine: Path, tmp_path: Path) -> Path:
    """A take of the test's own, without keyframes."""
    folder = Path(shutil.copytree(pristine, tmp_path / "take"))
    (folder / "keyframes.json").rename(tmp_path / "posed.json")
    return folder


@pytest.fixture
def library(tmp_path: Path) -> Path:
    """A library of exactly the performer's motion."""
    posture = true_postures(FRAMES)
    learned = learn_library(BODY, posture, np.arange(FRAMES) / 30.0, LibraryMetadata("Swaying", "Nobody"))
    write_library(tmp_path / "swaying.json", learned)
    return tmp_path / "swaying.json"


def convert(take: Path, out: Path, *more: object) -> int:
    """Run `keymark convert` with quick options."""
    return main(["convert", str(take), "--output", str(out), "--method", "interpolation", *map(str, more)])


def said_as_json(capsys: pytest.CaptureFixture[str]) -> dict[str, Any]:
    """The one object on standard output."""
    return dict(json.loads(capsys.readouterr().out))


def test_a_take_without_keyframes_is_matched(
    take: Path, library: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Motion, matched keyframes and their picture are written; the summary has match and confidence."""
    out = tmp_path / "out"
    assert convert(take, out, "--library", library, "--json") == 0
    said = said_as_json(capsys)
    assert said["library"] == "swaying" and said["probability"] == 1.0 and 0.0 <= said["fit"] <= 1.0
    assert said["ranking"] == [{"library": "swaying", "title": "Swaying", "probability": 1.0}]
    rows = json.loads((out / "keyframes.json").read_text(encoding="utf-8"))["keyframes"]
    assert (
        [row["frame"] for row in rows] == [match["frame"] for match in said["matches"]] == said["keyframes"]
    )
    assert {row["matched"]["library"] for row in rows} == {"swaying"}
    assert all(0.0 <= match["confidence"] <= 1.0 for match in said["matches"])
    assert said["reason"] in said["notes"] and not any("left aside" in note for note in said["notes"])
    assert cv2.imread(str(out / "report" / "matches.png")) is not None
    assert {str(out / "keyframes.json"), str(out / "report" / "matches.png")} <= set(said["files"])
    assert len(read_motion(out / "motion.json").points) == FRAMES


def test_keyframes_in_the_take_are_left_aside_and_said_to_be(
    take: Path, library: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The posed keyframes are neither read nor changed."""
    (take / "keyframes.json").write_text("no JSON at all", encoding="utf-8")
    assert convert(take, tmp_path / "out", "--library", library, "--json", "--no-report") == 0
    notes = said_as_json(capsys)["notes"]
    assert "left aside" in notes[0] and str(take / "keyframes.json") in notes[0]
    assert (take / "keyframes.json").read_text(encoding="utf-8") == "no JSON at all"


def test_posed_and_matched_keyframes_work_together(
    take: Path, library: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """One posed frame is enough; keyframes matched earlier are matched anew."""
    posed = json.loads((tmp_path / "posed.json").read_text(encoding="utf-8"))["keyframes"]
    earlier = {**posed[-1], "matched": {"library": "x", "posture": "y", "mirrored": False, "confidence": 0.5}}
    write_json(tmp_path / "one.json", {"keyframes": [posed[1], earlier]})
    out = tmp_path / "out"
    more = ("--library", library, "--keyframes", tmp_path / "one.json", "--no-report", "--json")
    assert convert(take, out, *more) == 0
    rows = json.loads((out / "keyframes.json").read_text(encoding="utf-8"))["keyframes"]
    assert [row["frame"] for row in rows if "matched" not in row] == [posed[1]["frame"]]
    assert {row["matched"]["library"] for row in rows if "matched" in row} == {"swaying"}
    assert not any("left aside" in note for note in said_as_json(capsys)["notes"])


def test_matched_keyframes_can_be_given_back(
    take: Path, library: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Without the library, into the same folder: the keyframe file is used and kept with its corrections."""
    out = tmp_path / "out"
    assert convert(take, out, "--library", library, "--quiet", "--no-report") == 0
    kept = (out / "keyframes.json").read_bytes()
    assert convert(take, out, "--keyframes", out / "keyframes.json", "--json", "--no-report") == 0
    said = said_as_json(capsys)
    frames = [row["frame"] for row in json.loads(kept)["keyframes"]]
    assert said["keyframes"] == frames and "library" not in said
    assert (out / "keyframes.json").read_bytes() == kept


def test_a_clip_that_no_library_fits_is_said_to_be_one(
    take: Path, library: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Any
) -> None:
    """Status 1, one line, and the output folder as it was; a posed take converts nevertheless."""
    from keymark.core.matching.match_take import LibraryChoice
    from keymark.operators.cli.conversion import matched_keyframes

    def nothing_fits(_take: object, _reading: object, given: Any, _floor_m: object) -> Any:
        yield from ()
        return LibraryChoice(tuple((one, 0.5) for one in given), None, "none of them fits")

    monkeypatch.setattr(matched_keyframes, "match_take", nothing_fits)
    monkeypatch.setattr(library_search_path, "SHIPPED", tmp_path)
    assert convert(take, tmp_path / "out", "--library", "auto", "--quiet") == 1
    said = capsys.readouterr().err
    assert "none of them fits; likeliest are Swaying 50%" in said and len(said.splitlines()) == 1
    assert not (tmp_path / "out").exists()
    posed = ["--keyframes", tmp_path / "posed.json"]
    assert convert(take, tmp_path / "out", "--library", "auto", *posed, "--json") == 0
    said = said_as_json(capsys)
    assert "none of them fits; only the posed keyframes count" in said["notes"] and "matches" not in said
    assert not (tmp_path / "out" / "keyframes.json").exists()


@pytest.mark.parametrize(
    ("more", "sentence"),
    [
        (["--library", "swayin"], "'swayin'.*'swaying'"),
        (["--library", "no/such.json"], "no/such.json: no such file"),
        (["--library", "swaying", "--floor", "nan"], "--floor is nan"),
        (["--library", "swaying", "--floor", "high"], "--floor.*high"),
        (["--floor", "0"], "--floor is given without --library"),
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
    """Status 2, before the clip is read."""
    monkeypatch.setenv(library_search_path.VARIABLE, str(library.parent))
    assert convert(take, tmp_path / "out", *more, "--quiet") == 2
    said = capsys.readouterr().err
    assert len(said.splitlines()) == 1
    assert re.search(sentence, said)
    assert not (tmp_path / "out").exists()


def test_matched_keyframes_never_replace_posed_ones(
    take: Path, library: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The take's own folder is refused as output."""
    assert convert(take, take, "--library", library, "--quiet") == 2
    assert "own folder" in capsys.readouterr().err and not (take / "keyframes.json").exists()
