"""A take as it stands in a scene: footage, camera, actor, markers and the animator's keyframes."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.body.human import HUMAN
from ...core.errors import InputError
from ...core.footage.clip import Clip
from ...core.footage.marker_style import MarkerStyle
from ...core.progress import Job, Progress
from ...core.take import Take
from .actor_lengths import read_body
from .frame_times import scene_frames
from .keyframes import read_keyframes
from .scene_camera import read_camera
from .scene_footage import clip_rate

Array = NDArray[np.float64]

READING = "Reading the footage's times"


def clip_path(clip: bpy.types.MovieClip) -> Path:
    """The file of a movie clip.

    Raises:
        InputError: The file is gone.
    """
    path = Path(bpy.path.abspath(clip.filepath, library=clip.library))
    if not path.exists():
        raise InputError(f"{path}: the footage is not there; load it again from where it is now")
    return path


def clip_frames(scene: bpy.types.Scene, clip: bpy.types.MovieClip) -> Job[Array]:
    """Find the scene frame that shows each frame of the clip.

    Yields:
        Progress; a video is gone through once for its time stamps, since its header may be wrong.

    Returns:
        (F,) scene frames, fractional for variable frame rates.

    Raises:
        InputError: The clip cannot be read.
    """
    rate = clip_rate(clip, scene.render.fps / scene.render.fps_base)
    source = Clip.open(clip_path(clip), fps=rate)
    first = clip.frame_start - clip.frame_offset
    stamps: list[float] = []
    for stamp in source.source.time_stamps():
        stamps.append(stamp)
        yield Progress(READING, min(len(stamps) / source.frame_count, 1.0))
    return scene_frames(np.array(stamps), first, rate)


def read_scene_take(
    scene: bpy.types.Scene,
    armature_object: bpy.types.Object,
    keyframe_action: bpy.types.Action | None,
    markers: Sequence[MarkerStyle],
) -> Job[tuple[Take, tuple[str, ...]]]:
    """What `core.reconstruct` needs, from a scene; the scene is as before afterwards.

    Args:
        scene: Its camera and active clip are the footage's.
        armature_object: The actor.
        keyframe_action: Where the animator keyed; None for no keyframes.
        markers: What the performer wears.

    Yields:
        Progress.

    Returns:
        The take, and sentences the animator should read.

    Raises:
        InputError: Something is missing or unusable; the sentence says what to do.
    """
    clip = scene.active_clip
    if clip is None:
        raise InputError(f"scene '{scene.name}' has no footage; load a clip first")
    if not markers:
        raise InputError("there are no markers; add one for each coloured sleeve the performer wears")
    frames = yield from clip_frames(scene, clip)
    body = read_body(armature_object, HUMAN)
    path = clip_path(clip)
    take = Take(
        folder=path.parent,
        clip=path,
        fps=clip_rate(clip, scene.render.fps / scene.render.fps_base),
        frame_start=clip.frame_start - clip.frame_offset,
        frame_count=len(frames),
        camera=read_camera(scene, frames),
        body=body,
        markers=tuple(markers),
        keyframes=(),
    )
    if keyframe_action is None:
        return take, ()
    posed = read_keyframes(scene, armature_object, keyframe_action, body, frames)
    return replace(take, keyframes=posed.keyframes), posed.notes
