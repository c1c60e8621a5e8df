"""`keymark merge`: the asset library of a batch is complete, named, and replaced by the next merge."""

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import bpy
import numpy as np
import pytest
from _synthetic_take import write_synthetic_take
from keymark.core.files.digest import content_digest
from keymark.core.shoot.outcomes import Failure, write_failure
from keymark.core.take.conversion_record import ConversionRecord, write_record
from keymark.core.take.motion import Motion, write_motion
from keymark.operators.bridge.asset_catalogs import NAME as CATALOGS
from keymark.operators.cli.main import main

RECORD = ConversionRecord(
    digest="0" * 32,
    keymark="0.1.0",
    take="clip",
    method="map",
    library="walking",
    frames=13,
    frame_start=1,
    fps=25.0,
    keyframes=(1, 7, 13),
    matched=(),
    confidence=0.834,
    weakest=0.5,
    weak_frames=(),
    notes=("The marker shin.L is hidden in 3 frames",),
)

AddResult = Callable[[str], Path]


@pytest.fixture
def results(tmp_path: Path) -> Path:
    return tmp_path / "results"


@pytest.fixture
def add_result(results: Path, wave_motion: Motion) -> AddResult:
    """A function that writes a take's result below the folder, with a distinct motion."""

    def add(name: str) -> Path:
        folder = results / name
        folder.mkdir(parents=True)
        write_motion(wave_motion, folder / "motion.json")
        files = {"motion.json": content_digest(folder / "motion.json")}
        write_record(folder, replace(RECORD, take=folder.name, files=files))
        return folder

    return add


def merge(results: Path, output: Path, *more: str) -> int:
    return main(["merge", str(results), "--output", str(output), "--quiet", *more])


def loaded(file: Path) -> list[bpy.types.Action]:
    """The assets of a .blend, in the order of their names."""
    with bpy.data.libraries.load(str(file), assets_only=True) as (found, wanted):
        wanted.actions = list(found.actions)
    return sorted(wanted.actions, key=lambda action: action.name)


def catalogs(folder: Path) -> dict[str, str]:
    lines = (folder / CATALOGS).read_text(encoding="utf-8").splitlines()
    entries = [line.split(":") for line in lines if line.count(":") == 2 and not line.startswith("#")]
    return {identifier: path for identifier, path, _ in entries}


def values(action: bpy.types.Action, frame: float) -> dict[tuple[str, int], float]:
    (slot,) = action.slots
    curves = action.layers[0].strips[0].channelbag(slot).fcurves
    return {(curve.data_path, curve.array_index): curve.evaluate(frame) for curve in curves}


def test_every_motion_becomes_an_asset_that_says_what_it_is(
    add_result: AddResult, results: Path, tmp_path: Path
) -> None:
    for name in ("day2/clip01", "day1/clip01", "day1/night: 2/clip", "single"):
        add_result(name)
    output = tmp_path / "library" / "shoot.blend"
    assert merge(results, output, "--name", "Café") == 0
    assert sorted(path.name for path in output.parent.iterdir()) == [CATALOGS, "shoot.blend"]
    actions = loaded(output)
    named = catalogs(output.parent)
    assert {action.name: named[action.asset_data.catalog_id] for action in actions} == {
        "day1 clip01": "Keymark/Café/day1",
        "day1 night: 2 clip": "Keymark/Café/day1/night- 2",
        "day2 clip01": "Keymark/Café/day2",
        "single": "Keymark/Café",
    }
    first = actions[0]
    assert first.asset_data.description == (
        "Take day1/clip01: 13 frames at 25 per second, 1 to 13. Confidence 83%, 50% where it is weakest. "
        "The marker shin.L is hidden in 3 frames."
    )
    assert [tag.name for tag in first.asset_data.tags] == ["keymark", "map", "walking"]
    assert (first.asset_data.author, first.asset_data.license) == ("", "")
    assert tuple(first.preview.image_size) == (256, 256)
    assert (first.use_frame_range, first.frame_start, first.frame_end) == (True, 1.0, 13.0)


def test_curves_are_those_of_the_converted_scene(results: Path, tmp_path: Path) -> None:
    take = write_synthetic_take(tmp_path / "takes" / "small", 16)
    words = ["convert", str(take), "--output", str(results / "small"), "--no-report", "--quiet"]
    assert main([*words, "--method", "interpolation"]) == 0
    assert merge(results, tmp_path / "library.blend") == 0
    (merged,) = loaded(tmp_path / "library.blend")
    with bpy.data.libraries.load(str(results / "small" / "motion.blend")) as (found, wanted):
        wanted.actions = list(found.actions)
    (own,) = wanted.actions
    assert merged.frame_range[:] == own.frame_range[:]
    for frame in np.linspace(*own.frame_range, 31):
        expected = values(own, frame)
        said = values(merged, frame)
        assert said.keys() == expected.keys()
        assert max(abs(said[key] - expected[key]) for key in expected) < 3e-6


