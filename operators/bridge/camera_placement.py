"""Height, tilt and roll of a still camera in a scene; the camera object itself holds them."""

from dataclasses import replace

import bpy
import numpy as np
from mathutils import Matrix

from ...core.arrays import Array
from ...core.footage.camera import Camera
from ...core.footage.camera_placement import CameraPlacement
from .camera_from_scene import read_lens
from .footage import Footage
from .footage_camera import may_move


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
    return CameraPlacement.of(_pose(camera_object))


def write_placement(camera_object: bpy.types.Object, placement: CameraPlacement) -> None:
    """Give a still camera another placement; its place on the floor, heading and display size stay."""
    pose = Matrix(placement.applied_to(_pose(camera_object)).tolist())
    scale = _matrix(camera_object).to_scale()
    camera_object.matrix_world = Matrix.LocRotScale(pose.to_translation(), pose.to_quaternion(), scale)


def still_camera(footage: Footage) -> Camera:
    """Lens and pose of the footage's camera in the scene's current frame.

    Raises:
        InputError: There is no camera or clip, or the camera is of an unsupported type.
    """
    return replace(read_lens(footage), matrix_world=_pose(footage.camera))


def write_found_camera(footage: Footage, camera: Camera) -> None:
    """Give the footage's camera another height, tilt, roll and focal length; nothing else of it changes.

    Raises:
        InputError: There is no camera or clip.
    """
    data = footage.camera.data
    # Where Blender measures the sensor along the other side, the same factor applies.
    data.lens *= camera.lens_mm / read_lens(footage).lens_mm
    write_placement(footage.camera, CameraPlacement.of(camera.matrix_world))


def _matrix(camera_object: bpy.types.Object) -> Matrix:
    """World matrix of a camera: its own channels where nothing else moves it, which are never out of date."""
    own = camera_object.parent is None and not may_move(camera_object)
    shifted = any(camera_object.delta_location) or any(camera_object.delta_rotation_euler)
    return camera_object.matrix_basis if own and not shifted else camera_object.matrix_world


def _pose(camera_object: bpy.types.Object) -> Array:
    """(4, 4) camera to world without scale."""
    matrix = np.array(_matrix(camera_object), dtype=np.float64)
    matrix[:3, :3] /= np.linalg.norm(matrix[:3, :3], axis=0)
    return matrix
