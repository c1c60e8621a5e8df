"""A shoot that names a character: every result has it, batches notice changes, and merge carries it."""

import json
import shutil
from collections.abc import Callable
from pathlib import Path

import bpy
import pytest
from _characters import full_map, plain_character, plain_map
from _command_line import one_line, tree
from _results import is_whole
from _synthetic_take import write_shoot
from keymark.core.retarget.maps.character_map import write_character_map
from keymark.core.retarget.retarget_record import read_retarget_record
from keymark.core.take.conversion_record import read_record
from keymark.operators.bridge.actions import curve_digest
from keymark.operators.cli.main import main

TAKES = 2
NAMES = [f"day1/take{number:02d}" for number in range(1, TAKES + 1)]
MADE = {"character.blend", "conversion.json", "motion.blend", "motion.bvh", "motion.json", "retarget.json"}
Out = pytest.CaptureFixture[str]
Batch = Callable[..., dict[str, int]]


@pytest.fixture(scope="module")
def pristine(cast: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two small takes, and a character in a folder of theirs; tests must not change it."""
    folder = write_shoot(tmp_path_factory.mktemp("pristine") / "shoot", TAKES)
    (folder / "cast").mkdir()
    shutil.copyfile(cast / "anna.blend", folder / "cast" / "anna.blend")
    shutil.copyfile(cast / "two.blend", folder / "cast" / "two.blend")
    name_character(folder, file="cast/anna.blend")
    return folder


@pytest.fixture
def shoot(pristine: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(pristine, tmp_path / "shoot"))


def name_character(shoot: Path, **character: object) -> None:
    """Say in shoot.json which character gets the motions."""
    said = json.loads((shoot / "shoot.json").read_text(encoding="utf-8"))
    (shoot / "shoot.json").write_text(json.dumps(said | {"character": character}), encoding="utf-8")


@pytest.fixture(scope="module")
def first_batch(pristine: Path) -> Path:
    """What the first batch makes of the takes; tests must not change it."""
    if bpy.app.binary_path:
        pytest.skip("a Blender program's own Python has no bpy; tests/real_blender runs batches in it")
    out = pristine.parent / "out"
    assert main(["batch", str(pristine), "--output", str(out), "--jobs", "1", "--quiet"]) == 0
    return out


@pytest.fixture
def converted(first_batch: Path, shoot: Path, tmp_path: Path) -> Path:
    """The results of the first batch, copied for one test."""
    return Path(shutil.copytree(first_batch, tmp_path / "out"))


@pytest.fixture
def batch(shoot: Path, tmp_path: Path, capfd: Out) -> Batch:
    """A function that converts the shoot and returns how many takes had which outcome."""
    if bpy.app.binary_path:
        pytest.skip("a Blender program's own Python has no bpy; tests/real_blender runs batches in it")

    def run(*words: str) -> dict[str, int]:
        capfd.readouterr()
        main(["batch", str(shoot), "--output", str(tmp_path / "out"), "--jobs", "1", "--json", *words])
        counts: dict[str, int] = json.loads(capfd.readouterr().out)["counts"]
        return {name: count for name, count in counts.items() if count}

    return run


def test_every_take_gets_the_character(batch: Batch, converted: Path, tmp_path: Path) -> None:
    lines = (converted / "summary.jsonl").read_text(encoding="utf-8").splitlines()
    assert [json.loads(line)["status"] for line in lines] == ["converted"] * TAKES
    for name in NAMES:
        folder = tmp_path / "out" / name
        assert {file for file in tree(folder) if not file.startswith(".")} == MADE
        assert is_whole(folder)
        record = read_record(folder)
        assert MADE - {"conversion.json"} == set(record.files)
        made = read_retarget_record(folder)
        assert made.take == Path(name).name and made.character.object == "Anna"
        assert made.files["character.blend"] == record.files["character.blend"]
    assert batch() == {"unchanged": TAKES}
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "out" / NAMES[0] / "character.blend"))
    scene = bpy.context.scene
    assert Path(bpy.path.abspath(scene.active_clip.filepath)).name == "take01.mp4"
    assert Path(bpy.path.abspath(scene.active_clip.filepath)).is_file()
    anna = scene.objects["Anna"]
    assert curve_digest(anna) == read_retarget_record(tmp_path / "out" / NAMES[0]).files["character.blend"]


@pytest.mark.slow
def test_a_change_of_the_character_converts_anew(
    batch: Batch, converted: Path, shoot: Path, tmp_path: Path
) -> None:
    write_character_map(shoot / "cast" / "anna.json", plain_map(plain_character()))
    name_character(shoot, file="cast/anna.blend", map="cast/anna.json", legs="fk")
    assert batch() == {"converted": TAKES}
    assert read_retarget_record(tmp_path / "out" / NAMES[0]).map.origin == "given"
    said = json.loads((shoot / "shoot.json").read_text(encoding="utf-8"))
    del said["character"]
    (shoot / "shoot.json").write_text(json.dumps(said), encoding="utf-8")
    assert batch() == {"converted": TAKES}
    left = MADE - {"character.blend", "retarget.json"}
    assert set(tree(tmp_path / "out" / NAMES[0])) - {".as_made.json"} == left


def test_a_bad_character_fails_its_takes_before_the_work(
    batch: Batch, shoot: Path, tmp_path: Path, capfd: Out
) -> None:
    name_character(shoot, file="cast/two.blend")
    assert batch() == {"failed": TAKES}
    assert not (tmp_path / "out" / NAMES[0]).exists()
    capfd.readouterr()
    words = ["convert", str(shoot / "day1" / "take01.mp4"), "--output", str(tmp_path / "one"), "--quiet"]
    assert main(words) == 2
    assert "two.blend: holds 2 armatures, 'Anna', 'Ben'; name one" in one_line(capfd.readouterr().err)
    assert not (tmp_path / "one").exists()


def test_check_says_it_beforehand(shoot: Path, capfd: Out) -> None:
    before = tree(shoot)
    for character, said in (
        ({"file": "cast/two.blend"}, "holds 2 armatures, 'Anna', 'Ben'"),
        ({"file": "cast/nobody.glb"}, "no such file; it must be a character file"),
        ({"file": "cast/anna.blend", "object": "Ben"}, "'Ben' is not in it"),
        ({"file": "cast/anna.blend", "map": "full.json"}, "is for another character: 'Anna' has no bone"),
        ({"file": "cast/anna.blend", "map": "nobody"}, "there is no character map 'nobody'"),
        ({"file": "cast/anna.blend"}, ""),
    ):
        write_character_map(shoot / "full.json", full_map())
        name_character(shoot, **character)
        capfd.readouterr()
        status = main(["check", str(shoot), "--json"])
        answer = json.loads(capfd.readouterr().out)
        problems = [problem for take in answer["takes"] for problem in take["problems"]]
        assert status == (1 if said else 0) and len(problems) == (TAKES if said else 0)
        assert all(said in problem for problem in problems)
    assert {name for name in tree(shoot)} - {"full.json"} == set(before)


def test_merge_carries_the_characters_actions(converted: Path, tmp_path: Path, capfd: Out) -> None:
    library = tmp_path / "library.blend"
    words = ["merge", str(converted), "--output", str(library), "--name", "Walk"]
    assert main([*words, "--json"]) == 0
    answer = json.loads(capfd.readouterr().out)
    assert answer["motions"] == TAKES and answer["character_actions"] == TAKES
    with bpy.data.libraries.load(str(library), assets_only=True) as (found, wanted):
        wanted.actions = list(found.actions)
    actions = {action.name: action for action in wanted.actions}
    assert set(actions) == {f"day1 take{n:02d}{more}" for n in range(1, TAKES + 1) for more in ("", " Anna")}
    own = actions["day1 take01 Anna"]
    assert "For the character 'Anna' of anna.blend." in own.asset_data.description
    assert "Anna" in [tag.name for tag in own.asset_data.tags]
    catalogs = (tmp_path / "blender_assets.cats.txt").read_text(encoding="utf-8")
    assert f"{own.asset_data.catalog_id}:Keymark Characters/Walk/day1:" in catalogs
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    bpy.ops.wm.open_mainfile(filepath=str(converted / NAMES[0] / "character.blend"))
    made = read_retarget_record(converted / NAMES[0]).files["character.blend"]
    anna = bpy.context.scene.objects["Anna"]
    with bpy.data.libraries.load(str(library)) as (_, wanted):
        wanted.actions = ["day1 take01 Anna"]
    anna.animation_data.action = wanted.actions[0]
    anna.animation_data.action_slot = wanted.actions[0].slots[0]
    assert curve_digest(anna) == made


@pytest.mark.parametrize("file", ["character.blend", "retarget.json"])
def test_merge_names_a_character_that_was_changed(
    converted: Path, tmp_path: Path, capfd: Out, file: str
) -> None:
    damaged = converted / NAMES[1] / file
    damaged.write_bytes(damaged.read_bytes()[: damaged.stat().st_size // 2])
    library = tmp_path / "library.blend"
    assert main(["merge", str(converted), "--output", str(library), "--quiet"]) == 1
    assert NAMES[1] in one_line(capfd.readouterr().err)
    with bpy.data.libraries.load(str(library), assets_only=True) as (found, _):
        assert sorted(found.actions) == ["day1 take01", "day1 take01 Anna", "day1 take02"]
