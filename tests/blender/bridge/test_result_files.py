"""The .blend and the BVH that a conversion writes."""

from collections.abc import Callable
from pathlib import Path

import bpy
import numpy as np
import pytest
from keymark.core.errors import ConversionError
from keymark.core.take.motion import Motion
from keymark.core.take.take import Take
from keymark.operators.bridge import result_files
from keymark.operators.bridge.result_files import write_scene

KINDS = (
    "scenes",
    "objects",
    "meshes",
    "armatures",
    "cameras",
    "materials",
    "actions",
    "movieclips",
    "worlds",
)


def blocks() -> dict[str, list[str]]:
    return {kind: [block.name for block in getattr(bpy.data, kind)] for kind in KINDS}


@pytest.fixture
def written(tmp_path: Path, tiny_take: Take, wave_motion: Motion) -> Path:
    folder = tmp_path / "out"
    folder.mkdir()
    write_scene(tiny_take, wave_motion, folder / "motion.blend", folder / "motion.bvh")
    return folder


def test_the_file_reopens_with_motion_footage_and_body(
    written: Path, wave_motion: Motion, shown_points: Callable[[bpy.types.Object], np.ndarray]
) -> None:
    assert (written / "motion.blend").read_bytes()[:4] == b"\x28\xb5\x2f\xfd"  # compressed
    bpy.ops.wm.open_mainfile(filepath=str(written / "motion.blend"))
    scene, by_type = bpy.context.scene, {thing.type: thing for thing in bpy.data.objects}
    assert by_type["ARMATURE"].animation_data.action_slot is not None
    for frame, points in zip(wave_motion.scene_frames, wave_motion.points, strict=True):
        scene.frame_set(int(frame))
        assert shown_points(by_type["ARMATURE"]) == pytest.approx(points, abs=1e-5)
    (clip,) = bpy.data.movieclips
    assert clip.filepath == "//../tiny/clip.mp4" and tuple(clip.size) == (160, 120)
    assert (scene.frame_start, scene.frame_end, scene.active_clip) == (1, 13, clip)
    assert scene.camera.data.background_images[0].clip == clip
    mesh = by_type["MESH"]
    worn = ["trunk", "forearm.L", "forearm.R", "shin.L", "shin.R"]
    assert [material.name for material in mesh.data.materials][1:] == worn
    assert mesh.modifiers[0].object.type == "ARMATURE"
    assert {polygon.material_index for polygon in mesh.data.polygons} == set(range(6))


def test_the_bvh_holds_every_frame_and_comes_back_right(
    written: Path, wave_motion: Motion, shown_points: Callable[[bpy.types.Object], np.ndarray]
) -> None:
    lines = (written / "motion.bvh").read_text().splitlines()
    assert "Frames: 13" in lines
    assert float(next(line for line in lines if "Frame Time" in line).split()[-1]) == pytest.approx(0.04)
    bpy.ops.import_anim.bvh(filepath=str(written / "motion.bvh"), axis_forward="Y", axis_up="Z")
    actor = next(o for o in bpy.data.objects if o.type == "ARMATURE")
    for frame in (1, 7, 13):
        bpy.context.scene.frame_set(frame)
        assert shown_points(actor) == pytest.approx(wave_motion.points[frame - 1], abs=1e-4)


def test_the_open_file_is_not_touched(tmp_path: Path, tiny_take: Take, wave_motion: Motion) -> None:
    mine = bpy.data.objects.new("Actor", bpy.data.meshes.new("Actor"))
    bpy.context.collection.objects.link(mine)
    scene = bpy.context.scene
    before = blocks()
    write_scene(tiny_take, wave_motion, tmp_path / "motion.blend", tmp_path / "motion.bvh")
    assert blocks() == before
    assert bpy.context.scene == scene
    assert bpy.context.view_layer.objects.get("Actor") == mine


def test_a_failure_leaves_no_scene_behind(
    tmp_path: Path, tiny_take: Take, wave_motion: Motion, monkeypatch: pytest.MonkeyPatch
) -> None:

    def fail(_path: Path, _blocks: set[bpy.types.ID], **_options: object) -> None:
        raise ConversionError("the disk is full")

    before = blocks()
    monkeypatch.setattr(result_files, "write_blend", fail)
    with pytest.raises(ConversionError, match="disk is full"):
        write_scene(tiny_take, wave_motion, tmp_path / "motion.blend", None)
    assert blocks() == before


def test_a_folder_that_is_not_there_is_one_sentence(
    tmp_path: Path, tiny_take: Take, wave_motion: Motion
) -> None:
    with pytest.raises(ConversionError, match="could not write"):
        write_scene(tiny_take, wave_motion, tmp_path / "nowhere" / "motion.blend", None)
