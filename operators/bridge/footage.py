"""Footage of a take in a scene: its clip, its frames on the time line, and its camera as core's."""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import bpy
import numpy as np
from bpy.types import MovieClip, Object, Scene
from mathutils import Matrix
from numpy.typing import ArrayLike

from ...core.arrays import Array
from ...core.camera.camera import Camera, default_camera_pose, guess_lens
from ...core.camera.camera_fields import CameraPlacement
from ...core.errors import InputError
from ..bridge import footage_camera
from .actor_bones import evaluated
from .footage_camera import may_move
from .scene_frames import at_scene_frame

if TYPE_CHECKING:
    from ...core.video.clip import Clip


@dataclass(frozen=True, eq=False)
class Footage:
    """A clip and its camera in a scene."""

    scene: Scene
    movie_clip: MovieClip | None
    camera_object: Object | None

    @property
    def clip(self) -> MovieClip:
        """The movie clip; InputError without one."""
        if self.movie_clip is None:
            raise InputError(f"the take in scene '{self.scene.name}' has no footage; load a clip first")
        return self.movie_clip

    @property
    def camera(self) -> Object:
        """The camera object; InputError without one."""
        if self.camera_object is None or self.camera_object.type != "CAMERA":
            where = f"the take in scene '{self.scene.name}'"
            raise InputError(f"{where} has no camera; add one where the footage was taken from")
        return self.camera_object

    @property
    def rate(self) -> float:
        """Frames per second of the clip on the scene's time line."""
        return clip_rate(self.clip, self.scene.render.fps / self.scene.render.fps_base)

    @property
    def first_frame(self) -> int:
        """Scene frame of the clip's first decoded frame."""
        return self.clip.frame_start - self.clip.frame_offset

    @property
    def shown_s(self) -> float:
        """Time [s] of the scene's current frame from the clip's first."""
        return (self.scene.frame_current - self.first_frame) / self.rate

    @property
    def path(self) -> Path:
        """The clip's file."""
        return clip_path(self.clip)

    def open(self) -> "Clip":
        """Open the clip's file."""
        # This module is imported while the extension registers, when OpenCV may be missing.
        from ...core.video.clip import Clip

        return Clip.open(self.path, self.rate, (self.clip.size[0], self.clip.size[1]))


def _file(clip: MovieClip) -> Path:
    return Path(bpy.path.abspath(clip.filepath, library=clip.library))


def is_missing(clip: MovieClip | None) -> bool:
    """Whether a clip's file is missing."""
    return clip is not None and not _file(clip).exists()


def clip_path(clip: MovieClip) -> Path:
    """The file of a movie clip; InputError where it is missing."""
    path = _file(clip)
    if path.exists():
        return path
    raise InputError(f"{path}: the footage is not there; say where it is now with Find Clip in the step Clip")


def clip_rate(clip: MovieClip, fps: float) -> float:
    """Frames per second of a clip on a scene's time line, a mean if it varies; `fps` for images."""
    return float(clip.fps) if clip.source == "MOVIE" and clip.fps > 0.0 else fps


def set_scene_range(scene: Scene, size: tuple[int, int], fps: float, frame_start: int, frames: int) -> None:
    """Set a scene's size [px], frames per second and frame range to those of a clip."""
    render = scene.render
    render.resolution_x, render.resolution_y = size
    render.resolution_percentage = 100
    render.pixel_aspect_x = render.pixel_aspect_y = 1.0
    render.fps = max(1, round(fps))
    render.fps_base = render.fps / fps
    scene.frame_start = frame_start
    scene.frame_end = frame_start + frames - 1


