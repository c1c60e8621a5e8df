"""A scene as core's take, and the performer's keypoints before there is an actor."""

from collections.abc import Sequence
from dataclasses import replace

from bpy.types import Action, Object

from ...core.arrays import Array
from ...core.body.kinematics import Body
from ...core.camera.camera import Camera
from ...core.detect.keypoints import Keypoints
from ...core.markers.reading import Reading, clip_times
from ...core.markers.region_tracks import RegionTracks
from ...core.prior.keyframes import Keyframe
from ...core.progress import Job, within
from ...core.take.performer_keypoints import performer_keypoints
from ...core.take.take import Take
from .actor_lengths import read_body
from .camera_placement import read_camera, read_lens
from .footage import Footage
from .keyframes import NOT_MATCHED, Matches, read_keyframes
from .scene_evidence import SceneEvidence
from .scene_frames import scene_frames


def performers_keypoints(
    footage: Footage,
    evidence: SceneEvidence,
    frames: Array,
    body: Body,
    keyframes: Sequence[Keyframe],
    tracks: RegionTracks,
) -> Keypoints:
    """The performer's keypoints in scene frames (F,), told from other people's by keyframes, if any."""
    if not evidence.has_keypoints:
        return Keypoints.none(len(frames))
    own = replace(evidence, markers=evidence.markers if tracks.names else (), reference=None)
    take = scene_take(footage, own, frames, body, read_lens(footage))
    known = tuple(keyframes) if any(people.most_people > 1 for people in take.keypoints) else ()
    if known:  # a moving camera is evaluated in every frame, which takes a while
        take = replace(take, camera=read_camera(footage, frames), keyframes=known)
    return performer_keypoints(take, tracks)


def clip_frames(footage: Footage, evidence: SceneEvidence, kept: Reading | None) -> Job[Array]:
    """Find the scene frames (F,) of the clip's, by a video's time stamps, which a kept reading may have."""
    times = clip_times(footage.open(), kept, evidence.markers, evidence.ignored_regions)
    time_s = yield from within("Reading the footage's times", times, 0.0, 1.0)
    return scene_frames(time_s, footage.first_frame, footage.rate)


def read_scene_take(
    footage: Footage,
    armature_object: Object,
    keyframe_action: Action | None,
    evidence: SceneEvidence,
    matches: Matches = NOT_MATCHED,
    kept: Reading | None = None,
) -> Job[tuple[Take, tuple[str, ...]]]:
    """Read a scene as core's take, with notes for the animator; `kept` is as in `clip_frames`."""
    frames = yield from clip_frames(footage, evidence, kept)
    body = read_body(armature_object)
    take = scene_take(footage, evidence, frames, body, read_camera(footage, frames))
    if keyframe_action is None:
        return take, ()
    posed = read_keyframes(footage.scene, armature_object, keyframe_action, body, frames, matches)
    return replace(take, keyframes=posed.keyframes), posed.notes


def scene_take(footage: Footage, evidence: SceneEvidence, frames: Array, body: Body, camera: Camera) -> Take:
    """A take without keyframes; `frames` (F,) are the scene frames of the clip's."""
    return Take(
        folder=footage.path.parent,
        clip=footage.path,
        fps=footage.rate,
        frame_start=footage.first_frame,
        frame_count=len(frames),
        camera=camera,
        body=body,
        markers=evidence.markers,
        keyframes=(),
        keypoints=evidence.people(footage, frames),
        contours=evidence.contours,
        ignored_regions=evidence.ignored_regions,
        reference=evidence.reference_motion(),
    )
