"""Open Example: ready to reconstruct, unsaved or copied, and nothing half done."""

import json
from pathlib import Path

import bpy
import pytest
from _scene_state import differences, scene_state
from keymark.core.take import examples
from keymark.core.take.examples import COPIED, SHIPPED
from keymark.operators.shell.take_state import TakeState
from keymark.operators.shell.takes import active_take
from keymark.operators.takes import open_take as open_example

pytestmark = pytest.mark.usefixtures("registered")

AEROBIC, GREETING = "AEROBIC", "GREETING"
KEYFRAMES = {AEROBIC: 12, GREETING: 10}


def files(folder: Path) -> dict[str, bytes]:
    return {str(file.relative_to(folder)): file.read_bytes() for file in folder.rglob("*") if file.is_file()}


@pytest.mark.parametrize("name", KEYFRAMES)
def test_an_example_is_ready_to_reconstruct(name: str) -> None:
    before = files(SHIPPED)
    assert bpy.ops.keymark.open_example(example=name) == {"FINISHED"}
    take = active_take(bpy.context.scene)
    assert TakeState(take).next[1] == "reconstruct the motion"
    assert take.camera == bpy.context.scene.camera and take.armature is not None
    assert len(TakeState(take).posed) == KEYFRAMES[name]
    assert take.follow.use_contours
    assert bool(take.markers) == (name == AEROBIC) and all(marker.is_picked for marker in take.markers)
    assert take.follow.use_keypoints == (name == GREETING) and len(take.follow.files) == 1
    assert bpy.data.filepath == "" and files(SHIPPED) == before


def test_every_example_is_offered_and_there() -> None:
    assert {name.lower() for name, _, _ in open_example.EXAMPLES} == {
        folder.name for folder in SHIPPED.iterdir()
    }


def test_the_keyframes_are_those_of_a_person() -> None:
    bpy.ops.keymark.open_example(example=AEROBIC)
    take = active_take(bpy.context.scene)
    pelvis = take.armature.pose.bones["pelvis"]
    bpy.context.scene.frame_set(1)
    shown = list(take.armature.matrix_world @ pelvis.head)
    posed, exact = (
        json.loads((SHIPPED / "aerobic" / file).read_text(encoding="utf-8"))["keyframes"][0]["points"]
        for file in ("keyframes_noisy.json", "keyframes.json")
    )

    def hips(points: dict[str, list[float]]) -> list[float]:
        return [0.5 * (a + b) for a, b in zip(points["hip.L"], points["hip.R"], strict=True)]

    assert shown == pytest.approx(hips(posed), abs=1e-4)
    assert shown != pytest.approx(hips(exact), abs=1e-3)


def test_a_copy_is_a_take_of_its_own(tmp_path: Path) -> None:
    assert bpy.ops.keymark.open_example(example=GREETING, copy=True, directory=str(tmp_path)) == {"FINISHED"}
    copy = tmp_path / "greeting"
    assert {file.name for file in copy.iterdir()} == set(COPIED.values())
    assert {file.name for file in tmp_path.iterdir()} == {"greeting"}
    take = active_take(bpy.context.scene)
    assert Path(bpy.path.abspath(take.clip.filepath)) == copy / "clip.mp4"
    frames = TakeState(take).posed
    bpy.ops.keymark.open_take(filepath=str(copy))
    assert TakeState(active_take(bpy.context.scene)).posed == frames


def test_a_copy_that_is_there_already_is_opened(tmp_path: Path) -> None:
    bpy.ops.keymark.open_example(copy=True, directory=str(tmp_path))
    before = {file: file.stat().st_mtime_ns for file in (tmp_path / "aerobic").iterdir()}
    assert bpy.ops.keymark.open_example(copy=True, directory=str(tmp_path)) == {"FINISHED"}
    assert {file: file.stat().st_mtime_ns for file in (tmp_path / "aerobic").iterdir()} == before
    assert len(bpy.context.scene.keymark.takes) == 2


@pytest.mark.parametrize("changed", ["keyframes.json", "take.json"])
def test_a_copy_that_somebody_works_in_is_left_alone(tmp_path: Path, changed: str) -> None:
    bpy.ops.keymark.open_example(copy=True, directory=str(tmp_path))
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    (tmp_path / "aerobic" / changed).write_text("mine", encoding="utf-8")
    before, scene = files(tmp_path), scene_state()
    with pytest.raises(RuntimeError, match="no unchanged copy of the example; open it with Open Take"):
        bpy.ops.keymark.open_example(copy=True, directory=str(tmp_path))
    assert files(tmp_path) == before and not differences(scene, scene_state())


@pytest.mark.parametrize("folder", ["file", "new"])
def test_a_copy_that_fails_leaves_no_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, folder: str
) -> None:
    if folder == "file":
        (tmp_path / "file").write_text("", encoding="utf-8")
    monkeypatch.setattr(examples, "COPIED", {**COPIED, "missing.json": "missing.json"})
    before, scene = files(tmp_path), scene_state()
    with pytest.raises(RuntimeError, match=r"missing\.json|cannot be written"):
        bpy.ops.keymark.open_example(copy=True, directory=str(tmp_path / folder))
    assert files(tmp_path) == before and not differences(scene, scene_state())


def test_what_is_missing_is_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(RuntimeError, match="name the folder to copy the example to"):
        bpy.ops.keymark.open_example(copy=True)
    monkeypatch.setattr(examples, "SHIPPED", tmp_path)
    with pytest.raises(RuntimeError, match="missing from the installation; install Keymark anew"):
        bpy.ops.keymark.open_example()


def test_a_scene_with_a_take_gets_another(tmp_path: Path) -> None:
    bpy.ops.keymark.open_example(example=AEROBIC)
    first = bpy.context.scene.keymark.takes[0]
    kept = (first.armature, first.camera, first.clip, first.keyframe_action)
    bpy.ops.keymark.open_example(example=GREETING)
    first, second = bpy.context.scene.keymark.takes
    assert (first.armature, first.camera, first.clip, first.keyframe_action) == kept
    assert active_take(bpy.context.scene) == second and second.name == "greeting"
    assert second.clip != first.clip


@pytest.mark.parametrize("touched", [False, True])
def test_only_blenders_own_cube_makes_room(touched: bool) -> None:
    bpy.ops.wm.read_homefile(use_factory_startup=True)
    cube = bpy.data.objects["Cube"]
    if touched:
        cube.location.x = 0.2
        bpy.context.view_layer.update()
    bpy.ops.keymark.open_example()
    assert cube.hide_get() != touched
