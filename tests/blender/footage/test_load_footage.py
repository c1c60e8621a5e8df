"""Choosing footage: from disk, dropped, from this file, and found again."""

import shutil
from pathlib import Path
from types import SimpleNamespace

import bpy
import cv2
import numpy as np
import pytest
from _panel import offered
from keymark.core.take.take import Take
from keymark.operators.footage.load_footage import KEYMARK_OT_load_footage, lens_is_guess
from keymark.operators.shell.takes import active_take
from keymark.operators.takes.open_take import KEYMARK_FH_footage, KEYMARK_FH_take, KEYMARK_OT_open_take

pytestmark = pytest.mark.usefixtures("registered")


def write_clip(path: Path, frames: int, fps: float, size: tuple[int, int] = (160, 120)) -> Path:
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter_fourcc(*"mp4v"), fps, size)
    assert writer.isOpened()
    for frame in range(frames):
        writer.write(np.full((size[1], size[0], 3), 40 + 5 * frame, np.uint8))
    writer.release()
    return path


def test_a_guessed_lens_says_so_until_another_is_set(loaded: bpy.types.PropertyGroup) -> None:
    assert lens_is_guess(loaded)
    loaded.camera.data.lens = 31.0
    assert not lens_is_guess(loaded)
    loaded.camera.data.lens = loaded.guessed_lens_mm
    assert bpy.ops.keymark.keep_lens() == {"FINISHED"}
    assert not lens_is_guess(loaded)
    with pytest.raises(RuntimeError, match="not a guess"):
        bpy.ops.keymark.keep_lens()


def test_the_startup_files_camera_stays_where_it_is(tiny_take: Take) -> None:
    bpy.ops.wm.read_homefile(use_factory_startup=True)
    startup = bpy.context.scene.camera
    bpy.ops.keymark.load_footage(filepath=str(tiny_take.clip))
    camera = active_take(bpy.context.scene).camera
    assert camera == bpy.context.scene.camera != startup
    assert camera.location.z == pytest.approx(1.4)
    assert not startup.data.show_background_images


def test_choosing_a_clip_in_the_panel_does_what_loading_does(tmp_path: Path) -> None:
    scene = bpy.context.scene
    clips = [
        bpy.data.movieclips.load(str(write_clip(tmp_path / f"{count}.mp4", count, fps)))
        for count, fps in ((9, 24.0), (12, 30.0))
    ]
    scene.keymark.takes.add()
    take = scene.keymark.takes[0]
    take.clip = clips[0]
    camera = take.camera
    assert camera == scene.camera is not None
    assert (scene.frame_end, scene.render.fps, scene.active_clip) == (9, 24, clips[0])
    take.clip = clips[1]
    assert (take.camera, scene.frame_end, scene.render.fps) == (camera, 12, 30)
    assert [image.clip for image in camera.data.background_images] == [clips[1]]


def test_a_clip_of_this_file_is_used(tmp_path: Path) -> None:
    scene = bpy.context.scene
    with pytest.raises(RuntimeError, match="has no clip; load the footage"):
        bpy.ops.keymark.use_clip()
    clip = bpy.data.movieclips.load(str(write_clip(tmp_path / "walk.mp4", 9, 24.0)))
    assert bpy.ops.keymark.use_clip(clip="walk.mp4") == {"FINISHED"}
    take = active_take(scene)
    assert (take.name, take.clip, scene.active_clip) == ("walk", clip, clip)
    with pytest.raises(RuntimeError, match=r"no clip 'run\.mp4'; it has walk\.mp4"):
        bpy.ops.keymark.use_clip(clip="run.mp4")
    assert len(scene.keymark.takes) == 1


def test_choosing_a_camera_puts_the_clip_behind_it(loaded: bpy.types.PropertyGroup) -> None:
    other = bpy.data.objects.new("Other", bpy.data.cameras.new("Other"))
    bpy.context.scene.collection.objects.link(other)
    loaded.camera = other
    assert bpy.context.scene.camera == other
    assert other.data.background_images[0].clip == loaded.clip


def test_a_camera_that_was_deleted_is_replaced(loaded: bpy.types.PropertyGroup) -> None:
    deleted = loaded.camera
    bpy.context.scene.collection.objects.unlink(deleted)
    bpy.ops.keymark.use_clip(clip=loaded.clip.name)
    assert loaded.camera != deleted
    assert loaded.camera.name in bpy.context.scene.objects


