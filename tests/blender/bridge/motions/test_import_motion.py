"""Animated armatures out of files: at their own rate, in a person's size, recognized or refused."""

import json
import struct
from pathlib import Path

import bpy
import numpy as np
import pytest
from keymark.core.errors import InputError
from keymark.core.take.conversion_settings import CharacterFile
from keymark.operators.bridge.blend_files import own_scene, showing_scene
from keymark.operators.bridge.export_formats import FORMATS, export_motion
from keymark.operators.bridge.motions.action_names import action_names
from keymark.operators.bridge.motions.import_motion import import_motion, load_motion
from keymark.operators.bridge.motions.read_poses import joint_paths


@pytest.fixture
def exported(shaken: bpy.types.Object, tmp_path: Path) -> Path:
    """The shaken armature as a file of every kind, at 60 frames a second."""
    bpy.context.scene.render.fps = 60
    for kind in ("BVH", "FBX", *(("USD",) if bpy.app.build_options.usd else ())):
        chosen = FORMATS[kind]
        path = tmp_path / f"motion{chosen.suffix}"
        export_motion(bpy.context.scene, shaken, shaken.animation_data.action, (1, 45), chosen, path)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "motion.blend"), copy=True)
    return tmp_path


WITHOUT_USD = pytest.mark.skipif(not bpy.app.build_options.usd, reason="this Blender is built without USD")


@pytest.mark.parametrize("ending", ["bvh", "fbx", pytest.param("usdc", marks=WITHOUT_USD), "blend"])
def test_rate_size_and_joints_are_the_files(exported: Path, shaken: bpy.types.Object, ending: str) -> None:
    bpy.context.scene.frame_start, bpy.context.scene.frame_end = 1, 45
    wanted, _ = joint_paths(shaken)
    with own_scene("Motion") as scene, showing_scene(scene):
        imported, chosen = import_motion(CharacterFile(exported / f"motion.{ending}"), scene)
        assert scene.render.fps / scene.render.fps_base == pytest.approx(60.0)
        assert scene.frame_end - scene.frame_start == 44 and scene.frame_start in (1, 2)
        assert chosen.character_map.bone("forearm.L") in ("forearm.L", "forearm_L")
        points, rate = joint_paths(imported.armature)
        legs = [np.linalg.norm(each[:, 9] - each[:, 11], axis=1) for each in (points, wanted)]
        np.testing.assert_allclose(*legs, atol=2e-3)
        bends = [np.linalg.norm(each[:, 5] - each[:, 1], axis=1) for each in (points, wanted)]
        np.testing.assert_allclose(*bends, atol=6e-3)
    assert "Motion" not in bpy.data.scenes


def test_one_of_several_actions_is_taken_said_and_named(shaken: bpy.types.Object, tmp_path: Path) -> None:
    own, file = shaken.animation_data.action, CharacterFile(tmp_path / "motion.blend")
    walk, loose = own.copy(), own.copy()
    walk.name, loose.name, loose.use_fake_user = "Walk", "Loose", True
    shaken.animation_data.nla_tracks.new().strips.new("Walk", 1, walk)
    bpy.data.actions.new("Camera").use_fake_user = True
    bpy.ops.wm.save_as_mainfile(filepath=str(file.path), copy=True)
    every = f"'{own.name}', 'Walk', 'Loose'"
    for wanted in (None, "Walk", "Loose"):
        with own_scene("Motion") as scene, showing_scene(scene):
            imported, _ = import_motion(file, scene, (), wanted)
            taken = imported.armature.animation_data.action.name
            assert taken.startswith(wanted or own.name)
            assert all(track.mute for track in imported.armature.animation_data.nla_tracks)
        said = f"has 3 Actions, {every}; the motion is that of '{own.name}', and mend --action names another"
        assert [note for note in imported.notes if said in note] == list(imported.notes)[: wanted is None]
    with pytest.raises(InputError, match=f"has no Action 'Run'; its Actions are {every}"):
        load_motion(file, bpy.context.scene, (), "Run")
    assert {own.name, "Walk", "Loose"} <= set(action_names(file.path)) and not bpy.data.libraries


@pytest.mark.parametrize("ending", ["glb", "gltf", "vrm"])
def test_a_menu_offers_the_actions_of_a_gltf(tmp_path: Path, ending: str) -> None:
    text = json.dumps({"animations": [{"name": "A_Idle"}, {}, {"name": "Walk"}]}).encode()
    head = (
        b"" if ending == "gltf" else struct.pack("<4sIII4s", b"glTF", 2, 20 + len(text), len(text), b"JSON")
    )
    file = tmp_path / f"pack.{ending}"
    file.write_bytes(head + text)
    assert action_names(file) == ["A_Idle", "Walk"]
    file.write_bytes((head + text)[:-9])
    assert action_names(file) == action_names(tmp_path / "none.blend") == action_names(tmp_path) == []


