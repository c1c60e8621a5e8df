"""Footage of a take in a scene: its clip, its camera, and its frames on the time line."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import bpy

from ...core.errors import InputError

if TYPE_CHECKING:
    from ...core.footage.clips.clip import Clip


@dataclass(frozen=True, eq=False)
class Footage:
    """A clip and its camera in a scene."""

    scene: bpy.types.Scene
    movie_clip: bpy.types.MovieClip | None
    camera_object: bpy.types.Object | None

    @property
    def clip(self) -> bpy.types.MovieClip:
        """The movie clip.

        Raises:
            InputError: There is none.
        """
        if self.movie_clip is None:
            raise InputError(f"the take in scene '{self.scene.name}' has no footage; load a clip first")
        return self.movie_clip

    @property
    def camera(self) -> bpy.types.Object:
        """The camera object.

        Raises:
            InputError: There is none.
        """
        if self.camera_object is None or self.camera_object.type != "CAMERA":
            raise InputError(
                f"the take in scene '{self.scene.name}' has no camera; add one where the footage was "
                "taken from"
            )
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
        """Time [s] of the scene's current frame from the clip's first.

        Raises:
            InputError: There is no clip.
        """
        return (self.scene.frame_current - self.first_frame) / self.rate

    @property
    def path(self) -> Path:
        """The clip's file.

        Raises:
            InputError: There is no clip, or its file is missing.
        """
        return clip_path(self.clip)

    def open(self) -> "Clip":
        """Open the clip's file.

        Raises:
            InputError: There is no clip, its file is missing or cannot be decoded.
        """
        # This module is imported while the extension registers, when OpenCV may be missing.
        from ...core.footage.clips.clip import Clip

        return Clip.open(self.path, fps=self.rate)


def clip_path(clip: bpy.types.MovieClip) -> Path:
    """The file of a movie clip.

    Raises:
        InputError: The file is missing.
    """
    path = Path(bpy.path.abspath(clip.filepath, library=clip.library))
    if not path.exists():
        raise InputError(
            f"{path}: the footage is not there; say where it is now with Find Clip in the Footage panel"
        )
    return path


def clip_rate(clip: bpy.types.MovieClip, fps: float) -> float:
    """Frames per second of a clip on a scene's time line.

    For clips of variable rate Blender computes its own mean rate and shows frames by their time, so keys
    belong at `frame_start + time * clip.fps`. Image sequences have no rate of their own: `fps` is returned.
    """
    return float(clip.fps) if clip.source == "MOVIE" and clip.fps > 0.0 else fps


def set_scene_range(
    scene: bpy.types.Scene, size: tuple[int, int], fps: float, frame_start: int, frame_count: int
) -> None:
    """Set a scene's size [px], frames per second and frame range to those of a clip."""
    render = scene.render
    render.resolution_x, render.resolution_y = size
    render.resolution_percentage = 100
    render.pixel_aspect_x = render.pixel_aspect_y = 1.0
    render.fps = max(1, round(fps))
    render.fps_base = render.fps / fps
    scene.frame_start = frame_start
    scene.frame_end = frame_start + frame_count - 1
