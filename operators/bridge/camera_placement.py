"""The footage's camera in a scene: core's camera from Blender's, and height, tilt and roll of a still one."""

from dataclasses import replace

import bpy
import numpy as np
from mathutils import Matrix

from ...core.arrays import Array
from ...core.camera.camera import Camera
from ...core.camera.camera_fields import CameraPlacement
from ...core.errors import InputError
from .footage import Footage
from .footage_camera import may_move
from .object_space import evaluated
from .scene_frames import at_scene_frame


def read_camera(footage: Footage, frames: Array) -> Camera:
    """The camera that took the footage, with its lens, and its poses at scene frames (F,) if it moves."""
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
        return _rigid(evaluated(camera_object).matrix_world)
    poses = np.empty((len(frames), 4, 4))
    with at_scene_frame(scene) as go_to:
        for row, frame in enumerate(frames):
            go_to(float(frame))
            poses[row] = _rigid(evaluated(camera_object).matrix_world)
    still = np.abs(poses - poses[0]).max() < 1e-6
    return poses[0] if still else poses


def _rigid(matrix: Matrix) -> Array:
    """(4, 4) without scale, which Blender's camera ignores as well."""
    rigid = np.array(matrix, dtype=np.float64)
    rigid[:3, :3] /= np.linalg.norm(rigid[:3, :3], axis=0)
    return rigid


# --- Height, tilt and roll of a still camera in a scene


def fixed_reason(camera_object: bpy.types.Object | None) -> str | None:
    """Why a camera's pose cannot be set; None if it can."""
    if camera_object is None:
        return "Choose the camera that the footage was taken with first"
    if camera_object.library is not None or camera_object.data.library is not None:
        return "The camera is linked; make it local first (Object > Relations)"
    if may_move(camera_object):
        return "The camera is animated or constrained, which says where it is"
    return None


def read_placement(camera_object: bpy.types.Object) -> CameraPlacement:
    """The placement of a camera, in the scene's current frame."""
    return CameraPlacement.of(_rigid(_matrix(camera_object)))


def write_placement(camera_object: bpy.types.Object, placement: CameraPlacement) -> None:
    """Give a still camera another placement; its place on the floor, heading and display size stay."""
    pose = Matrix(placement.applied_to(_rigid(_matrix(camera_object))).tolist())
    scale = _matrix(camera_object).to_scale()
    camera_object.matrix_world = Matrix.LocRotScale(pose.to_translation(), pose.to_quaternion(), scale)


def still_camera(footage: Footage) -> Camera:
    """Lens and pose of the footage's camera in the scene's current frame."""
    return replace(read_lens(footage), matrix_world=_rigid(_matrix(footage.camera)))


def write_found_camera(footage: Footage, camera: Camera) -> None:
    """Give the footage's camera another height, tilt, roll and focal length; nothing else of it changes."""
    data = footage.camera.data
    # Where Blender measures the sensor along the other side, the same factor applies.
    data.lens *= camera.lens_mm / read_lens(footage).lens_mm
    write_placement(footage.camera, CameraPlacement.of(camera.matrix_world))


def _matrix(camera_object: bpy.types.Object) -> Matrix:
    """World matrix of a camera: its own channels where nothing else moves it, which are never out of date."""
    own = camera_object.parent is None and not may_move(camera_object)
    shifted = any(camera_object.delta_location) or any(camera_object.delta_rotation_euler)
    return camera_object.matrix_basis if own and not shifted else camera_object.matrix_world