def test_an_actor_that_is_dragged_into_a_scene_moves(
    add_result: AddResult,
    results: Path,
    tmp_path: Path,
    wave_motion: Motion,
    shown_points: Callable[[bpy.types.Object], np.ndarray],
) -> None:
    for name in ("day1/a", "day1/b"):
        add_result(name)
    assert merge(results, tmp_path / "library.blend") == 0
    with bpy.data.libraries.load(str(tmp_path / "library.blend"), assets_only=True) as (found, wanted):
        wanted.objects = list(found.objects)
    actors = {actor.name: actor for actor in wanted.objects}
    assert sorted(actors) == ["day1 a", "day1 b"]
    assert len({actor.data for actor in actors.values()}) == 1
    actor = actors["day1 b"]
    assert catalogs(tmp_path)[actor.asset_data.catalog_id] == "Keymark Actors/results/day1"
    assert tuple(actor.preview.image_size) == (256, 256)
    assert actor.animation_data.action.name == "day1 b" and actor.animation_data.action.asset_data
    bpy.context.scene.collection.objects.link(actor)
    for frame in (1, 8, 13):
        bpy.context.scene.frame_set(frame)
        np.testing.assert_allclose(shown_points(actor), wave_motion.points[frame - 1], atol=1e-5)


def test_merging_again_replaces_the_motions_and_keeps_the_catalogs(
    add_result: AddResult, results: Path, tmp_path: Path
) -> None:
    for name in ("day1/a", "day2/b"):
        add_result(name)
    output = tmp_path / "library.blend"
    assert merge(results, output) == 0
    before = catalogs(tmp_path)
    theirs = "5a5b6c0e-6a52-4a43-9b57-3d1f6f4c2a91:Ours:Ours\n"
    with (tmp_path / CATALOGS).open("a", encoding="utf-8") as file:
        file.write(theirs)
    (results / "day2" / "b" / "conversion.json").unlink()
    add_result("day3/c")
    assert merge(results, output) == 0
    assert [action.name for action in loaded(output)] == ["day1 a", "day3 c"]
    after = catalogs(tmp_path)
    assert before.items() < after.items() and "Ours" in after.values()


def test_the_open_file_stays_as_it_was(add_result: AddResult, results: Path, tmp_path: Path) -> None:
    add_result("clip")
    before = {block.name for block in bpy.data.user_map()}
    assert merge(results, tmp_path / "library.blend") == 0
    assert {block.name for block in bpy.data.user_map()} == before


def test_damaged_results_are_named_and_the_others_merged(
    add_result: AddResult, results: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    add_result("a")
    changed, cut, without = (add_result(name) for name in ("changed", "cut", "without"))
    motion = (changed / "motion.json").read_text(encoding="utf-8")
    (changed / "motion.json").write_text(motion.replace('"fps":25.0', '"fps":26.0'), encoding="utf-8")
    (cut / "conversion.json").write_text('{"schema_version": 1,', encoding="utf-8")
    (without / "motion.json").unlink()
    words = ["merge", str(results), "--output", str(tmp_path / "library.blend"), "--json"]
    assert main(words) == 1
    said = capsys.readouterr()
    assert json.loads(said.out)["motions"] == 1
    assert sorted(json.loads(said.out)["wrong"]) == ["changed", "cut", "without"]
    assert said.err.count("\n") == 1 and "lacks takes" in said.err and "changed, cut, without" in said.err
    reasons = json.loads(said.out)["wrong"]
    assert all(str(folder) in reasons[folder.name] for folder in (changed, cut, without))
    assert [action.name for action in loaded(tmp_path / "library.blend")] == ["a"]


def test_takes_that_have_failed_are_named(
    add_result: AddResult, results: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    add_result("a")
    for number in range(7):
        write_failure(results, Failure(f"bad{number}", f"clip {number} is cut off", "input"))
    assert main(["merge", str(results), "--output", str(tmp_path / "library.blend")]) == 1
    said = capsys.readouterr()
    assert "bad0, bad1, bad2, bad3, bad4 and 2 more" in said.err and "bad5" not in said.err
    assert all(f"  bad{number}: clip {number} is cut off\n" in said.out for number in range(7))
    assert [action.name for action in loaded(tmp_path / "library.blend")] == ["a"]


def test_where_nothing_is_sound_nothing_is_written(
    add_result: AddResult, results: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (add_result("only") / "motion.json").write_text("{}", encoding="utf-8")
    output = tmp_path / "new" / "library.blend"
    assert merge(results, output) == 1
    assert "none of the results can be used" in capsys.readouterr().err
    assert not output.parent.exists()


@pytest.mark.parametrize(
    ("output", "sentence"),
    [
        ("library.txt", "must end in .blend"),
        ("results/clip/library.blend", "lies in the results of the take clip"),
        ("folder.blend", "is a folder"),
    ],
)
def test_unusable_places_are_refused(
    add_result: AddResult,
    results: Path,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    output: str,
    sentence: str,
) -> None:
    add_result("clip")
    (tmp_path / "folder.blend").mkdir()
    assert merge(results, tmp_path / output) == 2
    assert sentence in capsys.readouterr().err


def test_folders_without_results_are_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert merge(tmp_path / "nowhere", tmp_path / "library.blend") == 2
    assert "no such folder" in capsys.readouterr().err
    assert merge(tmp_path, tmp_path / "library.blend") == 2
    assert "holds no result" in capsys.readouterr().err


def test_long_and_like_names_are_told_apart(add_result: AddResult, results: Path, tmp_path: Path) -> None:
    names = ["day1/clip", "day1 clip", "ü" * 60 + "/" + "x" * 30 + "1", "ü" * 60 + "/" + "x" * 30 + "2"]
    for name in names:
        add_result(name)
    assert merge(results, tmp_path / "library.blend") == 0
    found = [action.name for action in loaded(tmp_path / "library.blend")]
    assert found[:2] == ["day1 clip", "day1 clip 2"]
    assert [name[-1] for name in found[2:]] == ["1", "2"]
    assert all(len(name.encode()) <= 63 for name in found)
