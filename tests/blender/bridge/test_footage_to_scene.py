"""Footage behind a camera, and the camera read back."""

from dataclasses import replace
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from bpy_extras.object_utils import world_to_camera_view
from keymark.core.camera.camera import Camera
from keymark.core.errors import InputError
from keymark.core.take.take import Take
from keymark.operators.bridge.footage import Footage, footage_color, read_camera
from keymark.operators.bridge.result_files import show_footage
from mathutils import Vector

FRAMES = np.arange(1.0, 14.0)
POINTS = np.random.default_rng(3).normal([0.0, 0.0, 1.0], 0.3, (20, 3))


def show(take: Take, camera: Camera, frame_start: int = 1) -> bpy.types.Object:
    times = np.arange(13) / take.fps
    return show_footage(bpy.context.scene, camera, take.clip, take.fps, frame_start, times)[0]


def shown_pixels(camera_object: bpy.types.Object) -> np.ndarray:
    """Where Blender's own camera sees POINTS, in pixels x right, y down."""
    scene = bpy.context.scene
    bpy.context.view_layer.update()
    size = np.array([scene.render.resolution_x, scene.render.resolution_y])
    views = [world_to_camera_view(scene, camera_object, Vector(point)) for point in POINTS]
    return np.array([[view.x, 1.0 - view.y] for view in views]) * size


@pytest.fixture
def turned(camera: Camera) -> Camera:
    angle = 0.2
    turn = np.eye(4)
    turn[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    return replace(camera, matrix_world=turn @ camera.matrix_world, shift_x=0.07, shift_y=-0.04, lens_mm=41.0)


def shown_footage() -> Footage:
    scene = bpy.context.scene
    return Footage(scene, scene.active_clip, scene.camera)


def test_blenders_camera_sees_points_where_cores_does(tiny_take: Take, turned: Camera) -> None:
    camera_object = show(tiny_take, turned)
    pixels, _ = turned.project(POINTS)
    assert shown_pixels(camera_object) == pytest.approx(pixels, abs=0.01)


def test_the_camera_is_read_back(tiny_take: Take, turned: Camera) -> None:
    distorted = replace(turned, distortion=(-0.1, 0.02, -0.003))
    show(tiny_take, distorted)
    read = read_camera(shown_footage(), FRAMES)
    assert not read.is_moving
    assert read.distortion == pytest.approx(distorted.distortion, abs=1e-6)
    assert read.project(POINTS)[0] == pytest.approx(distorted.project(POINTS)[0], abs=0.01)


@pytest.mark.parametrize(
    ("fit", "size"), [("AUTO", (160, 120)), ("AUTO", (120, 160)), ("VERTICAL", (160, 120))]
)
def test_any_sensor_fit_is_read(tiny_take: Take, turned: Camera, fit: str, size: tuple[int, int]) -> None:
    camera_object = show(tiny_take, turned)
    camera_object.data.sensor_fit = fit
    camera_object.data.sensor_height = 20.0
    render = bpy.context.scene.render
    render.resolution_x, render.resolution_y = size
    footage = shown_footage()
    clip = SimpleNamespace(size=size, tracking=footage.clip.tracking)
    read = read_camera(replace(footage, movie_clip=clip), FRAMES)
    assert read.project(POINTS)[0] == pytest.approx(shown_pixels(camera_object), abs=0.01)


def test_a_moving_camera_is_animated_and_read_back(tiny_take: Take, camera: Camera) -> None:
    poses = np.repeat(camera.matrix_world[None], 13, axis=0).copy()
    poses[:, 0, 3] += np.linspace(0.0, 0.6, 13)
    moving = replace(camera, matrix_world=poses)
    show(tiny_take, moving)
    bpy.context.scene.frame_set(5)
    read = read_camera(shown_footage(), FRAMES)
    assert read.matrix_world == pytest.approx(poses, abs=1e-5)
    assert bpy.context.scene.frame_current == 5


def test_the_scene_takes_size_rate_and_range(tiny_take: Take, camera: Camera) -> None:
    show(tiny_take, camera, frame_start=101)
    scene = bpy.context.scene
    assert (scene.render.resolution_x, scene.render.resolution_y) == (160, 120)
    assert scene.render.fps / scene.render.fps_base == pytest.approx(25.0)
    assert (scene.frame_start, scene.frame_end) == (101, 113)
    assert scene.active_clip.frame_start == 101
    background = scene.camera.data.background_images[0]
    assert background.clip == scene.active_clip
    assert scene.camera.data.show_background_images


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (lambda scene: setattr(scene.camera.data, "type", "ORTHO"), "perspective"),
        (lambda scene: setattr(scene, "camera", None), "no camera"),
        (lambda scene: setattr(scene.render, "pixel_aspect_x", 2.0), "square pixels"),
        (lambda scene: setattr(scene, "active_clip", None), "no footage"),
    ],
)
def test_what_no_footage_can_have_is_refused(tiny_take: Take, camera: Camera, change, sentence) -> None:  # noqa: ANN001
    show(tiny_take, camera)
    change(bpy.context.scene)
    with pytest.raises(InputError, match=sentence):
        read_camera(shown_footage(), FRAMES)


def test_another_frame_has_another_color_under_a_moving_marker(tiny_take: Take, camera: Camera) -> None:
    times, fps = np.arange(13) / tiny_take.fps, tiny_take.fps
    shown, _ = show_footage(bpy.context.scene, camera, tiny_take.clip, fps, 1, times)
    footage = Footage(bpy.context.scene, bpy.context.scene.active_clip, shown)
    pose = tiny_take.body.pose(tiny_take.keyframes[0].posture)
    elbow, wrist = tiny_take.body.segment_ends(pose, "forearm.L")
    pixel, _ = camera.project(0.5 * (elbow + wrist))
    bpy.context.scene.frame_set(1)
    first = np.array(footage_color(footage, pixel))
    bpy.context.scene.frame_set(13)
    last = np.array(footage_color(footage, pixel))
    red = np.array(tiny_take.markers[1].color_srgb)
    assert np.abs(first - red).max() < 40
    assert np.abs(last - red).max() > 40
