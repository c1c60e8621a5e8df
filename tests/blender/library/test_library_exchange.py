"""Libraries that come and go: imported, dropped, installed, and never overwritten silently."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import bpy
import pytest
from keymark.core.body.actor import Actor
from keymark.core.body.posture import Posture
from keymark.core.library.library import Library, LibraryPosture
from keymark.core.library.library_file import write_library
from keymark.core.library.registry import registered_libraries
from keymark.operators.bridge.library.library_blend import read_library_blend, write_library_blend
from keymark.operators.library import registry, registry_files, user_folder
from keymark.operators.library.conflicts import resolve_conflicts
from keymark.operators.library.editing.library_to_scene import add_library
from keymark.operators.library.registry_files import find_registered, load_registered
from keymark.operators.shell.takes import add_take

RandomPosture = Callable[[int], Posture]


@pytest.fixture
def own(registered: None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The user's folder of libraries, empty; nothing comes with Keymark."""
    folder = tmp_path / "own"
    folder.mkdir()
    monkeypatch.setattr(user_folder, "own_folder", lambda: folder)
    monkeypatch.setattr(registry_files, "folders", lambda: [folder])
    return folder


@pytest.fixture
def assets(registered: None, tmp_path: Path) -> Iterator[Path]:
    """The user's only asset library."""
    listed = bpy.context.preferences.filepaths.asset_libraries
    for library in list(listed):
        listed.remove(library)
    folder = tmp_path / "assets"
    mine = listed.new(name="Mine", directory=str(folder))
    yield folder
    listed.remove(mine)


@pytest.fixture
def library(random_posture: RandomPosture) -> Library:
    """A library of two postures."""
    postures = tuple(LibraryPosture(name, random_posture(seed)) for seed, name in enumerate(("A", "B")))
    return Library("small", "Small", 2, "A. Person", "CC0-1.0", Actor.from_stature(1.7), postures)


def imported(library: Library, folder: Path, **settings: str) -> set[str]:
    """Write a library and import it."""
    write_library(folder / "offered.json", library)
    return set(bpy.ops.keymark.import_library(filepath=str(folder / "offered.json"), **settings))


def titles(folder: Path) -> list[tuple[str, str, int, int]]:
    """Identifier, title, version and number of postures of the libraries in a folder."""
    return [
        (entry.identifier, entry.title, entry.version, len(entry.library.postures))
        for entry in registered_libraries([folder])
        if entry.library is not None
    ]


def test_an_imported_library_is_at_hand(own: Path, library: Library, tmp_path: Path) -> None:
    """In the user's folder, in the list and in menus; imported again, nothing happens."""
    assert imported(library, tmp_path) == {"FINISHED"}
    assert [file.name for file in own.iterdir()] == ["small.json"]
    listed = bpy.context.window_manager.keymark_shelf.libraries
    assert [(item.name, item.is_own, [p.name for p in item.postures]) for item in listed] == [
        ("small", True, ["A", "B"])
    ]
    assert [item[0] for item in registry.library_items(None, bpy.context)] == ["small"]
    before = (own / "small.json").stat().st_mtime_ns
    assert imported(library, tmp_path) == {"FINISHED"}
    assert (own / "small.json").stat().st_mtime_ns == before
    bpy.ops.keymark.discard_library()
    assert list(own.iterdir()) == [] and not len(listed)


@pytest.mark.parametrize(
    ("choice", "expected"),
    [
        ("KEEP", [("small", "Small", 2, 2)]),
        ("REPLACE", [("small", "Small", 3, 2)]),
        ("MERGE", [("small", "Small", 4, 3)]),
        ("BOTH", [("small", "Small", 2, 2), ("small_2", "Small 2", 3, 2)]),
    ],
)
def test_another_version_is_asked_about(
    own: Path, library: Library, tmp_path: Path, choice: str, expected: list[tuple[str, str, int, int]]
) -> None:
    """Without a choice nothing changes and the report names the library; then the choice is applied."""
    imported(library, tmp_path)
    first, second = library.postures
    newer = replace(library, version=3, postures=(first, replace(second, name="C")))
    with pytest.raises(RuntimeError, match="there in version 2 by A. Person; this is version 3 .* newer"):
        imported(newer, tmp_path)
    assert titles(own) == [("small", "Small", 2, 2)]
    imported(newer, tmp_path, existing=choice)
    assert titles(own) == expected


