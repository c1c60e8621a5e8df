"""Libraries that come and go: loaded, dropped, edited as pose assets, saved, never overwritten silently."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import bpy
import numpy as np
import pytest
from keymark.core.body.actor import Actor
from keymark.core.body.body_volume import lower_sole_m
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture
from keymark.core.prior.keyframes import Keyframe
from keymark.core.prior.library import Library, LibraryPosture, read_library, write_library
from keymark.core.prior.registry import identifier_of, registered_libraries
from keymark.operators.bridge.actions import channelbag_for
from keymark.operators.bridge.armature import build_armature
from keymark.operators.bridge.keyframes import write_keyframes
from keymark.operators.bridge.library import add_assets, read_library_blend
from keymark.operators.bridge.pose import write_posture_curves
from keymark.operators.library import registry
from keymark.operators.library.registry import load_registered
from keymark.operators.shell.takes import add_take

RandomPosture = Callable[[int], Posture]


@pytest.fixture
def own(registered: None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The user's folder of libraries, empty; nothing comes with Keymark."""
    folder = tmp_path / "own"
    folder.mkdir()
    monkeypatch.setattr(registry, "own_folder", lambda: folder)
    monkeypatch.setattr(registry, "folders", lambda: [folder])
    return folder


@pytest.fixture
def library(random_posture: RandomPosture) -> Library:
    postures = tuple(LibraryPosture(name, random_posture(seed)) for seed, name in enumerate(("A", "B")))
    return Library("small", "Small", 2, "A. Person", "CC0-1.0", Actor.from_stature(1.7), postures)


def imported(library: Library, folder: Path, **settings: bool) -> set[str]:
    write_library(folder / "offered.json", library)
    return set(bpy.ops.keymark.import_library(filepath=str(folder / "offered.json"), **settings))


def titles(folder: Path) -> list[tuple[str, str, int, int]]:
    """Identifier, title, version and number of postures of the libraries in a folder."""
    return [
        (identifier_of(entry), entry.title, entry.content.version, len(entry.content.postures))
        for entry in registered_libraries([folder])
        if entry.content is not None
    ]


def test_an_imported_library_is_at_hand(own: Path, library: Library, tmp_path: Path) -> None:
    assert imported(library, tmp_path) == {"FINISHED"}
    assert [file.name for file in own.iterdir()] == ["small.json"]
    listed = bpy.context.window_manager.keymark_shelf.libraries
    assert [(item.name, item.is_own, item.postures) for item in listed] == [("small", True, 2)]
    assert [item[0] for item in registry.library_items(None, bpy.context)] == ["small"]
    before = (own / "small.json").stat().st_mtime_ns
    assert imported(library, tmp_path) == {"FINISHED"}
    assert (own / "small.json").stat().st_mtime_ns == before
    (own / "small.json").write_text("{")
    bpy.ops.keymark.refresh_shelf()
    assert [("no valid JSON" in item.problem) for item in listed] == [True]
    assert [entry[0] for entry in registry.library_items(None, bpy.context)] == []
    (own / "small.json").unlink()
    bpy.ops.keymark.refresh_shelf()
    assert not len(listed)


def test_a_dropped_json_is_looked_into(own: Path, library: Library, tmp_path: Path) -> None:
    write_library(tmp_path / "take.json", library)  # the name does not matter
    assert bpy.ops.keymark.open_dropped(filepath=str(tmp_path / "take.json")) == {"FINISHED"}
    assert titles(own) == [("small", "Small", 2, 2)]
    for name, text, sentence in (
        ("take.json", '{"clip": "no.mp4"}', "is missing"),
        # Beside a take.json, which was not meant.
        ("mine.json", '{"clip": "no.mp4"}', r"mine\.json: a take's file is called take\.json"),
        ("other.json", "{}", "neither a take's take.json nor a keyframe library"),
        ("bad.json", '{"schema": "keymark-library", "schema_version": 1}', "identifier is missing"),
    ):
        (tmp_path / name).write_text(text)
        with pytest.raises(RuntimeError, match=sentence):
            bpy.ops.keymark.open_dropped(filepath=str(tmp_path / name))


def test_a_choice_of_library_outlives_others(own: Path, library: Library, tmp_path: Path) -> None:
    take = add_take(bpy.context.scene, "Take")
    imported(library, tmp_path)
    take.matching.library = "small"
    imported(replace(library, identifier="another", title="Another"), tmp_path)
    assert [item[0] for item in registry.library_items(None, bpy.context)] == ["another", "small"]
    assert take.matching.library == "small"


