"""`keymark retarget`: a folder with the character in front of the camera, a record of it, and exports."""

import json
import shutil
from collections.abc import Callable
from pathlib import Path

import bpy
import numpy as np
import pytest
from _command_line import one_line, tree
from keymark.core.retarget.character import REQUIRED
from keymark.core.retarget.retarget_record import read_retarget_record
from keymark.operators.bridge.actions import curve_digest
from keymark.operators.bridge.export_formats import FORMATS
from keymark.operators.cli.main import main

FRAMES = 12
MADE = [".as_made.json", "character.blend", "report", "report/character.png", "retarget.json"]
Retarget = Callable[..., int]


@pytest.fixture
def output(tmp_path: Path) -> Path:
    return tmp_path / "deep" / "out"


@pytest.fixture
def retarget(result: Path, cast: Path, output: Path) -> Retarget:
    """A function that puts the motion onto the character."""

    def run(*more: str, motion: Path = result, character: str = str(cast / "anna.blend")) -> int:
        words = ["retarget", str(motion), "--character", character, "--output", str(output)]
        return main([*words, "--quiet", *more])

    return run


def opened(file: Path) -> bpy.types.Scene:
    """The scene of a .blend, opened as an animator opens it."""
    bpy.ops.wm.open_mainfile(filepath=str(file))
    return bpy.context.scene