def test_a_menu_offers_the_takes_of_an_fbx(shaken: bpy.types.Object, tmp_path: Path) -> None:
    walk, file = shaken.animation_data.action.copy(), tmp_path / "pack.fbx"
    walk.name, walk.use_fake_user = "Walk", True
    for each in bpy.context.view_layer.objects:
        each.select_set(each == shaken)
    kept = {"use_selection": True, "object_types": {"ARMATURE"}, "add_leaf_bones": False}
    bpy.ops.export_scene.fbx(filepath=str(file), **kept)
    names = action_names(file)
    wanted = next(name for name in names if name.endswith("Walk"))
    assert len(names) >= 2
    with own_scene("Motion") as scene, showing_scene(scene):
        imported, notes = import_motion(CharacterFile(file), scene, (), wanted)
        assert wanted in imported.armature.animation_data.action.name
    file.write_bytes(b"Kaydara FBX Binary")
    assert action_names(file) == []


def test_a_loaded_motion_takes_as_long_as_in_its_file_and_the_scene_stays(exported: Path) -> None:
    scene = bpy.context.scene
    scene.render.fps, scene.frame_start, scene.frame_end = 24, 10, 200
    loaded, _ = load_motion(CharacterFile(exported / "motion.bvh"), scene)
    assert loaded.name in scene.objects
    first, last = loaded.animation_data.action.frame_range
    assert first == pytest.approx(10.0) and last == pytest.approx(10.0 + 44 * 24 / 60, abs=1e-3)
    assert (scene.render.fps, scene.frame_start, scene.frame_end) == (24, 10, 200)
    keys = loaded.animation_data.action.layers[0].strips[0].channelbags[0].fcurves[0].keyframe_points
    assert {key.type for key in keys} == {"GENERATED"}


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("Frame Time: 0.016667", "Frame Time: 0", "Frame Time is 0; 0.001 to 1 s are valid"),
        ("Frame Time: 0.016667", "Frame Time: soon", "Frame Time is soon"),
        ("Frames: 45", "Frames: 45000", "Frames is 45000, but it has 45 rows"),
        ("HIERARCHY", "HIER", "is no BVH"),
        ("OFFSET", "OFFSET nan", "cannot read it|not a number|no person|too few|bones"),
    ],
)
def test_a_bvh_that_lies_is_refused_and_nothing_is_added(
    exported: Path, old: str, new: str, said: str
) -> None:
    file = exported / "motion.bvh"
    text = file.read_text()
    assert old in text
    file.write_text(text.replace(old, new))
    before = {block.as_pointer() for block in bpy.data.user_map()}
    with pytest.raises(InputError, match=said):
        load_motion(CharacterFile(file), bpy.context.scene)
    assert {block.as_pointer() for block in bpy.data.user_map()} == before


def test_what_is_no_moving_person_is_refused(exported: Path, shaken: bpy.types.Object) -> None:
    with pytest.raises(InputError, match="is no motion of an armature"):
        load_motion(CharacterFile(exported / "motion.txt"), bpy.context.scene)
    bpy.ops.object.select_all(action="DESELECT")
    bpy.data.batch_remove(list(bpy.data.actions))
    bpy.ops.wm.save_as_mainfile(filepath=str(exported / "still.blend"), copy=True)
    with pytest.raises(InputError, match="has no Action, so it has no motion"):
        load_motion(CharacterFile(exported / "still.blend"), bpy.context.scene)
    snake = "HIERARCHY\nROOT A\n{\nOFFSET 0 0 0\nCHANNELS 3 Xrotation Yrotation Zrotation\nJOINT B\n{\n"
    snake += "OFFSET 0 10 0\nCHANNELS 3 Xrotation Yrotation Zrotation\nEnd Site\n{\nOFFSET 0 10 0\n}\n}\n}\n"
    snake += "MOTION\nFrames: 3\nFrame Time: 0.033333\n" + "0 0 0 0 0 0\n1 0 0 0 0 0\n2 0 0 0 0 0\n"
    (exported / "snake.bvh").write_text(snake)
    with pytest.raises(InputError, match=r"snake.bvh: .*(character|bones)"):
        load_motion(CharacterFile(exported / "snake.bvh"), bpy.context.scene)
