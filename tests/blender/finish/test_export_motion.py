"""Assets with their catalogs, and exported files for other programs."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from _armatures import move_a_key
from keymark.core.body.kinematics import Body
from keymark.core.errors import InputError
from keymark.core.take.motion import Motion, read_motion
from keymark.core.take.point_files import read_points
from keymark.core.take.take import Take
from keymark.operators.bridge.actions import assign_action
from keymark.operators.bridge.armature import build_armature
from keymark.operators.bridge.asset_catalogs import NAME, ensure_catalog
from keymark.operators.bridge.export_formats import FORMATS
from keymark.operators.bridge.fcurves import write_motion
from keymark.operators.shell.base_operator import warn_if_outdated
from keymark.operators.shell.take_state import TakeState
from keymark.operators.shell.takes import active_take, add_take

ShownPoints = Callable[[bpy.types.Object], np.ndarray]


@pytest.fixture
def take(registered: None, body: Body, wave_motion: Motion) -> bpy.types.PropertyGroup:
    scene = bpy.context.scene
    scene.frame_end = 250
    result = add_take(scene, "Wave")
    result.armature = build_armature(scene, body)
    result.motion_action = write_motion(result.armature, wave_motion)
    scene.frame_set(5)
    return result


def test_a_marked_motion_comes_back_from_the_file(take: bpy.types.PropertyGroup, tmp_path: Path) -> None:
    blend = tmp_path / "library.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(blend))
    settings = take.finish
    settings.catalog, settings.tags = "Keymark/Walking", "walk, slow ,"
    settings.author, settings.license, settings.description = "A. N. Imator", "CC0", "A wave"
    bpy.ops.keymark.bake_motion()
    assert bpy.ops.keymark.mark_asset() == {"FINISHED"}
    name = settings.action.name
    bpy.ops.wm.save_as_mainfile(filepath=str(blend))
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with bpy.data.libraries.load(str(blend), assets_only=True) as (found, wanted):
        assert list(found.actions) == [name]
        wanted.actions = [name]
    action = wanted.actions[0]
    data = action.asset_data
    line = next(
        line for line in (tmp_path / NAME).read_text().splitlines() if line.startswith(data.catalog_id)
    )
    assert line == f"{data.catalog_id}:Keymark/Walking:Keymark-Walking"
    assert {tag.name for tag in data.tags} == {"walk", "slow"}
    assert (data.author, data.license, data.description) == ("A. N. Imator", "CC0", "A wave")
    assert tuple(action.preview.image_size) == (256, 256)
    pixels = np.empty(256 * 256 * 4, np.float32)
    action.preview.image_pixels_float.foreach_get(pixels)
    colors = pixels.reshape(256, 256, 4)[..., :3]
    assert colors[0, 0].min() > 0.9
    figure = (np.abs(colors - colors[0, 0]).max(axis=-1) > 0.1).mean()
    assert 0.05 < figure < 0.3  # a figure is drawn on a light ground
    assert len(action.slots) == 1


def test_an_unsaved_file_has_no_catalogs(take: bpy.types.PropertyGroup) -> None:
    with pytest.raises(RuntimeError, match="save it first, or leave Catalog empty"):
        bpy.ops.keymark.mark_asset()
    assert take.motion_action.asset_data is None
    take.finish.catalog = " "
    assert bpy.ops.keymark.mark_asset() == {"FINISHED"}
    assert take.motion_action.asset_data is not None


def test_marking_again_replaces_tags_only(take: bpy.types.PropertyGroup) -> None:
    take.finish.catalog = ""
    for tags in ("a, b", "b, c"):
        take.finish.tags = tags
        bpy.ops.keymark.mark_asset()
    assert sorted(tag.name for tag in take.motion_action.asset_data.tags) == ["b", "c"]


def test_a_catalog_file_keeps_what_is_there(tmp_path: Path) -> None:
    file = tmp_path / NAME
    before = "# mine\nVERSION 1\n\n11111111-2222-3333-4444-555555555555:Props/Chairs:Props-Chairs\n"
    file.write_text(before)
    assert ensure_catalog(file, "Props / Chairs/") == "11111111-2222-3333-4444-555555555555"
    assert file.read_text() == before
    first = ensure_catalog(file, "Props/Chairs/Thrones")
    assert file.read_text().startswith(before)
    assert [line.split(":")[1] for line in file.read_text()[len(before) :].splitlines()] == [
        "Props",  # a parent without a line would make Blender call the file changed
        "Props/Chairs/Thrones",
    ]
    written = file.read_text()
    assert ensure_catalog(file, "Props/Chairs/Thrones") == first
    assert file.read_text() == written
    assert [path.name for path in tmp_path.iterdir()] == [NAME]


@pytest.mark.parametrize(
    ("before", "catalog", "sentence"),
    [
        *((None, catalog, "is not a path of names") for catalog in ("", "/", "a:b", "a\nb")),
        ("VERSION 7\n", "Keymark", "begins with 'VERSION 7'"),
    ],
)
def test_a_catalog_that_cannot_be_is_refused_and_no_file_is_changed(
    tmp_path: Path, before: str | None, catalog: str, sentence: str
) -> None:
    file = tmp_path / NAME
    if before is not None:
        file.write_text(before)
    with pytest.raises(InputError, match=sentence):
        ensure_catalog(file, catalog)
    assert (file.read_text() if file.exists() else None) == before


def state(scene: bpy.types.Scene) -> tuple[object, ...]:
    layer = bpy.context.view_layer
    return (
        [o.name for o in layer.objects if o.select_get()],
        layer.objects.active.name,
        layer.objects.active.mode,
        (scene.frame_start, scene.frame_end, scene.frame_current, scene.use_preview_range),
        [o.animation_data.action for o in scene.objects if o.animation_data],
        [a.name for a in bpy.data.actions],
    )


IMPORTERS = {
    "BVH": lambda path: bpy.ops.import_anim.bvh(filepath=path, axis_forward="Y", axis_up="Z"),
    "FBX": lambda path: bpy.ops.import_scene.fbx(filepath=path, anim_offset=0.0),
    "GLTF": lambda path: bpy.ops.import_scene.gltf(filepath=path),
    "USD": lambda path: bpy.ops.wm.usd_import(filepath=path),
}


@pytest.mark.parametrize("kind", list(IMPORTERS))
def test_an_exported_motion_moves_alike_when_read_back(
    take: bpy.types.PropertyGroup, shown_points: ShownPoints, tmp_path: Path, kind: str
) -> None:
    if FORMATS[kind].missing():
        pytest.skip(FORMATS[kind].missing())
    if kind == "GLTF" and bpy.app.version < (5, 0) and not bpy.app.binary_path:
        pytest.skip("Blender 4.5 as a Python module may wait for ever at its exit after a glTF export")
    scene = bpy.context.scene
    scene.render.fps = 25
    bpy.ops.keymark.bake_motion()
    other = bpy.data.objects.new("Other", None)
    scene.collection.objects.link(other)
    other.select_set(True)
    bpy.context.view_layer.objects.active = take.armature
    bpy.ops.object.mode_set(mode="POSE")
    assign_action(take.armature, take.motion_action)
    before = state(scene)
    path = tmp_path / f"wave{FORMATS[kind].suffix}"
    assert bpy.ops.keymark.export_motion(format=kind, filepath=str(path)) == {"FINISHED"}
    assert state(scene) == before
    assert [file.name for file in tmp_path.iterdir()] == [path.name]
    assign_action(take.armature, take.finish.action)
    wanted = way(take.armature, "hand.L")
    known = set(bpy.data.objects)
    bpy.ops.object.mode_set(mode="OBJECT")
    IMPORTERS[kind](str(path))
    made = [o for o in bpy.data.objects if o not in known and o.type == "ARMATURE"]
    assert len(made) == 1
    assert len(made[0].data.bones) == len(take.armature.data.bones)
    bone = next(bone.name for bone in made[0].pose.bones if bone.name.replace("_", ".") == "hand.L")
    later = -1 if kind == "GLTF" else 0  # such files begin at zero
    assert way(made[0], bone, later) == pytest.approx(wanted, abs=2e-3)


@pytest.mark.parametrize("kind", ["TRC", "C3D"])
def test_joints_are_exported_as_they_show(
    take: bpy.types.PropertyGroup, shown_points: ShownPoints, tmp_path: Path, kind: str
) -> None:
    scene = bpy.context.scene
    scene.render.fps = 25
    bpy.ops.keymark.bake_motion()
    path = tmp_path / f"wave{FORMATS[kind].suffix}"
    assert bpy.ops.keymark.export_motion(format=kind, filepath=str(path)) == {"FINISHED"}
    points, rate, _ = read_points(path)
    assert rate == 25.0 and [file.name for file in tmp_path.iterdir()] == [path.name]
    assign_action(take.armature, take.finish.action)
    first = int(take.finish.action.frame_range[0])
    for index in (0, len(points) - 1):
        scene.frame_set(first + index)
        np.testing.assert_allclose(points[index], shown_points(take.armature), atol=1e-5)


def test_a_saved_motion_is_what_the_actor_shows(
    take: bpy.types.PropertyGroup, wave_motion: Motion, shown_points: ShownPoints, tmp_path: Path
) -> None:
    bpy.context.scene.render.fps = 25
    path = tmp_path / "wave.json"
    assert bpy.ops.keymark.export_motion(format="KEYMARK", filepath=str(path)) == {"FINISHED"}
    saved = read_motion(path)
    assert saved.points == pytest.approx(wave_motion.points, abs=1e-4)
    assert (saved.fps, saved.frame_start) == (25.0, 1)
    bpy.context.scene.frame_set(7)
    assert saved.points[6] == pytest.approx(shown_points(take.armature), abs=1e-4)


def way(armature_object: bpy.types.Object, bone: str, later: int = 0) -> np.ndarray:
    scene = bpy.context.scene
    places = []
    for frame in range(1, 14):
        scene.frame_set(frame + later)
        shown = armature_object.evaluated_get(bpy.context.evaluated_depsgraph_get())
        places.append(shown.matrix_world @ shown.pose.bones[bone].head)
    return np.array(places)


def test_a_failed_export_leaves_no_file_and_the_scene(take: bpy.types.PropertyGroup, tmp_path: Path) -> None:
    folder = tmp_path / "wave.bvh"
    folder.mkdir()
    bpy.ops.keymark.bake_motion()
    before = state(bpy.context.scene)
    with pytest.raises(RuntimeError, match="cannot be written"):
        bpy.ops.keymark.export_motion(format="BVH", filepath=str(folder))
    assert state(bpy.context.scene) == before
    assert list(tmp_path.iterdir()) == [folder]
    assert list(folder.iterdir()) == []


def test_a_format_that_blender_lacks_is_refused(
    take: bpy.types.PropertyGroup, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    gone = replace(FORMATS["USD"], operator_type="KEYMARK_OT_of_no_addon", addon="USD Exporter")
    monkeypatch.setitem(FORMATS, "USD", gone)
    with pytest.raises(RuntimeError, match="USD cannot be written: Enable the add-on USD Exporter"):
        bpy.ops.keymark.export_motion(format="USD", filepath=str(tmp_path / "wave.usdc"))


def test_an_export_that_is_refused_changes_nothing(take: bpy.types.PropertyGroup, tmp_path: Path) -> None:
    scene, actor = bpy.context.scene, take.armature
    layer = bpy.context.view_layer
    hidden = bpy.data.collections.new("Hidden")
    scene.collection.children.link(hidden)
    scene.collection.objects.unlink(actor)
    hidden.objects.link(actor)
    layer.layer_collection.children["Hidden"].hide_viewport = True
    other = bpy.data.objects.new("Other", bpy.data.armatures.new("Other"))
    scene.collection.objects.link(other)
    layer.objects.active = other
    bpy.ops.object.mode_set(mode="POSE")
    actor.hide_set(True)
    with pytest.raises(RuntimeError, match="is hidden with its collection"):
        bpy.ops.keymark.export_motion(format="BVH", filepath=str(tmp_path / "wave.bvh"))
    assert other.mode == "POSE" and actor.hide_get() and not list(tmp_path.iterdir())


@pytest.mark.usefixtures("registered")
def test_the_operator_is_made_from_the_registry_of_formats() -> None:
    properties = bpy.ops.keymark.export_motion.get_rna_type().properties
    menu = [(item.identifier, item.name, item.description) for item in properties["format"].enum_items]
    assert menu == [(kind, each.name, each.description) for kind, each in FORMATS.items()]
    assert properties["filter_glob"].default == "*.json;*.bvh;*.fbx;*.glb;*.usdc;*.trc;*.c3d"


@pytest.mark.usefixtures("registered")
def test_a_final_action_of_an_earlier_motion_says_so(tiny_take: Take, tmp_path: Path) -> None:
    bpy.ops.keymark.open_take(filepath=str(tiny_take.folder))
    take = active_take(bpy.context.scene)
    take.method = "interpolation"
    bpy.ops.keymark.reconstruct()
    assert not TakeState(take).final_is_outdated and TakeState(take).next[1] == "review, then a character"
    bpy.ops.keymark.bake_motion()
    assert not TakeState(take).final_is_outdated
    bpy.ops.keymark.reconstruct()
    assert not TakeState(take).final_is_outdated  # it is the same motion
    move_a_key(take.motion_action)
    assert TakeState(take).final_is_outdated and TakeState(take).next[1] == "review, then bake again"
    said: list[tuple[set[str], str]] = []
    warn_if_outdated(SimpleNamespace(report=lambda *words: said.append(words)), take)
    assert [kind for kind, _ in said] == [{"WARNING"}] and "bake it again" in said[0][1]
    bpy.ops.keymark.bake_motion()
    warn_if_outdated(SimpleNamespace(report=lambda *words: said.append(words)), take)
    assert not TakeState(take).final_is_outdated and len(said) == 1


def test_where_nobody_is_seen_is_said_and_left_empty(
    take: bpy.types.PropertyGroup, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    bpy.context.scene.render.fps = 4  # a gap of four frames is longer than what is bridged
    for curve in take.motion_action.layers[0].strips[0].channelbags[0].fcurves:
        for point in reversed([p for p in curve.keyframe_points if 5.5 < p.co.x < 9.5]):
            curve.keyframe_points.remove(point)
    path = tmp_path / "wave.json"
    bpy.ops.keymark.export_motion(filepath=str(path), format="KEYMARK")
    assert "Nobody is seen in frames 6 to 9" in capfd.readouterr().out
    assert read_motion(path).empty == (5, 6, 7, 8)
    bpy.ops.keymark.bake_motion()
    assert "obody is seen in frames 6 to 9" in " ".join(entry.text for entry in take.notices)
