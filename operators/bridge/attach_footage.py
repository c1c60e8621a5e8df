"""Attach a clip to a camera, with a guessed lens where none is known."""

from dataclasses import dataclass, replace

import bpy
import numpy as np

from ...core.footage.camera import Camera
from ...core.footage.camera_placement import CameraPlacement
from ...core.footage.default_camera import default_camera_pose, guess_lens
from .footage import clip_rate, set_scene_range
from .footage_camera import (
    clip_lens,
    follow_solution,
    lens_is_untouched,
    may_move,
    new_camera,
    set_background,
    set_lens,
    set_still_pose,
    solver_constraint,
)


@dataclass(frozen=True, eq=False)
class AttachedFootage:
    """The camera that a clip was attached to."""

    camera: bpy.types.Object
    guessed_lens_mm: float
    """Focal length, where it is a guess [mm]; 0 where it is known."""
    guessed_placement: CameraPlacement | None = None
    """Where a new camera was put; None for one that was there already."""


def attach_footage(
    scene: bpy.types.Scene,
    clip: bpy.types.MovieClip,
    camera_object: bpy.types.Object | None = None,
    guessed_lens_mm: float = 0.0,
) -> AttachedFootage:
    """Put a clip behind a camera and give the scene the clip's size, rate and range.

    A lens set in the clip's tracking camera is used, and the camera follows a solved clip. A lens that was
    never set is guessed; one that the animator set stays, as does the camera's pose.

    Args:
        scene: The scene to change.
        clip: A clip that Blender has; where its file is missing, the scene keeps size, rate and range.
        camera_object: The camera; by default a new one at eye height that looks at the world's origin.
        guessed_lens_mm: Focal length that was guessed for that camera before and may be guessed anew [mm].
    """
    size = (clip.size[0], clip.size[1])
    if clip.frame_duration and all(size):
        rate = clip_rate(clip, scene.render.fps / scene.render.fps_base)
        set_scene_range(scene, size, rate, clip.frame_start - clip.frame_offset, clip.frame_duration)
    else:
        size = (scene.render.resolution_x, scene.render.resolution_y)
    scene.active_clip = clip
    is_new = camera_object is None
    camera_object = camera_object or new_camera(scene)
    scene.camera = camera_object
    if camera_object.library is not None or camera_object.data.library is not None:
        return AttachedFootage(camera_object, 0.0)  # linked data cannot be changed
    set_background(camera_object.data, clip)
    solved = clip.tracking.reconstruction.is_valid
    stays = is_new or not may_move(camera_object)
    follows = bool(solved and (stays or solver_constraint(scene, camera_object, clip)))
    placement = None
    lens, guessed = _lens(clip, size, camera_object.data, is_new, stays, follows, guessed_lens_mm)
    if lens is not None:
        set_lens(camera_object.data, lens)
        if is_new:
            stand = default_camera_pose(lens.lens_mm, lens.sensor_width_mm, size)
            set_still_pose(camera_object, replace(lens, matrix_world=stand))
            placement = CameraPlacement.of(stand)
    if follows:
        follow_solution(scene, camera_object, clip)
    return AttachedFootage(camera_object, guessed, None if follows else placement)


def _lens(
    clip: bpy.types.MovieClip,
    size: tuple[int, int],
    data: bpy.types.Camera,
    is_new: bool,
    stays: bool,
    follows: bool,
    guessed_before_mm: float,
) -> tuple[Camera | None, float]:
    """The lens to set, None for the camera's own, and its focal length if guessed, else 0 [mm]."""
    known = clip_lens(clip)
    if known is not None and (stays or follows):
        return known, 0.0
    was_guessed = is_guess(data, guessed_before_mm)
    if is_new or was_guessed or (stays and lens_is_untouched(data)):
        guess = guess_lens(size)
        return Camera(guess.lens_mm, guess.sensor_width_mm, size, np.eye(4)), guess.lens_mm
    return None, 0.0


def is_guess(data: bpy.types.Camera, guessed_lens_mm: float) -> bool:
    """Whether a camera still has the lens that was guessed for it; 0 stands for no guess."""
    return guessed_lens_mm > 0.0 and abs(data.lens - guessed_lens_mm) < 1e-3
