"""A clip attached to a camera: guessed and known lenses, location, movement."""

from dataclasses import replace

import bpy
import numpy as np
import pytest
from keymark.core.camera.camera import Camera
from keymark.core.take.take import Take
from keymark.operators.bridge.footage import Footage, attach_footage, read_camera
from keymark.operators.bridge.footage_camera import clip_lens, set_clip_lens, solved_camera
from keymark.operators.bridge.result_files import load_footage


@pytest.fixture
def clip(tiny_take: Take) -> bpy.types.MovieClip:
    return load_footage(tiny_take.clip)


def own_camera(lens_mm: float) -> bpy.types.Object:
    """A camera that the animator has added to the scene."""
    data = bpy.data.cameras.new("Mine")
    data.lens = lens_mm
    mine = bpy.data.objects.new("Mine", data)
    bpy.context.collection.objects.link(mine)
    bpy.context.scene.camera = mine
    return mine


def read(attached: bpy.types.Object, clip: bpy.types.MovieClip, frames: int = 1) -> Camera:
    bpy.context.view_layer.update()
    return read_camera(Footage(bpy.context.scene, clip, attached), 1.0 + np.arange(frames))


def test_a_new_camera_has_a_guessed_lens_and_sees_a_performer_at_the_origin(
    clip: bpy.types.MovieClip,
) -> None:
    scene = bpy.context.scene
    attached = attach_footage(scene, clip)
    data = attached.camera.data
    assert data.lens == pytest.approx(attached.guessed_lens_mm) == pytest.approx(40.8, abs=0.1)
    assert clip_lens(clip) is None
    assert (scene.camera, scene.active_clip) == (attached.camera, clip)
    assert (scene.frame_start, scene.frame_end, scene.render.fps) == (1, 13, 25)
    assert data.background_images[0].clip == clip
    corners = np.array([[0.0, 0.0, 0.0], [0.9, 0.0, 1.4], [-0.9, 0.0, 1.4], [0.0, 0.0, 2.0]])
    pixels, _ = read(attached.camera, clip).project(corners)
    assert (pixels > 0.0).all() and (pixels < (160, 120)).all()
    assert attached.camera.matrix_world.translation.z == pytest.approx(1.4)


def test_the_lens_that_the_clip_was_told_counts(clip: bpy.types.MovieClip, camera: Camera) -> None:
    told = replace(
        camera, lens_mm=28.0, sensor_width_mm=23.5, shift_x=0.03, shift_y=-0.02, distortion=(-0.1, 0.02, 0.0)
    )
    set_clip_lens(clip, told)
    scene = bpy.context.scene
    for camera_object in (None, own_camera(50.0), own_camera(77.0)):
        attached = attach_footage(scene, clip, camera_object)
        assert attached.guessed_lens_mm == 0.0
        seen = read(attached.camera, clip)
        assert (seen.lens_mm, seen.sensor_width_mm) == pytest.approx((28.0, 23.5))
        assert seen.principal_point == pytest.approx(told.principal_point, abs=1e-3)
        assert seen.distortion == pytest.approx(told.distortion)


@pytest.mark.parametrize("lens_mm", [77.0, 50.0])
def test_the_animators_lens_stays_but_blenders_own_is_no_knowledge(
    clip: bpy.types.MovieClip, lens_mm: float
) -> None:
    mine = own_camera(lens_mm)
    mine.location = (1.0, -5.0, 2.0)
    attached = attach_footage(bpy.context.scene, clip, mine)
    guessed, shown = (0.0, 77.0) if lens_mm == 77.0 else (40.8, 40.8)
    assert (attached.camera, attached.guessed_lens_mm) == (mine, pytest.approx(guessed, abs=0.1))
    assert mine.data.lens == pytest.approx(shown, abs=0.1)
    assert tuple(mine.location) == (1.0, -5.0, 2.0)


def test_an_animated_camera_is_used_as_it_moves(clip: bpy.types.MovieClip) -> None:
    mine = own_camera(50.0)
    for frame, x in ((1, 0.0), (13, 1.2)):
        mine.location.x = x
        mine.keyframe_insert("location", frame=frame)
    scene = bpy.context.scene
    attached = attach_footage(scene, clip, mine)
    assert (attached.guessed_lens_mm, mine.data.lens) == (0.0, 50.0)
    seen = read(mine, clip, 13)
    assert seen.is_moving
    assert seen.matrix_world[[0, -1], 0, 3] == pytest.approx([0.0, 1.2], abs=1e-5)


def test_a_clip_without_its_file_leaves_rate_and_range(clip: bpy.types.MovieClip, tiny_take: Take) -> None:
    scene = bpy.context.scene
    scene.render.fps, scene.render.fps_base = 48, 1.0
    scene.active_clip = clip
    clip.filepath = str(tiny_take.clip.with_name("elsewhere.mp4"))
    bpy.context.view_layer.update()  # has Blender read it again
    assert clip.fps == 0.0
    attached = attach_footage(scene, clip)
    assert scene.render.fps == 48
    assert attached.camera == scene.camera


def solve(clip: bpy.types.MovieClip) -> None:
    """Have Blender solve the clip from twenty points filmed by a camera that moves right and forward."""
    tracking = clip.tracking
    tracking.camera.sensor_width = 36.0  # first: the focal length is kept in pixels
    tracking.camera.focal_length = 40.0
    focal, (width, height) = 40.0 / 36.0, clip.size
    for number, point in enumerate(np.random.default_rng(0).uniform([-2, -1, 0], [2, 1, 2], (20, 3))):
        markers = tracking.tracks.new(name=f"Track {number}", frame=1).markers
        for frame in range(1, 14):
            x, depth, z = point - [0.1 * frame, 0.03 * frame - 6.0, 1.2]
            markers.insert_frame(
                frame, co=(0.5 + focal * x / depth, 0.5 + focal * z / depth * width / height)
            )
    tracking.objects[0].keyframe_a, tracking.objects[0].keyframe_b = 1, 13
    window = bpy.context.window_manager.windows[0]
    area = window.screen.areas[0]
    area.type = "CLIP_EDITOR"
    area.spaces.active.clip = clip
    region = next(region for region in area.regions if region.type == "WINDOW")
    with bpy.context.temp_override(window=window, area=area, region=region):
        assert bpy.ops.clip.solve_camera() == {"FINISHED"}
    assert tracking.reconstruction.is_valid


def test_a_solved_clip_moves_its_camera(clip: bpy.types.MovieClip) -> None:
    scene = bpy.context.scene
    solve(clip)
    attached = attach_footage(scene, clip)
    assert attached.guessed_lens_mm == 0.0
    assert attached.camera.data.lens == pytest.approx(40.0)
    seen = read(attached.camera, clip, 13)
    assert seen.is_moving
    moved = seen.matrix_world[-1, :3, 3] - seen.matrix_world[0, :3, 3]
    assert moved[1] / moved[0] == pytest.approx(0.3, abs=0.01)  # right and forward, in the stand's own axes
    assert abs(moved[2]) < 1e-3 * abs(moved[0])


def test_the_scenes_solved_camera_is_used_whatever_clip_is_active(clip: bpy.types.MovieClip) -> None:
    scene = bpy.context.scene
    solve(clip)
    mine = own_camera(50.0)
    mine.constraints.new("CAMERA_SOLVER")
    scene.active_clip = clip
    assert solved_camera(scene, clip) == mine
    attached = attach_footage(scene, clip, mine)
    assert (attached.camera, len(mine.constraints)) == (mine, 1)
    scene.active_clip = None
    assert solved_camera(scene, clip) == mine
    assert read(mine, clip, 13).is_moving
