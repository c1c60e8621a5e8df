"""`keymark mend`: motion.json, motion.bvh and the character, complete or not at all."""

import json
from collections.abc import Callable
from pathlib import Path

import bpy
import numpy as np
import pytest
from _command_line import one_line, tree
from _performances import jitter_mm, seen_by_network, stepping, write_mhr70
from keymark.core.take.motion import read_motion
from keymark.core.take.point_files import read_points
from keymark.operators.cli.main import main

FRAMES = 30
Mend = Callable[..., int]


@pytest.fixture
def network(tmp_path: Path) -> Path:
    """A network's points, and the truth beside them."""
    body, posture = stepping()
    truth = body.points(body.pose(posture[:FRAMES]))
    write_mhr70(tmp_path / "network.csv", seen_by_network(truth))
    write_mhr70(tmp_path / "truth.csv", truth)
    return tmp_path / "network.csv"


@pytest.fixture
def output(tmp_path: Path) -> Path:
    return tmp_path / "deep" / "out"


@pytest.fixture
def mend(network: Path, output: Path) -> Mend:
    """A function that mends a file."""

    def run(*more: str, file: Path = network) -> int:
        return main(["mend", str(file), "--output", str(output), "--quiet", *more])

    return run


def test_points_become_a_motion(
    mend: Mend, network: Path, output: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    assert mend("--json", "--fps", "25") == 0
    said = json.loads(capfd.readouterr().out.splitlines()[-1])
    assert sorted(tree(output)) == [".as_made.json", "motion.bvh", "motion.json"]
    assert said["files"] == [str(output / "motion.json"), str(output / "motion.bvh")]
    motion = read_motion(output / "motion.json")
    assert (motion.fps, len(motion.time_s), motion.method) == (25.0, FRAMES, "mend")
    truth, _, _ = read_points(network.with_name("truth.csv"))
    given, _, _ = read_points(network)
    assert jitter_mm(motion.points) < 1.5 * jitter_mm(truth) < 0.2 * jitter_mm(given)
    first = tree(output)
    assert mend("--fps", "25") == 0
    assert tree(output) == first


def test_an_armature_gets_its_own_motion_back_and_a_character_the_same(
    mend: Mend, output: Path, cast: Path, tmp_path: Path
) -> None:
    assert mend() == 0
    given = tmp_path / "given.bvh"
    (output / "motion.bvh").rename(given)
    assert mend("--format", "bvh,trc,c3d", "--posed", "5", file=given) == 0
    assert sorted(tree(output)) == [
        *(".as_made.json", "character.blend", "character.bvh", "character.c3d", "character.trc"),
        *("motion.bvh", "motion.json"),
    ]
    motion = read_motion(output / "motion.json")
    assert motion.keyframe_indices == (4,)
    for name in ("character.trc", "character.c3d"):
        points, rate, _ = read_points(output / name)
        assert rate == 30.0
        assert np.linalg.norm(points[:, 1:] - motion.points[:, 1:], axis=-1).mean() < 0.015
    own = output / "character.blend"
    assert mend("--character", str(cast / "anna.blend"), file=given) == 0
    assert "retarget.json" in tree(output) and "character.trc" not in tree(output)
    bpy.ops.wm.open_mainfile(filepath=str(own))
    assert bpy.context.scene.objects["Anna"].animation_data.action.name == "given Anna"


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--posed", "5,soon"], "--posed is 5,soon; frames with commas"),
        (["--posed", "99"], "posed frame 99 is not in the motion, whose frames are 1 to 30"),
        (["--fps", "0"], "--fps is 0.0; it must be a number from 1 to 1000"),
        (["--format", "mp3"], "--format is mp3; bvh, fbx"),
    ],
)
def test_a_mistake_is_one_sentence_and_nothing_changes(
    mend: Mend, output: Path, capfd: pytest.CaptureFixture[str], words: list[str], said: str
) -> None:
    output.mkdir(parents=True)
    (output / "mine.txt").write_text("mine")
    assert mend(*words) == 2
    assert said in one_line(capfd.readouterr().err)
    assert list(tree(output)) == ["mine.txt"]


def test_a_motion_that_mend_did_not_make_is_kept(mend: Mend, output: Path, network: Path) -> None:
    output.mkdir(parents=True)
    (output / "motion.json").write_text("mine")
    assert mend() == 0
    assert [(output / name).read_text() for name in tree(output) if "motion (" in name] == ["mine"]
    before = tree(output)
    assert mend() == 0 and tree(output) == before
    (output / ".as_made.json").unlink()
    assert mend("--fps", "25") == 0
    assert len(tree(output)) == len(before) + 2
    assert mend("--action", "Walk", file=network) == 2