def test_the_character_performs_as_filmed(retarget: Retarget, result: Path, output: Path) -> None:
    assert retarget() == 0
    assert sorted(tree(output)) == MADE
    bpy.ops.wm.open_mainfile(filepath=str(result / "motion.blend"))
    filmed = bpy.context.scene
    camera = np.array(filmed.camera.matrix_world)
    clip = Path(bpy.path.abspath(filmed.active_clip.filepath)).resolve()
    scene = opened(output / "character.blend")
    assert (scene.frame_start, scene.frame_end) == (1, FRAMES) and scene.render.fps == 30
    np.testing.assert_allclose(np.array(scene.camera.matrix_world), camera, atol=1e-6)
    assert Path(bpy.path.abspath(scene.active_clip.filepath)).resolve() == clip
    assert scene.active_clip.filepath.startswith("//")
    assert scene.camera.data.background_images[0].clip == scene.active_clip
    anna = scene.objects["Anna"]
    data = anna.animation_data
    assert data.action.name == "small Anna" and data.action_slot is not None
    assert [one.name for one in scene.objects if one.type == "MESH"] == ["Anna body"]
    assert [one.name for one in bpy.data.objects if one.type == "ARMATURE"] == ["Anna"]
    heads = []
    for frame in (1, FRAMES // 2):
        scene.frame_set(frame)
        shown = anna.evaluated_get(bpy.context.evaluated_depsgraph_get())
        heads.append([tuple(shown.matrix_world @ bone.head) for bone in shown.pose.bones])
    assert np.isfinite(heads).all() and np.abs(np.subtract(*heads)).max() > 0.02


def test_the_record_says_what_was_recognized_and_how_good_it_is(
    retarget: Retarget, output: Path, cast: Path
) -> None:
    assert retarget("--legs", "fk", "--root-motion", "in-place", "--tolerance", "none") == 0
    record = read_retarget_record(output)
    assert record.take == "small" and record.character.file == "anna.blend"
    assert record.character.object == "Anna" and record.map.origin == "recognized"
    assert set(REQUIRED) <= set(record.roles) and (record.frames, record.fps) == (FRAMES, 30.0)
    assert record.options.legs == "fk" and record.options.root_motion == "in-place"
    assert record.options.tolerance_mm == 0.0 and record.limbs["leg.L"] == "fk"
    assert str(cast) not in (output / "retarget.json").read_text(encoding="utf-8")
    scene = opened(output / "character.blend")
    assert record.files == {"character.blend": curve_digest(scene.objects[record.character.object])}
    assert scene.objects["Anna"].animation_data.action.name == record.action


def test_what_a_person_has_changed_is_kept(
    retarget: Retarget, output: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    assert retarget() == 0
    scene = opened(output / "character.blend")
    scene.objects["Anna"].location.x += 1.0
    bpy.ops.wm.save_mainfile()
    mine = (output / "character.blend").read_bytes()
    capfd.readouterr()
    assert retarget("--json") == 0
    assert (output / "character (changed).blend").read_bytes() == mine
    assert (output / "character.blend").read_bytes() != mine


def test_it_says_what_it_made(retarget: Retarget, output: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert retarget("--json") == 0
    answer = json.loads(capsys.readouterr().out)
    assert sorted(answer["files"]) == [str(output / name) for name in MADE if name[0] != "." and "." in name]
    assert answer["roles"]["hips"]["bones"] == ["hips"] and answer["seconds"]["total"] > 0.0


@pytest.mark.parametrize("word", ["bvh", "fbx", "glb", "usd"])
def test_exports_hold_character_and_motion(retarget: Retarget, output: Path, word: str) -> None:
    kind = {"bvh": "BVH", "fbx": "FBX", "glb": "GLTF", "usd": "USD"}[word]
    if FORMATS[kind].missing():
        pytest.skip(FORMATS[kind].missing())
    if word == "glb" and bpy.app.version < (5, 0) and not bpy.app.binary_path:
        pytest.skip("Blender 4.5 as a Python module may wait for ever at its exit after a glTF export")
    assert retarget("--format", word) == 0
    file = output / f"character{FORMATS[kind].suffix}"
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    {
        "bvh": bpy.ops.import_anim.bvh,
        "fbx": bpy.ops.wm.fbx_import,
        "glb": bpy.ops.import_scene.gltf,
        "usd": bpy.ops.wm.usd_import,
    }[word](filepath=str(file))
    (armature,) = [one for one in bpy.data.objects if one.type == "ARMATURE"]
    assert "forearm_L" in {bone.name.replace(".", "_") for bone in armature.data.bones}
    assert len(bpy.data.actions) >= 1
    skins = [one for one in bpy.data.objects if one.type == "MESH" and one.vertex_groups]
    assert bool(skins) == (word != "bvh")


def test_a_motion_needs_no_footage(retarget: Retarget, result: Path, output: Path, tmp_path: Path) -> None:
    file = tmp_path / "lone" / "motion.json"
    file.parent.mkdir()
    shutil.copyfile(result / "motion.json", file)
    for motion in (file, file.parent):
        assert retarget(motion=motion) == 0
        scene = opened(output / "character.blend")
        assert scene.camera is None and scene.render.fps == 30
        assert (scene.frame_start, scene.frame_end) == (1, FRAMES)
        assert read_retarget_record(output).take == "lone"


def test_what_is_no_motion_is_refused(
    retarget: Retarget,
    result: Path,
    output: Path,
    cast: Path,
    tmp_path: Path,
    capfd: pytest.CaptureFixture[str],
) -> None:
    (tmp_path / "empty").mkdir()
    strange = json.loads((result / "motion.json").read_text(encoding="utf-8"))
    strange["posture"]["tail.wag"] = strange["posture"].pop("knee.L.flexion")
    (tmp_path / "strange.json").write_text(json.dumps(strange), encoding="utf-8")
    for motion, said in (
        (tmp_path / "empty", "holds no motion.json; it must be a folder that convert has written"),
        (tmp_path / "missing.json", "no such file"),
        (result / "conversion.json", "conversion.json"),
        (cast / "anna.blend", "anna.blend"),
        (tmp_path / "strange.json", "knee.L.flexion is missing"),
    ):
        assert retarget(motion=motion) == 2
        assert said in one_line(capfd.readouterr().err)
    assert not output.parent.exists()


def test_results_of_a_take_are_no_place_for_it(
    retarget: Retarget, result: Path, cast: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    before = tree(result)
    words = ["retarget", str(result), "--character", str(cast / "anna.blend"), "--output", str(result)]
    assert main([*words, "--quiet"]) == 2
    assert "holds the result of a conversion; name another folder" in one_line(capfd.readouterr().err)
    assert tree(result) == before


def test_nothing_stays_in_the_open_file(retarget: Retarget) -> None:
    mine = bpy.data.objects.new("Mine", None)
    bpy.context.scene.collection.objects.link(mine)
    before, scene = set(bpy.data.user_map()), bpy.context.scene
    assert retarget() == 0
    assert set(bpy.data.user_map()) == before and bpy.context.scene == scene


def test_the_character_of_the_open_file_is_refused(
    retarget: Retarget, cast: Path, output: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    bpy.ops.wm.open_mainfile(filepath=str(cast / "anna.blend"))
    assert retarget() == 2
    assert "is open in this Blender" in one_line(capfd.readouterr().err) and not output.parent.exists()


@pytest.mark.parametrize("clip", ["inside", "beside", "nowhere"])
def test_a_result_that_was_moved_finds_the_clip_beside_it_or_goes_on_without(
    retarget: Retarget,
    result: Path,
    output: Path,
    tmp_path: Path,
    capfd: pytest.CaptureFixture[str],
    clip: str,
) -> None:
    bpy.ops.wm.open_mainfile(filepath=str(result / "motion.blend"))
    filmed = Path(bpy.path.abspath(bpy.context.scene.active_clip.filepath)).resolve()
    moved = tmp_path / "elsewhere" / "and" / "deeper" / "still" / "moved"
    shutil.copytree(result, moved)
    place = {"inside": moved, "beside": moved.parent}.get(clip)
    if place is not None:
        shutil.copyfile(filmed, place / filmed.name)
    assert retarget("--json", motion=moved) == 0
    notes = json.loads(capfd.readouterr().out.splitlines()[-1])["notes"]
    assert any("neither where it was nor beside" in note for note in notes) == (place is None)
    scene = opened(output / "character.blend")
    assert scene.camera is not None and (output / "report" / "character.png").exists() == (place is not None)
    if place is None:
        assert scene.active_clip is None
    else:
        shown = Path(bpy.path.abspath(scene.active_clip.filepath)).resolve()
        assert shown == (place / filmed.name).resolve()


def test_a_result_reads_its_own_figures(
    retarget: Retarget, output: Path, cast: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    assert retarget("--strict") == 0 and read_retarget_record(output).warnings == ()
    capfd.readouterr()
    stiff = str(cast / "stiff.blend")
    assert retarget(character=stiff) == 0
    (warning,) = read_retarget_record(output).warnings
    assert "legs are" in warning and "arms" not in warning
    assert warning in one_line(capfd.readouterr().err)
    assert retarget("--strict", character=stiff) == 3
    assert sorted(tree(output)) == MADE
