"""`keymark convert` and `propose` with keypoints and without markers."""

import json
import shutil
from pathlib import Path

import pytest
from _synthetic_take import true_postures, write_json, write_keypoints, write_synthetic_take
from keymark.core.take.motion import read_motion
from keymark.operators.cli.main import main

FRAMES = 16


@pytest.fixture(scope="module")
def pristine(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A take without markers, with a file of keypoints that it does not name; tests must not change it."""
    folder = write_synthetic_take(tmp_path_factory.mktemp("plain") / "plain", FRAMES)
    take = json.loads((folder / "take.json").read_text(encoding="utf-8"))
    del take["markers"]
    write_json(folder / "take.json", take)
    write_keypoints(folder / "pose.json", true_postures(FRAMES))
    return folder


@pytest.fixture
def take(pristine: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(pristine, tmp_path / "take"))


@pytest.mark.usefixtures("no_blender")
def test_any_clothes_convert(pristine: Path, tmp_path: Path) -> None:
    words: dict[str, list[str]] = {
        "contours": [],
        "keypoints": ["--keypoints", str(pristine / "pose.json"), "--evidence", "keypoints"],
    }
    for name, more in words.items():
        out = tmp_path / name
        assert main(["convert", str(pristine), "--output", str(out), "--no-report", "--quiet", *more]) == 0
        assert len(read_motion(out / "motion.json").points) == FRAMES
    digests = {json.loads((tmp_path / name / "conversion.json").read_bytes())["digest"] for name in words}
    assert len(digests) == 2
