"""The footage's camera read from a scene: core's camera from Blender's camera and movie clip."""

from dataclasses import replace

import bpy
import numpy as np

from ...core.arrays import Array
from ...core.errors import InputError
from ...core.footage.camera import Camera
from .footage import Footage
from .footage_camera import may_move
from .object_space import evaluated
from .scene_frames import at_scene_frame

STILL = 1e-6
"""Largest change of the camera's matrix [m or 1] that still counts as rounding."""


def read_camera(footage: Footage, frames: Array) -> Camera:
    """The camera that took the footage, with its lens and poses.

    Args:
        footage: A clip, which gives size and lens distortion, and its perspective camera.
        frames: (F,) scene frames of the footage, at which a moving camera is read.

    Raises:
        InputError: There is no camera or clip, or the camera is of an unsupported type.
    """
    return replace(read_lens(footage), matrix_world=_poses(footage.scene, footage.camera, frames))


def read_lens(footage: Footage) -> Camera:
    """The camera's lens, with the pose of the world's origin; nothing is evaluated.

    Raises:
        InputError: There is no camera or clip, or the camera is of an unsupported type.
    """
    scene, camera_object, clip = footage.scene, footage.camera, footage.clip
    data = camera_object.data
    if data.type != "PERSP":
        raise InputError(
            f"camera '{camera_object.name}' is of type {data.type}; footage needs a perspective one"
        )
    if scene.render.pixel_aspect_x != scene.render.pixel_aspect_y:
        raise InputError(
            f"scene '{scene.name}' has the pixel aspect {scene.render.pixel_aspect_x:g} to "
            f"{scene.render.pixel_aspect_y:g}; only square pixels are supported"
        )
    width, height = clip.size
    sensor_width, unit = _horizontal_sensor(data, width, height)
    return Camera(
        lens_mm=float(data.lens),
        sensor_width_mm=sensor_width,
        resolution=(width, height),
        matrix_world=np.eye(4),
        shift_x=data.shift_x * unit / width,
        shift_y=data.shift_y * unit / width,
        distortion=_distortion(clip),
    )


def _horizontal_sensor(data: bpy.types.Camera, width: int, height: int) -> tuple[float, int]:
    """Sensor width [mm] that spans the image's width, and the pixels that one unit of shift stands for."""
    fit = data.sensor_fit
    if fit == "AUTO":
        # Blender lays the sensor's *width* along the longer side of the image.
        return (data.sensor_width, width) if width >= height else (data.sensor_width * width / height, height)
    if fit == "VERTICAL":
        return data.sensor_height * width / height, height
    return data.sensor_width, width


def _distortion(clip: bpy.types.MovieClip) -> tuple[float, float, float]:
    tracking = clip.tracking.camera
    coefficients = (float(tracking.k1), float(tracking.k2), float(tracking.k3))
    if tracking.distortion_model == "POLYNOMIAL":
        return coefficients
    untouched = {
        "DIVISION": (tracking.division_k1, tracking.division_k2),
        "NUKE": (tracking.nuke_k1, tracking.nuke_k2),
        "BROWN": (tracking.brown_k1, tracking.brown_k2, tracking.brown_k3, tracking.brown_k4),
    }
    if any(untouched.get(tracking.distortion_model, ())):
        raise InputError(
            f"clip '{clip.name}' has the distortion model {tracking.distortion_model}; choose Polynomial"
        )
    return (0.0, 0.0, 0.0)


def _poses(scene: bpy.types.Scene, camera_object: bpy.types.Object, frames: Array) -> Array:
    """Camera to world: (4, 4) of a still camera, (F, 4, 4) of a moving one."""
    if not may_move(camera_object):
        return _rigid(camera_object)
    poses = np.empty((len(frames), 4, 4))
    with at_scene_frame(scene) as go_to:
        for row, frame in enumerate(frames):
            go_to(float(frame))
            poses[row] = _rigid(camera_object)
    still = np.abs(poses - poses[0]).max() < STILL
    return poses[0] if still else poses


def _rigid(camera_object: bpy.types.Object) -> Array:
    """Camera to world without scale, which Blender's camera ignores as well."""
    matrix = np.array(evaluated(camera_object).matrix_world, dtype=np.float64)
    matrix[:3, :3] /= np.linalg.norm(matrix[:3, :3], axis=0)
    return matrix
