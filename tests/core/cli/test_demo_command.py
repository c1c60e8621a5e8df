"""`keymark demo`: converts and scores the demonstration take, here a small one in its place."""

import importlib.util
import json
import shutil
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from _shoot import gliding, write_video
from _synthetic_take import BODY, SIZE, true_postures, write_synthetic_take
from _synthetic_take import write_keypoints as write_keypoints_of
from keymark.core.errors import ConversionError
from keymark.core.footage.keypoints.keypoint_file import read_keypoints, write_keypoints
from keymark.core.footage.keypoints.keypoints import People, SeenPeople
from keymark.core.pipeline import place
from keymark.core.prior.learning import LibraryMetadata, learn_library
from keymark.core.progress import Job, Progress
from keymark.core.review.score import read_truth, score_points
from keymark.core.take import examples
from keymark.core.take.motion import read_motion
from keymark.core.take.take_file import read_take
from keymark.operators.cli.commands import demo
from keymark.operators.cli.conversion import convert_take
from keymark.operators.cli.main import main

FRAMES = 16


@pytest.fixture
def take(tmp_path: Path, no_blender: None, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A small take instead of the demonstration's, and two empty files instead of Blender's."""
    folder = write_synthetic_take(tmp_path / "demo" / examples.AEROBIC, FRAMES)
    shutil.copyfile(folder / "keyframes.json", folder / examples.POSED_BY_HAND)
    take = read_take(folder)
    truth = read_truth(folder / "truth.json", take.frame_start, FRAMES)
    pixel, _ = take.camera.project(truth)
    hint = truth[..., [0, 2, 1]] * [1.0, -1.0, 1.0]  # the camera looks along +Y
    seen = [
        SeenPeople(place[None], np.ones((1, len(place))), space[None])
        for place, space in zip(pixel, hint, strict=True)
    ]
    people = People(take.body.skeleton.point_names, "truth", take.camera.resolution, tuple(seen))
    write_keypoints(folder / "keypoints.json", people, take.frame_start)

    monkeypatch.setattr(demo, "require_blender", lambda needing: None)
    monkeypatch.setattr(examples, "SHIPPED", folder.parent)
    bare_clip(folder.with_name(examples.GREETING), monkeypatch)
    return folder


def bare_clip(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A small clip to animate, whose keypoints are found at once, and a small library."""
    folder.mkdir()
    write_video(folder / "clip.mp4", gliding())
    written = write_keypoints_of(folder / "seen.json", gliding())
    people = read_keypoints(written, 40, SIZE, 30.0, 1)

    def find(_clip: object, _network: object) -> Job[People]:
        yield Progress("Detecting keypoints", 0.0)
        return people

    posture, metadata = true_postures(24), LibraryMetadata("Swaying", "Nobody")
    library = learn_library(BODY, posture, np.arange(24) / 30.0, metadata)
    monkeypatch.setattr(place, "PoseNetwork", SimpleNamespace)
    monkeypatch.setattr(place, "find_people", find)
    monkeypatch.setattr(convert_take, "requested_libraries", lambda _name: (library,))


@pytest.fixture
def no_character(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(_file: Path) -> None:
        raise ConversionError("Rigify is missing")

    monkeypatch.setattr(demo, "write_demo_character", refuse)


@pytest.mark.usefixtures("no_character")
def test_it_scores_every_method_by_the_motion_it_wrote(
    take: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["demo", "--output", str(tmp_path / "out"), "--json"]) == 0
    said = json.loads(capsys.readouterr().out)
    motion = read_motion(tmp_path / "out" / "motion.json")
    truth = read_truth(take / "truth.json", motion.frame_start, FRAMES)
    camera = read_take(take).camera
    score = score_points(motion.points, truth, motion.keyframe_indices, camera, motion.sigma_m).to_dict()
    known = {name: value for name, value in score.items() if value is not None}
    assert {name: said["scores_mm"]["map"][name] for name in known} == pytest.approx(
        known, rel=1e-3, abs=1e-3
    )
    assert set(said["scores_mm"]) == {"interpolation", "ekf", "map", "without_markers"}
    unmarked = read_motion(tmp_path / "out" / "without_markers" / "motion.json")
    mpjpe = score_points(unmarked.points, truth, unmarked.keyframe_indices, camera).mpjpe
    assert said["scores_mm"]["without_markers"]["mpjpe"] == pytest.approx(mpjpe, rel=1e-3)
    record = json.loads((tmp_path / "out" / "without_markers" / "conversion.json").read_text())
    assert record["evidence"]["markers"] == [] and len(record["evidence"]["keypoints"]) == 1
    assert said["scores_mm"]["interpolation"]["coverage95"] is None
    assert all(scores["mpjpe"] > 0.0 for scores in said["scores_mm"].values())


def test_it_says_what_it_does_and_where_to_look(
    take: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], request: pytest.FixtureRequest
) -> None:
    has_blender = importlib.util.find_spec("bpy") is not None
    if not has_blender:
        request.getfixturevalue("no_character")
    assert main(["demo", "--output", str(tmp_path / "out")]) == 0
    said = capsys.readouterr().out
    steps = [line.partition(":")[0] for line in said.splitlines() if line.startswith("Step ")]
    assert steps == [f"Step {number} of 5" for number in (1, 2, 3, 4, 5)]
    assert "  Keypoints: somebody in 40 of 40 frames, by drawn" in said.splitlines()
    assert (tmp_path / "out" / "animated" / "take.json").is_file()
    character = tmp_path / "out" / "character.blend"
    assert (str(character) in said) == character.exists() == has_blender
    assert ("Without a character: Rigify is missing" in said) != has_blender
    rows = {
        line.split()[0]: line.split()[1:]
        for line in said.splitlines()
        if line.startswith("  ") and line.split()
    }
    for method in ("interpolation", "ekf", "map", "without"):
        assert len([float(value) for value in rows[method] if value != "markers"]) == len(demo.COLUMNS)
    unmarked = tmp_path / "out" / "without_markers" / "motion.blend"
    for path in (tmp_path / "out" / "motion.blend", tmp_path / "out" / "report", unmarked):
        assert str(path) in said and path.exists()


def test_an_installation_without_it_is_one_sentence(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(examples, "SHIPPED", tmp_path / "nowhere")
    assert main(["demo", "--output", str(tmp_path / "out")]) == 2
    assert "example is missing" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()
