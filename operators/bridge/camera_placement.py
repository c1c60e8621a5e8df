"""The footage's camera in a scene: core's camera from Blender's, and height, tilt and roll of a still one."""

from dataclasses import replace

import numpy as np
from bpy.types import Object
from mathutils import Matrix

from ...core.arrays import Array
from ...core.camera.camera import Camera
from ...core.camera.camera_fields import CameraPlacement
from ...core.errors import InputError
from .actor_bones import evaluated
from .footage import Footage
from .footage_camera import may_move
from .scene_frames import at_scene_frame


def read_camera(footage: Footage, frames: Array) -> Camera:
    """The camera that took the footage, with its lens, and its poses at scene frames (F,) if it moves."""
    lens, camera_object = read_lens(footage), footage.camera
    if not may_move(camera_object):
        return replace(lens, matrix_world=_rigid(evaluated(camera_object).matrix_world))
    poses = np.empty((len(frames), 4, 4))
    with at_scene_frame(footage.scene) as go_to:
        for row, frame in enumerate(frames):
            go_to(float(frame))
            poses[row] = _rigid(evaluated(camera_object).matrix_world)
    still = np.abs(poses - poses[0]).max() < 1e-6
    return replace(lens, matrix_world=poses[0] if still else poses)


def read_lens(footage: Footage) -> Camera:
    """The camera's lens, at the world's origin; InputError for an unsupported one. Nothing is evaluated."""
    scene, camera_object, clip = footage.scene, footage.camera, footage.clip
    data, tracking = camera_object.data, clip.tracking.camera
    if data.type != "PERSP":
        raise InputError(
            f"camera '{camera_object.name}' is of type {data.type}; footage needs a perspective one"
        )
    if scene.render.pixel_aspect_x != scene.render.pixel_aspect_y:
        raise InputError(
            f"scene '{scene.name}' has the pixel aspect {scene.render.pixel_aspect_x:g} to "
            f"{scene.render.pixel_aspect_y:g}; only square pixels are supported"
        )
    model = tracking.distortion_model
    distortion = (float(tracking.k1), float(tracking.k2), float(tracking.k3))
    if model != "POLYNOMIAL":
        distortion = (0.0, 0.0, 0.0)
        untouched = {
            "DIVISION": (tracking.division_k1, tracking.division_k2),
            "NUKE": (tracking.nuke_k1, tracking.nuke_k2),
            "BROWN": (tracking.brown_k1, tracking.brown_k2, tracking.brown_k3, tracking.brown_k4),
        }
        if any(untouched.get(model, ())):
            raise InputError(f"clip '{clip.name}' has the distortion model {model}; choose Polynomial")
    width, height = clip.size
    # What spans the image's width, and the pixels that one unit of shift stands for. Unless a side is chosen,
    # Blender lays the sensor's *width* along the longer side of the image.
    sensor_width, unit = data.sensor_width, width
    if data.sensor_fit == "VERTICAL" or (data.sensor_fit == "AUTO" and height > width):
        side = data.sensor_height if data.sensor_fit == "VERTICAL" else data.sensor_width
        sensor_width, unit = side * width / height, height
    return Camera(
        lens_mm=float(data.lens),
        sensor_width_mm=sensor_width,
        resolution=(width, height),
        matrix_world=np.eye(4),
        shift_x=data.shift_x * unit / width,
        shift_y=data.shift_y * unit / width,
        distortion=distortion,
    )


def _rigid(matrix: Matrix) -> Array:
    """(4, 4) without scale, which Blender's camera ignores as well."""
    rigid = np.array(matrix, dtype=np.float64)
    rigid[:3, :3] /= np.linalg.norm(rigid[:3, :3], axis=0)
    return rigid


def fixed_reason(camera_object: Object | None) -> str | None:
    """Why a camera's pose cannot be set; None if it can."""
    if camera_object is None:
        return "Choose the camera that the footage was taken with first"
    if camera_object.library is not None or camera_object.data.library is not None:
        return "The camera is linked; make it local first (Object > Relations)"
    if may_move(camera_object):
        return "The camera is animated or constrained, which says where it is"
    return None


def read_placement(camera_object: Object) -> CameraPlacement:
    """The placement of a camera, in the scene's current frame."""
    return CameraPlacement.of(_rigid(_matrix(camera_object)))


def write_placement(camera_object: Object, placement: CameraPlacement) -> None:
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


def _matrix(camera_object: Object) -> Matrix:
    """World matrix of a camera: its own channels where nothing else moves it, which are never out of date."""
    own = camera_object.parent is None and not may_move(camera_object)
    shifted = any(camera_object.delta_location) or any(camera_object.delta_rotation_euler)
    return camera_object.matrix_basis if own and not shifted else camera_object.matrix_world
