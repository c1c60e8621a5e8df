"""Read a take from a scene: footage, camera, actor, what is followed, and the animator's keyframes."""

from dataclasses import replace

import bpy

from ...core.arrays import Array
from ...core.body.human import HUMAN
from ...core.footage.clip_times import clip_times
from ...core.footage.reading import Reading
from ...core.progress import Job, within
from ...core.take.take import Take
from .actor_lengths import read_body
from .camera_from_scene import read_camera
from .footage import Footage
from .keyframes import NOT_MATCHED, Matches, read_keyframes
from .scene_evidence import SceneEvidence
from .scene_frames import scene_frames

READING = "Reading the footage's times"


def clip_frames(footage: Footage, evidence: SceneEvidence, kept: Reading | None) -> Job[Array]:
    """Find the scene frame that shows each frame of the clip.

    Args:
        footage: The clip.
        evidence: What is followed in it, ...
        kept: ... and a cached reading of any clip, which knows the times where it is one of that.

    Yields:
        Progress; a video is read once a session for its time stamps, since its header may be wrong.

    Returns:
        (F,) scene frames, fractional for variable frame rates.

    Raises:
        InputError: The clip cannot be read.
    """
    times = clip_times(footage.open(), kept, evidence.markers, evidence.ignored_regions)
    time_s = yield from within(READING, times, 0.0, 1.0)
    return scene_frames(time_s, footage.first_frame, footage.rate)


def read_scene_take(
    footage: Footage,
    armature_object: bpy.types.Object,
    keyframe_action: bpy.types.Action | None,
    evidence: SceneEvidence,
    matches: Matches = NOT_MATCHED,
    kept: Reading | None = None,
) -> Job[tuple[Take, tuple[str, ...]]]:
    """Read a scene as core's take; the scene is as before afterwards.

    Args:
        footage: Clip and camera in their scene.
        armature_object: The actor.
        keyframe_action: The animator's keyframes; None for none.
        evidence: What is followed in the footage.
        matches: The matched keyframes, and what they were matched with.
        kept: A cached reading of any clip, for the times of its frames.

    Yields:
        Progress.

    Returns:
        The take, and notes for the animator.

    Raises:
        InputError: Something is missing or unusable.
    """
    path = footage.path
    frames = yield from clip_frames(footage, evidence, kept)
    body = read_body(armature_object, HUMAN)
    take = Take(
        folder=path.parent,
        clip=path,
        fps=footage.rate,
        frame_start=footage.first_frame,
        frame_count=len(frames),
        camera=read_camera(footage, frames),
        body=body,
        markers=evidence.markers,
        keyframes=(),
        keypoints=evidence.people(footage, frames),
        contours=evidence.contours,
        ignored_regions=evidence.ignored_regions,
    )
    if keyframe_action is None:
        return take, ()
    posed = read_keyframes(footage.scene, armature_object, keyframe_action, body, frames, matches)
    return replace(take, keyframes=posed.keyframes), posed.notes