def footage_color(footage: Footage, pixel: ArrayLike, scene_frame: int | None = None) -> tuple[int, int, int]:
    """Red, green, blue (0 to 255) at a pixel (2,) of the footage in a scene frame, by default the current."""
    from ...core.video.clip import FrameReader

    width, height = footage.clip.size
    x, y = np.floor(np.asarray(pixel, dtype=np.float64)).astype(int)
    if not (0 <= x < width and 0 <= y < height):
        raise InputError(f"pixel ({x}, {y}) lies outside the footage, which is {width} x {height} pixels")
    at = footage.scene.frame_current if scene_frame is None else scene_frame
    image = FrameReader(footage.open()).image_at((at - footage.first_frame) / footage.rate)
    if image is None:
        raise InputError(f"the footage has no frame at scene frame {at}; go to one it has")
    # The median of 5 x 5 is free of noise and chroma subsampling.
    around = image[max(0, y - 2) : y + 3, max(0, x - 2) : x + 3]
    blue, green, red = (round(float(value)) for value in np.median(around.reshape(-1, 3), axis=0))
    return red, green, blue


@dataclass(frozen=True, eq=False)
class AttachedFootage:
    """The camera that a clip was attached to."""

    camera: Object
    guessed_lens_mm: float  # focal length, where it is a guess [mm]; 0 where it is known
    guessed_placement: CameraPlacement | None = None  # where a new camera was put; None for another


def attach_footage(
    scene: Scene, clip: MovieClip, camera_object: Object | None = None, guessed_lens_mm: float = 0.0
) -> AttachedFootage:
    """Put a clip behind a camera and give the scene the clip's size, rate and range, if its file is there.

    A lens set in the clip's tracking camera is used, and the camera follows a solved clip. A lens that was
    never set is guessed, anew where it is `guessed_lens_mm` [mm]; one that the animator set stays, as does
    the camera's pose. A new camera, the default, stands at eye height and looks at the world's origin.
    """
    size = (clip.size[0], clip.size[1])
    if clip.frame_duration and all(size):
        rate = clip_rate(clip, scene.render.fps / scene.render.fps_base)
        set_scene_range(scene, size, rate, clip.frame_start - clip.frame_offset, clip.frame_duration)
    else:
        size = (scene.render.resolution_x, scene.render.resolution_y)
    scene.active_clip = clip
    is_new = camera_object is None
    camera_object = camera_object or footage_camera.new_camera(scene)
    scene.camera = camera_object
    if camera_object.library is not None or camera_object.data.library is not None:
        return AttachedFootage(camera_object, 0.0)  # linked data cannot be changed
    footage_camera.set_background(camera_object.data, clip)
    solved = clip.tracking.reconstruction.is_valid
    stays = is_new or not footage_camera.may_move(camera_object)
    follows = bool(solved and (stays or footage_camera.solver_constraint(scene, camera_object, clip)))
    placement = None
    data = camera_object.data
    lens, guessed = footage_camera.clip_lens(clip), 0.0
    if lens is None or not (stays or follows):
        lens = None
        if is_new or is_guess(data, guessed_lens_mm) or (stays and footage_camera.lens_is_untouched(data)):
            guess = guess_lens(size)
            lens, guessed = Camera(guess.lens_mm, guess.sensor_width_mm, size, np.eye(4)), guess.lens_mm
    if lens is not None:
        footage_camera.set_lens(data, lens)
        if is_new:
            stand = default_camera_pose(lens.lens_mm, lens.sensor_width_mm, size)
            footage_camera.set_still_pose(camera_object, replace(lens, matrix_world=stand))
            placement = CameraPlacement.of(stand)
    if follows:
        following = footage_camera.solver_constraint(scene, camera_object, clip)
        following = following or camera_object.constraints.new("CAMERA_SOLVER")
        following.clip, following.use_active_clip = clip, False  # the scene's clip changes with its take
    return AttachedFootage(camera_object, guessed, None if follows else placement)


def is_guess(data: bpy.types.Camera, guessed_lens_mm: float) -> bool:
    """Whether a camera still has the lens that was guessed for it; 0 stands for no guess."""
    return guessed_lens_mm > 0.0 and abs(data.lens - guessed_lens_mm) < 1e-3


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


def _matrix(camera_object: Object) -> Matrix:
    """World matrix of a camera: its own channels where nothing else moves it, which are never out of date."""
    own = camera_object.parent is None and not may_move(camera_object)
    shifted = any(camera_object.delta_location) or any(camera_object.delta_rotation_euler)
    return camera_object.matrix_basis if own and not shifted else camera_object.matrix_world