def test_a_dropped_json_is_looked_into(own: Path, library: Library, tmp_path: Path) -> None:
    """A library is imported, a take is opened or its error is reported, other files are refused."""
    write_library(tmp_path / "take.json", library)  # the name does not matter
    assert bpy.ops.keymark.open_dropped(filepath=str(tmp_path / "take.json")) == {"FINISHED"}
    assert titles(own) == [("small", "Small", 2, 2)]
    (tmp_path / "take.json").write_text('{"clip": "no.mp4"}')
    with pytest.raises(RuntimeError, match="is missing"):
        bpy.ops.keymark.open_dropped(filepath=str(tmp_path / "take.json"))
    (tmp_path / "mine.json").write_text('{"clip": "no.mp4"}')  # beside a take.json, which was not meant
    with pytest.raises(RuntimeError, match=r"mine\.json: a take's file is called take\.json"):
        bpy.ops.keymark.open_dropped(filepath=str(tmp_path / "mine.json"))
    (tmp_path / "other.json").write_text("{}")
    with pytest.raises(RuntimeError, match="neither a take's take.json nor a keyframe library"):
        bpy.ops.keymark.open_dropped(filepath=str(tmp_path / "other.json"))
    (tmp_path / "bad.json").write_text('{"schema": "keymark-library", "schema_version": 1}')
    with pytest.raises(RuntimeError, match="identifier is missing"):
        bpy.ops.keymark.open_dropped(filepath=str(tmp_path / "bad.json"))


def test_a_library_is_installed_for_the_asset_browser(
    own: Path, assets: Path, library: Library, tmp_path: Path
) -> None:
    """A .blend of its own, with catalogs at the root; another version is asked about; nothing stays."""
    imported(library, tmp_path)
    before = set(bpy.data.user_map())
    assert bpy.ops.keymark.install_library(library="small") == {"FINISHED"}
    assert sorted(str(f.relative_to(assets)) for f in assets.rglob("*") if f.is_file()) == [
        "blender_assets.cats.txt",
        str(Path("keymark", "small.blend")),
    ]
    blend = assets / "keymark" / "small.blend"
    assert read_library_blend(blend)[0].version == 2
    stamp = blend.stat().st_mtime_ns
    bpy.ops.keymark.install_library(library="small")
    assert blend.stat().st_mtime_ns == stamp  # the same already
    imported(replace(library, version=5), tmp_path, existing="REPLACE")
    with pytest.raises(RuntimeError, match="version 5 by A. Person, which is newer"):
        bpy.ops.keymark.install_library(library="small")
    assert read_library_blend(blend)[0].version == 2
    bpy.ops.keymark.install_library(library="small", existing="REPLACE")
    assert read_library_blend(blend)[0].version == 5
    assert set(bpy.data.user_map()) == before


def test_without_an_asset_library_the_preferences_are_named(own: Path, library: Library) -> None:
    """The tooltip names the place in the preferences."""
    listed = bpy.context.preferences.filepaths.asset_libraries
    for known in list(listed):
        listed.remove(known)
    with pytest.raises(RuntimeError, match="Add an asset library in the preferences first"):
        bpy.ops.keymark.install_shipped_libraries()