def test_what_is_dropped_is_loaded_as_a_take_of_its_own(
    loaded: bpy.types.PropertyGroup, tmp_path: Path
) -> None:
    first = loaded.clip
    context = bpy.context
    assert ".mp4" in KEYMARK_FH_footage.bl_file_extensions.split(";")
    area = context.window_manager.windows[0].screen.areas[0]
    for kind, accepted in (("VIEW_3D", True), ("CLIP_EDITOR", True), ("OUTLINER", False)):
        area.type = kind
        with context.temp_override(window=context.window_manager.windows[0], area=area):
            assert KEYMARK_FH_footage.poll_drop(bpy.context) is accepted
            assert KEYMARK_FH_take.poll_drop(bpy.context) is accepted
    dropped = SimpleNamespace(filepath=str(write_clip(tmp_path / "dropped.mp4", 9, 24.0)), as_new_take=False)
    dropped.execute = lambda _context: bpy.ops.keymark.load_footage(
        filepath=dropped.filepath, as_new_take=dropped.as_new_take
    )
    assert KEYMARK_OT_load_footage.invoke(dropped, context, None) == {"FINISHED"}
    takes = context.scene.keymark.takes
    assert [take.name for take in takes] == ["tiny", "dropped"]
    assert takes[0].clip == first


def test_a_dropped_take_is_opened() -> None:
    dropped = SimpleNamespace(filepath="/takes/walk/take.json", execute=lambda _context: {"FINISHED"})
    assert KEYMARK_OT_open_take.invoke(dropped, bpy.context, None) == {"FINISHED"}
    for operator in (bpy.ops.keymark.load_footage, bpy.ops.keymark.open_take):
        assert operator.get_rna_type().properties["filepath"].is_skip_save


def test_a_varying_rate_is_noticed(loaded: bpy.types.PropertyGroup, monkeypatch: pytest.MonkeyPatch) -> None:
    from keymark.core.video.video_file import VideoFile

    assert loaded.clip_state.rate == pytest.approx(25.0)
    assert not loaded.clip_state.variable_rate
    uneven = iter([0.0, 0.04, 0.08, 0.2, 0.24, 0.28])
    monkeypatch.setattr(VideoFile, "time_stamps", lambda self: uneven)
    loaded.clip = loaded.clip
    assert loaded.clip_state.variable_rate


def reopened(path: Path) -> bpy.types.PropertyGroup:
    bpy.ops.wm.open_mainfile(filepath=str(path))
    return active_take(bpy.context.scene)


def test_a_clip_that_is_moved_while_the_file_is_open_can_be_found(
    opened: bpy.types.Scene, tiny_take: Take
) -> None:
    tiny_take.folder.rename(tiny_take.folder.with_name("moved"))
    assert "keymark.relocate_clip" not in offered()
    with pytest.raises(RuntimeError, match="Find Clip in the step Clip"):
        bpy.ops.keymark.reconstruct()
    bpy.context.window_manager.keymark_steps.footage = True
    assert "keymark.relocate_clip" in offered()
    bpy.ops.keymark.relocate_clip(filepath=str(tiny_take.folder.with_name("moved") / tiny_take.clip.name))
    assert bpy.ops.keymark.reconstruct() == {"FINISHED"}


def test_a_missing_clip_is_said_and_found_again(tiny_take: Take, tmp_path: Path) -> None:
    bpy.ops.keymark.open_take(filepath=str(tiny_take.folder))
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "scene.blend"))
    moved = tmp_path / "elsewhere.mp4"
    tiny_take.clip.rename(moved)
    take = reopened(tmp_path / "scene.blend")
    scene = bpy.context.scene
    assert take.clip_state.missing
    lens = take.camera.data.lens
    scene.frame_set(5)
    assert bpy.ops.keymark.store_keyframe() == {"FINISHED"}
    assert bpy.ops.keymark.show_action(which="KEYFRAMES") == {"FINISHED"}
    assert bpy.ops.keymark.add_performer() == {"FINISHED"}
    scene.keymark.active_take = 0
    take = active_take(scene)
    assert (scene.render.fps, scene.frame_end) == (25, 13)
    with pytest.raises(RuntimeError, match="the footage is not there"):
        bpy.ops.keymark.propose_keyframes()
    with pytest.raises(RuntimeError, match=r"nowhere\.mp4"):
        bpy.ops.keymark.relocate_clip(filepath=str(tmp_path / "nowhere.mp4"))
    assert take.clip_state.missing
    assert bpy.ops.keymark.relocate_clip(filepath=str(moved)) == {"FINISHED"}
    assert [each.clip_state.missing for each in scene.keymark.takes] == [False, False]
    assert take.clip.fps == pytest.approx(25.0)
    assert (take.camera.data.lens, len(take.markers)) == (lens, 5)
    assert bpy.ops.keymark.propose_keyframes() == {"FINISHED"}