@pytest.mark.parametrize("damaged", [False, True])
def test_a_file_that_only_has_the_name_is_not_lost(
    own: Path, library: Library, tmp_path: Path, damaged: bool
) -> None:
    there = own / "small.json"
    write_library(there, replace(library, identifier="anna", title="Anna"))
    before = b"{" if damaged else there.read_bytes()
    there.write_bytes(before)
    with pytest.raises(RuntimeError, match=r"small\.json: holds .* would be lost"):
        imported(library, tmp_path, replace=True)
    assert there.read_bytes() == before


def test_libraries_are_the_same_objects_until_a_file_changes(
    own: Path, library: Library, tmp_path: Path
) -> None:
    imported(library, tmp_path)
    first = registry.all_libraries()
    assert registry.all_libraries() is first
    imported(replace(library, identifier="another", title="Another"), tmp_path)
    assert [each.identifier for each in registry.all_libraries()] == ["another", "small"]


def test_another_version_needs_to_be_asked_for(own: Path, library: Library, tmp_path: Path) -> None:
    imported(library, tmp_path)
    newer = replace(library, version=3, postures=library.postures[:1])
    with pytest.raises(
        RuntimeError, match="there in version 2 by A. Person, and this is version 3 .*Replace"
    ):
        imported(newer, tmp_path)
    assert titles(own) == [("small", "Small", 2, 2)]
    imported(newer, tmp_path, replace=True)
    assert titles(own) == [("small", "Small", 3, 1)]
    (own / "small.json").rename(own / "a copy.json")  # under another name, an older version replaces it too
    imported(library, tmp_path, replace=True)
    assert titles(own) == [("small", "Small", 2, 2)]


def saved(path: Path, **settings: str) -> Library:
    assert bpy.ops.keymark.export_library(filepath=str(path), **settings) == {"FINISHED"}
    return (read_library_blend(path)[0]) if path.suffix == ".blend" else read_library(path)


def same(first: Library, second: Library) -> bool:
    return first.to_json() == second.to_json()


@pytest.mark.parametrize("suffix", [".json", ".blend"])
def test_a_library_is_saved_and_loaded_without_loss(
    own: Path, library: Library, tmp_path: Path, suffix: str
) -> None:
    imported(library, tmp_path)
    path = tmp_path / f"again{suffix}"
    assert same(saved(path), library)
    (own / "small.json").unlink()
    assert bpy.ops.keymark.import_library(filepath=str(path)) == {"FINISHED"}
    assert same(load_registered("small"), library)


def test_a_library_is_edited_as_pose_assets(own: Path, library: Library, tmp_path: Path) -> None:
    imported(library, tmp_path)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "work.blend"))
    assert bpy.ops.keymark.edit_library(library="small") == {"FINISHED"}
    assert "Keymark/Small" in (tmp_path / "blender_assets.cats.txt").read_text(encoding="utf-8")
    with pytest.raises(RuntimeError, match="is in this file already"):
        bpy.ops.keymark.edit_library(library="small")
    assert same(saved(tmp_path / "back.json", source="ASSETS"), library)
    bpy.data.actions["A"].name = "Upright"
    assert [each.name for each in saved(tmp_path / "b.json", source="ASSETS").postures] == ["Upright", "B"]


def test_pose_assets_that_blender_made_of_the_actor_join_the_library(
    own: Path, library: Library, body: Body, random_posture: RandomPosture, tmp_path: Path
) -> None:
    take = add_take(bpy.context.scene, "Take")
    take.armature = build_armature(bpy.context.scene, body)
    mine = bpy.data.actions.new("Raised")
    write_posture_curves(mine, body, random_posture(7))
    other = bpy.data.actions.new("Other Rig")
    channelbag_for(other).fcurves.new('pose.bones["tail"].location', index=0).keyframe_points.insert(1, 0.0)
    motion = mine.copy()
    for curve in motion.layers[0].strips[0].channelbags[0].fcurves:
        curve.keyframe_points.insert(20, 0.0)
    for action in (mine, other, motion):
        action.asset_mark()
    alone = saved(tmp_path / "own.json", source="ASSETS", title="Mine", author="Anna")
    assert (alone.identifier, alone.author) == ("mine", "Anna")
    assert [each.name for each in alone.postures] == ["Raised"]
    assert alone.actor.stature_m == pytest.approx(body.actor.stature_m, rel=1e-6)
    soles = lower_sole_m(Body(alone.actor), alone.postures[0].posture)
    assert float(soles) == pytest.approx(0.0, abs=1e-6)
    imported(library, tmp_path)
    bpy.ops.keymark.edit_library(library="small")
    joined = saved(tmp_path / "joined.json", source="ASSETS")
    assert (joined.identifier, [each.name for each in joined.postures]) == ("small", ["A", "B", "Raised"])
    assert joined.actor.stature_m == pytest.approx(1.7)
    assert float(lower_sole_m(Body(joined.actor), joined.postures[2].posture)) == pytest.approx(0.0, abs=1e-6)
    assert joined.postures[2].posture.angles == pytest.approx(alone.postures[0].posture.angles, abs=1e-5)