def test_a_selection_is_exported(own: Path, library: Library, tmp_path: Path) -> None:
    """Only marked postures; none marked is refused."""
    imported(library, tmp_path)
    bpy.ops.keymark.edit_library(library="small")
    with pytest.raises(RuntimeError, match="is in this file already"):
        bpy.ops.keymark.edit_library(library="small")
    path = tmp_path / "part.json"
    with pytest.raises(RuntimeError, match="No posture of 'Small' is selected"):
        bpy.ops.keymark.export_library(filepath=str(path), only_selected=True)
    bpy.context.scene.keymark.libraries[0].postures[1].selected = True
    bpy.ops.keymark.export_library(filepath=str(path), only_selected=True)
    imported_again = bpy.ops.keymark.import_library(filepath=str(path), existing="BOTH")
    assert imported_again == {"FINISHED"}
    assert titles(own) == [("small", "Small", 2, 2), ("small_2", "Small 2", 2, 1)]


def test_a_files_ending_tells_its_format(own: Path, library: Library, tmp_path: Path) -> None:
    """The suffix decides, not the last export; the format property decides for other suffixes."""
    add_library(bpy.context.scene, library)
    bpy.ops.keymark.export_library(filepath=str(tmp_path / "a.blend"), format="BLEND")
    bpy.ops.keymark.export_library(filepath=str(tmp_path / "b.json"), format="BLEND")
    bpy.ops.keymark.export_library(filepath=str(tmp_path / "v1.2"), format="JSON")
    assert {path.name for path in tmp_path.glob("*.*")} >= {"a.blend", "b.json", "v1.2.json"}
    assert not list(tmp_path.glob("b.json.*"))


def test_the_posture_to_apply_is_one_of_the_chosen_librarys(
    own: Path, library: Library, tmp_path: Path
) -> None:
    """After choosing another library, the posture to apply is one of that library."""
    other = replace(library, identifier="other", title="Other", postures=library.postures[1:])
    imported(library, tmp_path)
    at_hand = bpy.context.window_manager.keymark_shelf
    assert at_hand.posture == "A"
    imported(other, tmp_path)
    assert (at_hand.libraries[at_hand.active].name, at_hand.posture) == ("other", "B")


def test_a_library_of_this_file_is_published_for_matching(own: Path, library: Library) -> None:
    """In its present state; after a change, the published one is not replaced unasked."""
    add_library(bpy.context.scene, library)
    bpy.ops.keymark.keep_library()
    assert titles(own) == [("small", "Small", 2, 2)]
    bpy.ops.keymark.remove_posture()
    with pytest.raises(RuntimeError, match="same version, but not the same"):
        bpy.ops.keymark.keep_library()
    bpy.ops.keymark.keep_library(existing="REPLACE")
    assert titles(own) == [("small", "Small", 2, 1)]


def test_a_choice_of_library_outlives_others(own: Path, library: Library, tmp_path: Path) -> None:
    """The stored number means the same library after another one is listed before it."""
    take = add_take(bpy.context.scene, "Take")
    imported(library, tmp_path)
    take.matching.library = "small"
    imported(replace(library, identifier="another", title="Another"), tmp_path)
    assert [item[0] for item in registry.library_items(None, bpy.context)] == ["another", "small"]
    assert take.matching.library == "small"


def test_a_damaged_file_in_the_registry_is_listed_as_such(own: Path) -> None:
    """With the reason, and it can be deleted."""
    (own / "broken.json").write_text("{")
    bpy.ops.keymark.refresh_shelf()
    item = bpy.context.window_manager.keymark_shelf.libraries[0]
    assert "no valid JSON" in item.problem
    assert [entry[0] for entry in registry.library_items(None, bpy.context)] == []
    bpy.ops.keymark.discard_library()
    assert list(own.iterdir()) == []