def test_a_motion_is_finished_without_its_footage(tiny_take: Take, tmp_path: Path) -> None:
    bpy.ops.keymark.open_take(filepath=str(tiny_take.folder))
    active_take(bpy.context.scene).method = "interpolation"
    bpy.ops.keymark.reconstruct()
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "scene.blend"))
    tiny_take.clip.rename(tmp_path / "elsewhere.mp4")
    take = reopened(tmp_path / "scene.blend")
    assert take.clip_state.missing
    assert bpy.ops.keymark.bake_motion() == {"FINISHED"}
    assert bpy.ops.keymark.export_motion(format="BVH", filepath=str(tmp_path / "motion.bvh")) == {"FINISHED"}
    assert (tmp_path / "motion.bvh").read_text().startswith("HIERARCHY")
    before = len(bpy.data.actions), len(bpy.data.cameras)
    assert bpy.ops.keymark.remove_take(delete_data=True) == {"FINISHED"}
    assert len(bpy.data.objects) == 0 and min(before) > 0


def test_another_clip_in_its_place_is_doubted(tiny_take: Take, tmp_path: Path, capsys) -> None:
    bpy.ops.keymark.load_footage(filepath=str(tiny_take.clip))
    other = write_clip(tmp_path / "other.mp4", 9, 24.0)
    bpy.ops.keymark.relocate_clip(filepath=str(other))
    assert active_take(bpy.context.scene).clip.frame_duration == 9
    assert "check that it is the right one" in capsys.readouterr().out


def test_clips_move_with_the_file(tiny_take: Take, tmp_path: Path) -> None:
    here, there = tmp_path / "here", tmp_path / "there"
    here.mkdir()
    shutil.copy(tiny_take.clip, here / "clip.mp4")
    bpy.ops.wm.save_as_mainfile(filepath=str(here / "scene.blend"))
    bpy.ops.keymark.load_footage(filepath=str(here / "clip.mp4"))
    assert active_take(bpy.context.scene).clip.filepath == "//clip.mp4"
    bpy.ops.wm.save_mainfile()
    here.rename(there)
    assert not reopened(there / "scene.blend").clip_state.missing


def test_a_clip_of_this_file_that_cannot_be_decoded_stays(tmp_path: Path) -> None:
    clip = tmp_path / "broken.mp4"
    clip.write_bytes(bytes(2000))
    with pytest.raises(RuntimeError, match="cannot"):
        bpy.ops.keymark.load_footage(filepath=str(clip))
    assert not len(bpy.data.movieclips)
    had = bpy.data.movieclips.load(str(clip))
    with pytest.raises(RuntimeError, match="cannot"):
        bpy.ops.keymark.load_footage(filepath=str(clip))
    assert list(bpy.data.movieclips) == [had]


def test_nothing_chosen_is_said_and_the_folder_kept(tiny_take: Take, tmp_path: Path) -> None:
    with pytest.raises(RuntimeError, match="No file is chosen; choose a video"):
        bpy.ops.keymark.load_footage(filepath="")
    with pytest.raises(RuntimeError, match=f"No file is chosen in {tmp_path}; choose a video"):
        bpy.ops.keymark.load_footage(filepath=f"{tmp_path}/")
    assert not len(bpy.context.scene.keymark.takes)
    assert _browsed(KEYMARK_OT_load_footage) == f"{tmp_path}/"
    bpy.ops.keymark.load_footage(filepath=str(tiny_take.clip))
    assert _browsed(KEYMARK_OT_load_footage) == f"{tiny_take.clip.parent}/"


def _browsed(operator: type) -> str:
    shown = SimpleNamespace(bl_idname="KEYMARK_OT_load_footage", filepath="")
    manager = SimpleNamespace(fileselect_add=lambda _operator: None)
    assert operator.invoke(shown, SimpleNamespace(window_manager=manager), None) == {"RUNNING_MODAL"}
    return str(shown.filepath)
