"""Footage behind a camera: core's camera and clip as Blender's camera, movie clip, frame range and rate."""

from pathlib import Path

import bpy
import numpy as np
from mathutils import Matrix
from numpy.typing import NDArray

from ...core.body.rotations import continuous_quaternions, to_quaternions
from ...core.errors import InputError
from ...core.footage.camera import Camera
from ...core.footage.image_sequence import find_images
from .actions import assign_action, channelbag_for
from .footage import clip_rate, set_scene_range
from .keys import add_generated_keys

Array = NDArray[np.float64]

CAMERA_NAME = "Footage Camera"


def load_footage(path: Path) -> bpy.types.MovieClip:
    """Load a clip: a video, a folder of images, or a pattern of numbered images.

    Raises:
        InputError: Blender cannot read it.
    """
    images = find_images(path)
    file = path if images is None else images[0]
    try:
        clip = bpy.data.movieclips.load(str(file.resolve()), check_existing=True)
    except RuntimeError as error:
        raise InputError(f"{file}: Blender cannot read this clip; name a video or numbered images") from error
    if not clip.frame_duration:  # Blender gives what it cannot decode a size, but no frames
        bpy.data.movieclips.remove(clip)
        raise InputError(
            f"{file}: Blender cannot decode this clip; convert it to H.264 or to numbered images"
        )
    return clip


def show_footage(
    scene: bpy.types.Scene,
    camera: Camera,
    clip_path: Path,
    fps: float,
    frame_start: int,
    frame_count: int,
    frames: Array | None = None,
    camera_object: bpy.types.Object | None = None,
) -> bpy.types.Object:
    """Put a clip behind a camera that stands where the footage's camera stood.

    The scene takes the clip's size, rate and range, so that scene frame `frame_start` shows its first frame.

    Args:
        scene: The scene to change.
        camera: Lens and pose; one pose a frame animates it.
        clip_path: The clip.
        fps: Frames per second; Blender's own reading of the clip counts where it has one (see `clip_rate`).
        frame_start: Scene frame of the clip's first frame.
        frame_count: Number of its frames.
        frames: (F,) scene frames at which a moving camera has its poses; one after the other by default.
        camera_object: The camera to use; a new one by default.

    Returns:
        The camera object, which is the scene's camera now.

    Raises:
        InputError: Blender cannot read the clip.
    """
    clip = load_footage(clip_path)
    clip.frame_start = frame_start
    set_scene_range(scene, camera.resolution, clip_rate(clip, fps), frame_start, frame_count)
    set_tracking_camera(clip, camera)
    camera_object = camera_object or _new_camera(scene)
    _set_lens(camera_object.data, camera)
    if frames is None:
        frames = frame_start + np.arange(len(camera.matrix_world), dtype=np.float64)
    _set_pose(camera_object, camera, frames)
    set_background(camera_object.data, clip)
    scene.camera = camera_object
    scene.active_clip = clip
    return camera_object


def attach_footage(
    scene: bpy.types.Scene, path: Path, camera_object: bpy.types.Object | None = None
) -> tuple[bpy.types.MovieClip, bpy.types.Object]:
    """Put a clip behind a camera and give the scene the clip's size, rate and range.

    Args:
        scene: The scene to change.
        path: The clip.
        camera_object: The camera; by default a new one at eye height, four metres in front of the world's
            origin.

    Returns:
        The clip and the camera, which are the scene's own now.

    Raises:
        InputError: Blender cannot read the clip.
    """
    clip = load_footage(path)
    rate = clip_rate(clip, scene.render.fps / scene.render.fps_base)
    size, count = (clip.size[0], clip.size[1]), clip.frame_duration
    if camera_object is None:
        stand = np.array(
            [[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, -1.0, -4.0], [0.0, 1.0, 0.0, 1.2], [0.0, 0.0, 0.0, 1.0]]
        )
        return clip, show_footage(scene, Camera(35.0, 36.0, size, stand), path, rate, clip.frame_start, count)
    set_scene_range(scene, size, rate, clip.frame_start, count)
    set_background(camera_object.data, clip)
    scene.camera, scene.active_clip = camera_object, clip
    return clip, camera_object


def set_tracking_camera(clip: bpy.types.MovieClip, camera: Camera) -> None:
    """Tell the clip its lens, so that Blender's tracking and undistortion know it too."""
    tracking = clip.tracking.camera
    tracking.units = "MILLIMETERS"
    tracking.sensor_width = camera.sensor_width_mm
    tracking.focal_length = camera.lens_mm
    tracking.distortion_model = "POLYNOMIAL"
    tracking.k1, tracking.k2, tracking.k3 = camera.distortion
    x, y = camera.principal_point
    tracking.principal_point_pixels = (x, camera.resolution[1] - y)  # Blender counts from the bottom


def set_background(camera_data: bpy.types.Camera, clip: bpy.types.MovieClip) -> None:
    """Show the clip behind everything the camera sees, filling the frame."""
    images = camera_data.background_images
    background = next((image for image in images if image.source == "MOVIE_CLIP"), None) or images.new()
    background.source = "MOVIE_CLIP"
    background.clip = clip
    background.frame_method = "FIT"
    background.alpha = 1.0
    tracking = clip.tracking.camera
    # Blender's camera has no distortion of its own: a body drawn over the footage fits straightened footage.
    background.clip_user.use_render_undistorted = any((tracking.k1, tracking.k2, tracking.k3))
    camera_data.show_background_images = True


def _new_camera(scene: bpy.types.Scene) -> bpy.types.Object:
    camera_object = bpy.data.objects.new(CAMERA_NAME, bpy.data.cameras.new(CAMERA_NAME))
    scene.collection.objects.link(camera_object)
    return camera_object


def _set_lens(data: bpy.types.Camera, camera: Camera) -> None:
    data.type = "PERSP"
    data.sensor_fit = "HORIZONTAL"
    data.sensor_width = camera.sensor_width_mm
    data.lens = camera.lens_mm
    data.shift_x, data.shift_y = camera.shift_x, camera.shift_y


def _set_pose(camera_object: bpy.types.Object, camera: Camera, frames: Array) -> None:
    if not camera.is_moving:
        camera_object.animation_data_clear()
        camera_object.matrix_world = Matrix(camera.matrix_world.tolist())
        return
    camera_object.rotation_mode = "QUATERNION"
    action = bpy.data.actions.new(f"{camera_object.name} Motion")
    channelbag = channelbag_for(action, camera_object)
    poses = camera.matrix_world[: len(frames)]
    turns = continuous_quaternions(to_quaternions(poses[:, :3, :3]))
    for path, values in (("location", poses[:, :3, 3]), ("rotation_quaternion", turns)):
        for index, column in enumerate(values.T):
            add_generated_keys(channelbag, path, index, "Camera", frames[: len(poses)], column)
    assign_action(camera_object, action)