def test_of_several_libraries_among_the_pose_assets_one_is_chosen(
    own: Path, library: Library, tmp_path: Path
) -> None:
    with pytest.raises(RuntimeError, match="no pose assets of a library"):
        bpy.ops.keymark.export_library(filepath=str(tmp_path / "c.json"), source="ASSETS")
    for identifier in ("small", "other"):
        add_assets(replace(library, identifier=identifier))
    with pytest.raises(RuntimeError, match="pose assets of small, other; choose one"):
        bpy.ops.keymark.export_library(filepath=str(tmp_path / "c.json"), source="ASSETS")
    assert saved(tmp_path / "c.json", source="ASSETS", library="other").identifier == "other"


def test_what_was_posed_becomes_a_library(
    own: Path, body: Body, random_posture: RandomPosture, tmp_path: Path
) -> None:
    scene = bpy.context.scene
    scene.render.fps = 20
    take = add_take(scene, "Bow")
    take.armature = build_armature(scene, body)
    with pytest.raises(RuntimeError, match="has no keyframes"):
        bpy.ops.keymark.export_library(filepath=str(tmp_path / "c.json"), source="KEYFRAMES")
    take.keyframe_action = bpy.data.actions.new("Posed")
    posed = [Keyframe(index, random_posture(index), 0.0) for index in (0, 5, 9)]
    write_keyframes(take.armature, take.keyframe_action, posed, np.arange(1.0, 11.0))
    library = saved(tmp_path / "bow.json", source="KEYFRAMES")
    assert (library.title, library.identifier, len(library.postures)) == ("Bow", "bow", 3)
    assert [step.time_s for step in library.motions[0].steps] == pytest.approx([0.0, 0.25, 0.45])
    own_body = Body(library.actor)
    together = Posture.stack([each.posture for each in library.postures])
    assert float(lower_sole_m(own_body, together).min()) == pytest.approx(0.0, abs=1e-6)
    first = together.translation[0]
    assert first[:2] == pytest.approx([0.0, 0.0], abs=1e-6)
    apart = np.linalg.norm(np.diff([frame.posture.translation for frame in posed], axis=0), axis=1)
    assert np.linalg.norm(np.diff(together.translation, axis=0), axis=1) == pytest.approx(apart, abs=1e-4)


def test_a_files_ending_tells_its_format(own: Path, library: Library, tmp_path: Path) -> None:
    imported(library, tmp_path)
    bpy.ops.keymark.export_library(filepath=str(tmp_path / "a.blend"), format="BLEND")
    bpy.ops.keymark.export_library(filepath=str(tmp_path / "b.json"), format="BLEND")
    bpy.ops.keymark.export_library(filepath=str(tmp_path / "v1.2"), format="JSON")
    assert {path.name for path in tmp_path.glob("*.*")} >= {"a.blend", "b.json", "v1.2.json"}
    assert not list(tmp_path.glob("b.json.*"))


def test_the_open_file_is_not_replaced_by_a_library(own: Path, library: Library, tmp_path: Path) -> None:
    imported(library, tmp_path)
    path = tmp_path / "work.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    before = path.read_bytes()
    with pytest.raises(RuntimeError, match="is the open file"):
        bpy.ops.keymark.export_library(filepath=str(path))
    assert path.read_bytes() == before


def test_catalogs_lie_at_the_root_of_an_asset_library(own: Path, library: Library, tmp_path: Path) -> None:
    imported(library, tmp_path)
    root = tmp_path / "assets"
    (root / "mine").mkdir(parents=True)
    listed = bpy.context.preferences.filepaths.asset_libraries
    known = listed.new(name="Mine", directory=str(root))
    try:
        before = set(bpy.data.user_map())
        saved(root / "mine" / "small.blend")
        assert set(bpy.data.user_map()) == before
        files = sorted(str(file.relative_to(root)) for file in root.rglob("*") if file.is_file())
        assert files == ["blender_assets.cats.txt", str(Path("mine", "small.blend"))]
        (root / "blender_assets.cats.txt").write_bytes(b"\xff\xfe")
        with pytest.raises(RuntimeError) as caught:
            bpy.ops.keymark.export_library(filepath=str(root / "mine" / "more.blend"))
        assert str(root / "blender_assets.cats.txt") in str(caught.value)
        assert not (root / "mine" / "more.blend").exists()
    finally:
        listed.remove(known)
