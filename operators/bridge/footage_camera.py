"""Camera objects of footage: lens, pose, background clip, and the lens in the clip's tracking camera."""

import bpy
import numpy as np
from bpy.types import CameraSolverConstraint, MovieClip, Object, Scene
from mathutils import Matrix

from ...core.camera.camera import Camera

CAMERA_NAME = "Footage Camera"


def new_camera(scene: Scene) -> Object:
    """Add a camera to a scene."""
    camera_object = bpy.data.objects.new(CAMERA_NAME, bpy.data.cameras.new(CAMERA_NAME))
    camera_object.data.display_size = 0.3  # the default of 1 m would be in the picture of every other view
    scene.collection.objects.link(camera_object)
    return camera_object


def set_lens(data: bpy.types.Camera, camera: Camera) -> None:
    """Set a camera's lens from core's camera."""
    data.type = "PERSP"
    data.lens_unit = "MILLIMETERS"
    data.sensor_fit = "HORIZONTAL"
    data.sensor_width = camera.sensor_width_mm
    data.lens = camera.lens_mm
    data.shift_x, data.shift_y = camera.shift_x, camera.shift_y


def clip_lens(clip: MovieClip) -> Camera | None:
    """The lens that was set in a clip's tracking camera; None for Blender's defaults, or without a size."""
    tracking, (width, height) = clip.tracking.camera, clip.size
    if not (width and height):
        return None
    x, y = tracking.principal_point_pixels
    if (
        _same((tracking.focal_length, tracking.sensor_width), (24.0, 35.0))  # a new clip's [mm]
        and _same((x, y), (width / 2, height / 2))
        and not any((tracking.k1, tracking.k2, tracking.k3))
        and not clip.tracking.reconstruction.is_valid
    ):
        return None
    return Camera(
        lens_mm=float(tracking.focal_length),
        sensor_width_mm=float(tracking.sensor_width),
        resolution=(width, height),
        matrix_world=np.eye(4),
        shift_x=(width / 2 - x) / width,
        shift_y=(height / 2 - y) / width,  # Blender counts from the bottom
    )


def set_clip_lens(clip: MovieClip, camera: Camera) -> None:
    """Set the lens of a clip's tracking camera, which Blender's tracking and undistortion use."""
    tracking = clip.tracking.camera
    tracking.units = "MILLIMETERS"
    tracking.sensor_width = camera.sensor_width_mm
    tracking.focal_length = camera.lens_mm
    tracking.distortion_model = "POLYNOMIAL"
    tracking.k1, tracking.k2, tracking.k3 = camera.distortion
    x, y = camera.principal_point
    tracking.principal_point_pixels = (x, camera.resolution[1] - y)  # Blender counts from the bottom


def lens_is_untouched(data: bpy.types.Camera) -> bool:
    """Whether a camera has Blender's default lens."""
    return _same((data.lens, data.sensor_width), (50.0, 36.0)) and not (data.shift_x or data.shift_y)


def is_startup_camera(camera_object: Object) -> bool:
    """Whether a camera is that of Blender's startup file, unchanged, and so not one of footage."""
    animated = camera_object.animation_data is not None or len(camera_object.constraints)
    location = camera_object.matrix_basis.translation
    return (
        lens_is_untouched(camera_object.data) and not animated and _same(location, (7.3589, -6.9258, 4.9583))
    )


def may_move(blender_object: Object | None) -> bool:
    """Whether an object or one of its parents is animated, driven or constrained."""
    while blender_object is not None:
        data = blender_object.animation_data
        driven = data is not None and (data.action is not None or len(data.drivers) or len(data.nla_tracks))
        if driven or len(blender_object.constraints) or blender_object.parent_type != "OBJECT":
            return True
        blender_object = blender_object.parent
    return False


def solver_constraint(scene: Scene, camera_object: Object, clip: MovieClip) -> CameraSolverConstraint | None:
    """The constraint by which a camera follows the clip's solution."""
    for constraint in camera_object.constraints:
        if constraint.type == "CAMERA_SOLVER" and constraint.enabled:
            shown = scene.active_clip if constraint.use_active_clip else constraint.clip
            if shown == clip:
                return constraint
    return None


def solved_camera(scene: Scene, clip: MovieClip) -> Object | None:
    """The camera of a scene that follows the clip's solution, the active camera first."""
    cameras = [scene.camera, *(each for each in scene.objects if each.type == "CAMERA")]
    return next((each for each in cameras if each and solver_constraint(scene, each, clip)), None)


def shows_behind(camera_object: Object | None, clip: MovieClip) -> bool:
    """Whether a camera has the clip as its background."""
    if camera_object is None or camera_object.type != "CAMERA":
        return False
    images = camera_object.data.background_images
    return any(image.source == "MOVIE_CLIP" and image.clip == clip for image in images)


def set_background(camera_data: bpy.types.Camera, clip: MovieClip) -> None:
    """Make a clip the camera's background, filling the frame."""
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


def set_still_pose(camera_object: Object, camera: Camera) -> None:
    """Give a camera the pose of core's still camera."""
    camera_object.animation_data_clear()
    camera_object.matrix_world = Matrix(camera.matrix_world.tolist())


def _same(values: tuple[float, ...], untouched: tuple[float, ...]) -> bool:
    return bool(np.abs(np.subtract(values, untouched)).max() < 1e-3)
