"""`keymark demo`: converts and scores the demonstration take, here a small one in its place."""

import importlib.util
import json
import shutil
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from _characters import plain_character
from _drawn_clip import KnownPeople
from _synthetic_take import BODY, SIZE, gliding, true_postures, write_synthetic_take, write_video
from _synthetic_take import write_keypoints as write_keypoints_of
from keymark.core.detect.keypoint_file import read_keypoints, write_keypoints
from keymark.core.detect.keypoints import People, SeenPeople
from keymark.core.errors import ConversionError
from keymark.core.prior.learning import LibraryMetadata, learn_library
from keymark.core.review.score import read_truth, score_points
from keymark.core.session import see
from keymark.core.take import examples
from keymark.core.take.motion import read_motion
from keymark.core.take.take_file import read_take
from keymark.operators.cli.commands import demo
from keymark.operators.cli.console import Console
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

    posture, metadata = true_postures(24), LibraryMetadata("Swaying", "Nobody")
    library = learn_library(BODY, posture, np.arange(24) / 30.0, metadata)
    monkeypatch.setattr(see, "PoseNetwork", SimpleNamespace)
    monkeypatch.setattr(see, "PeopleFinder", lambda *_given: KnownPeople(people))
    monkeypatch.setattr(convert_take, "requested_libraries", lambda _name: (library,))


HAS_BLENDER = importlib.util.find_spec("bpy") is not None


def write_character(file: Path) -> None:
    """A plain character instead of Rigify's human, which `make demo` generates."""
    if not HAS_BLENDER:
        raise ConversionError("Rigify is missing")
    import bpy
    from _armatures import build_character

    armature = build_character(plain_character())
    bpy.data.libraries.write(str(file), {armature})
    bpy.data.batch_remove([armature, armature.data])


@pytest.mark.slow
def test_it_scores_every_method_by_the_motion_it_wrote_and_says_where_to_look(
    take: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    results: list[dict[str, Any]] = []
    finish = Console.finish
    monkeypatch.setattr(Console, "finish", lambda own, *rest: (results.append(rest[0]), finish(own, *rest)))
    monkeypatch.setattr(demo, "write_demo_character", write_character)
    out = tmp_path / "out"
    assert main(["demo", "--output", str(out)]) == 0

    (scores,) = (result["scores_mm"] for result in results)
    truth, camera = read_truth(take / "truth.json", 1, FRAMES), read_take(take).camera
    for name, folder in (("map", out), ("without_markers", out / "without_markers")):
        motion = read_motion(folder / "motion.json")
        score = score_points(motion.points, truth, motion.keyframe_indices, camera, motion.sigma_m).to_dict()
        known = {figure: value for figure, value in score.items() if value is not None}
        assert {figure: scores[name][figure] for figure in known} == pytest.approx(known, rel=1e-3, abs=1e-3)
    assert set(scores) == {"interpolation", "ekf", "map", "without_markers"}
    assert scores["interpolation"]["coverage95"] is None
    assert all(score["mpjpe"] > 0.0 for score in scores.values())
    record = json.loads((out / "without_markers" / "conversion.json").read_text())
    assert record["evidence"]["markers"] == [] and len(record["evidence"]["keypoints"]) == 1

    said = capsys.readouterr().out
    steps = [line.partition(":")[0] for line in said.splitlines() if line.startswith("Step ")]
    assert steps == [f"Step {number} of 5" for number in (1, 2, 3, 4, 5)]
    assert "  Keypoints: somebody in 40 of 40 frames, by drawn" in said.splitlines()
    assert (out / "animated" / "take.json").is_file()
    assert (str(out / "character.blend") in said) == (out / "character.blend").exists() == HAS_BLENDER
    assert ("Without a character: Rigify is missing" in said) != HAS_BLENDER
    rows = {line[2:17].strip(): line[17:].split() for line in said.splitlines() if line.startswith("  ")}
    for name, score in scores.items():
        assert rows[name.replace("_", " ")] == [f"{score[column]:.1f}" for column in demo.COLUMNS]
    for path in (out / "motion.blend", out / "report", out / "without_markers" / "motion.blend"):
        assert str(path) in said and path.exists()


def test_an_installation_without_it_is_one_sentence(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(examples, "SHIPPED", tmp_path / "nowhere")
    assert main(["demo", "--output", str(tmp_path / "out")]) == 2
    assert "example is missing" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()
