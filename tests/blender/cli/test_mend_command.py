"""`keymark mend`: motion.json, motion.bvh and the character, complete or not at all."""

import json
import re
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


@pytest.mark.parametrize(
    ("name", "content", "said"),
    [
        ("motion.txt", "", "is no motion; it must be a file that ends in"),
        ("motion.csv", "a,b\n1,2\n", "has no points"),
        ("motion.trc", "PathFileType\n", "is no TRC"),
        ("motion.bvh", "HIERARCHY\n", "is no BVH"),
        ("motion.json", "{}", "schema_version is missing"),
        ("motion.fbx", "x", "Blender cannot read it"),
    ],
)
def test_a_file_that_is_no_motion_is_refused(
    mend: Mend,
    tmp_path: Path,
    output: Path,
    capfd: pytest.CaptureFixture[str],
    name: str,
    content: str,
    said: str,
) -> None:
    (tmp_path / name).write_text(content)
    assert mend(file=tmp_path / name) == 2
    assert said in one_line(capfd.readouterr().err)
    assert not output.exists()


def two_roots(file: Path, text: str) -> None:
    """A BVH of the same body twice, the second called Ben's and one meter aside."""
    hierarchy, _, motion = text.partition("MOTION\n")
    _, body = hierarchy.split("\n", 1)
    other = re.sub(r"(ROOT|JOINT) ", r"\1 Ben_", body)
    frames, step, *rows = motion.splitlines()
    both = [f"{row} {float(row.split()[0]) + 1.0:.6f} {row.split(' ', 1)[1]}" for row in rows]
    file.write_text("\n".join([f"HIERARCHY\n{body}{other}MOTION", frames, step, *both, ""]))


def test_one_of_two_people_in_a_bvh_is_mended_and_named(
    mend: Mend, output: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    assert mend() == 0
    given = tmp_path / "given.bvh"
    (output / "motion.bvh").rename(given)
    two_roots(tmp_path / "two.bvh", given.read_text())
    found = {}
    for name, words in (
        ("alone", [given]),
        ("first", [tmp_path / "two.bvh"]),
        ("Ben", [tmp_path / "two.bvh"]),
    ):
        more = ["--subject", "Ben_pelvis"] if name == "Ben" else []
        capfd.readouterr()
        assert mend("--json", *more, file=words[0]) == 0
        notes = json.loads(capfd.readouterr().out.splitlines()[-1])["notes"]
        assert any("2 subjects, 'pelvis', 'Ben_pelvis'" in note for note in notes) == (name == "first")
        found[name] = read_motion(output / "motion.json").points
    np.testing.assert_allclose(found["first"], found["alone"], atol=1e-5)
    np.testing.assert_allclose(found["Ben"], found["alone"] + [1.0, 0.0, 0.0], atol=1e-3)
    assert mend("--subject", "Cleo", file=tmp_path / "two.bvh") == 2
    assert "its subjects are 'pelvis', 'Ben_pelvis'" in one_line(capfd.readouterr().err)


@pytest.mark.parametrize("name", ["bom.bvh", "japanese_sjis.bvh", "comma_decimals.bvh"])
def test_a_bvh_of_another_system_is_the_same_motion(
    mend: Mend, output: Path, repository: Path, name: str
) -> None:
    folder = repository.parent / "shared" / "failing"
    if not folder.is_dir():
        pytest.skip("no shared/failing")
    found = []
    for file in ("turn4_bvh_saved_on_another_system/" + name, "turn4_two_people_in_one_bvh/two_roots.bvh"):
        assert mend(file=folder / file) == 0
        found.append(read_motion(output / "motion.json").points)
    np.testing.assert_allclose(found[0], found[1], atol=1e-4)


def test_of_a_file_of_several_actions_one_is_named(
    mend: Mend, output: Path, repository: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    file = repository.parent / "shared" / "failing" / "turn4_several_actions_in_one_file" / "two_actions.glb"
    if not file.exists():
        pytest.skip("no shared/failing")
    assert mend("--json", file=file) == 0
    assert "2 Actions, 'A_Idle', 'Walk'; the motion is that of 'A_Idle'" in capfd.readouterr().out
    assert mend("--action", "Walk", file=file) == 0
    assert len(read_motion(output / "motion.json").time_s) == 86


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