def test_pose_assets_brought_by_other_means_are_gathered(own: Path, library: Library, tmp_path: Path) -> None:
    """Appended as Blender does, they become a library of this file again, to the last byte."""
    write_library_blend(tmp_path / "small.blend", library)
    with bpy.data.libraries.load(str(tmp_path / "small.blend")) as (found, wanted):
        wanted.actions = found.actions
    count = len(bpy.data.actions)
    assert bpy.ops.keymark.gather_library() == {"FINISHED"}
    assert len(bpy.data.actions) == count
    bpy.ops.keymark.export_library(filepath=str(tmp_path / "back.json"))
    write_library(tmp_path / "first.json", library)
    assert (tmp_path / "back.json").read_bytes() == (tmp_path / "first.json").read_bytes()
    with pytest.raises(RuntimeError, match="no pose assets of a library that is not listed"):
        bpy.ops.keymark.gather_library()


def test_two_that_come_at_once_do_not_get_one_name(own: Path, library: Library, tmp_path: Path) -> None:
    """A .blend may hold the very library whose name another one of it would get."""
    imported(library, tmp_path)
    first = replace(library, version=3)
    second = replace(library, identifier="small_2", title="Quite different")
    kept = resolve_conflicts([first, second], find_registered, "BOTH")
    assert [(one.identifier, one.title) for one in kept] == [
        ("small_3", "Small 2"),
        ("small_2", "Quite different"),
    ]


@pytest.mark.parametrize("content", ["another", "damaged"])
def test_a_file_that_only_has_the_name_is_not_lost(
    own: Path, library: Library, tmp_path: Path, content: str
) -> None:
    """Files that people have put into the folder themselves may hold anything."""
    there = own / "small.json"
    if content == "another":
        write_library(there, replace(library, identifier="anna", title="Anna"))
    else:
        there.write_text("{")
    before = there.read_bytes()
    with pytest.raises(RuntimeError, match=r"small\.json: holds .* would be lost"):
        imported(library, tmp_path, existing="REPLACE")
    assert there.read_bytes() == before


def test_an_older_version_that_shall_replace_does(own: Path, library: Library, tmp_path: Path) -> None:
    """Also where the newer one lies in a file of another name."""
    write_library(own / "a copy.json", replace(library, version=7))
    imported(library, tmp_path, existing="REPLACE")
    assert titles(own) == [("small", "Small", 2, 2)]


def test_a_title_does_not_stand_for_another_librarys_name(own: Path, library: Library) -> None:
    """Libraries are found by identifier, even where another library's title equals it."""
    write_library(own / "a.json", replace(library, identifier="zzz", title="small"))
    write_library(own / "small.json", replace(library, title="Zoo"))
    assert load_registered("small").title == "Zoo"


def test_the_open_file_is_not_replaced_by_an_export(own: Path, library: Library, tmp_path: Path) -> None:
    """Only pose assets would be left of it."""
    add_library(bpy.context.scene, library)
    path = tmp_path / "work.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    before = path.read_bytes()
    with pytest.raises(RuntimeError, match="is the open file"):
        bpy.ops.keymark.export_library(format="BLEND", filepath=str(path))
    assert path.read_bytes() == before


def test_a_damaged_file_of_catalogs_is_named_where_it_is(own: Path, assets: Path, library: Library) -> None:
    """And left as it is; nothing is installed beside it."""
    write_library(own / "small.json", library)
    assets.mkdir()
    (assets / "blender_assets.cats.txt").write_bytes(b"\xff\xfe")
    with pytest.raises(RuntimeError) as caught:
        bpy.ops.keymark.install_library(library="small")
    assert str(assets / "blender_assets.cats.txt") in str(caught.value)
    assert [file.name for file in assets.iterdir()] == ["blender_assets.cats.txt"]


def test_libraries_are_the_same_objects_until_a_file_changes(
    own: Path, library: Library, tmp_path: Path
) -> None:
    """What was made of them is kept by the objects."""
    imported(library, tmp_path)
    first = registry_files.all_libraries()
    assert registry_files.all_libraries() is first
    imported(replace(library, identifier="another", title="Another"), tmp_path)
    assert [each.identifier for each in registry_files.all_libraries()] == ["another", "small"]
