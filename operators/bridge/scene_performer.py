"""The performer's keypoints in a scene, before there are keyframes or even an actor."""

from collections.abc import Sequence

from ...core.arrays import Array
from ...core.body.actor import Actor
from ...core.body.kinematics import Body
from ...core.footage.keypoints.keypoints import Keypoints
from ...core.footage.region_tracks import RegionTracks
from ...core.prior.interpolation import interpolate
from ...core.prior.keyframes import Keyframe
from ...core.take.performer_keypoints import performer_keypoints
from ...core.take.take import Take
from .camera_from_scene import read_camera, read_lens
from .footage import Footage
from .scene_evidence import SceneEvidence
from .scene_frames import scene_frames


def keypoints_without_keyframes(
    footage: Footage, evidence: SceneEvidence, tracks: RegionTracks, stature_m: float
) -> Keypoints:
    """The keypoints of the performer as clicks, markers or else size tell who that is.

    Args:
        footage: Clip and camera in their scene.
        evidence: What is followed.
        tracks: The markers' regions.
        stature_m: Roughly the performer's height.

    Raises:
        InputError: A file of keypoints cannot be used, or there is no camera.
    """
    frames = scene_frames(tracks.time_s, footage.first_frame, footage.rate)
    return performers_keypoints(footage, evidence, frames, Body(Actor.from_stature(stature_m)), (), tracks)


def performers_keypoints(
    footage: Footage,
    evidence: SceneEvidence,
    frames: Array,
    body: Body,
    keyframes: Sequence[Keyframe],
    tracks: RegionTracks,
) -> Keypoints:
    """The keypoints of the performer, whom keyframes tell from other people where there are some.

    Args:
        footage: Clip and camera in their scene.
        evidence: What is followed.
        frames: (F,) scene frame of each frame of the clip.
        body: The performer's, about.
        keyframes: Those known.
        tracks: The markers' regions, or of none where the clip has not been read.

    Raises:
        InputError: A file of keypoints cannot be used, or there is no camera.
    """
    if not evidence.has_keypoints:
        return Keypoints.none(len(frames))
    people = evidence.people(footage, frames)
    known = tuple(keyframes) if any(one.most_people > 1 for one in people) else ()
    take = Take(
        folder=footage.path.parent,
        clip=footage.path,
        fps=footage.rate,
        frame_start=footage.first_frame,
        frame_count=len(frames),
        # A moving camera is evaluated in every frame, which takes a while.
        camera=read_camera(footage, frames) if known else read_lens(footage),
        body=body,
        markers=evidence.markers if tracks.names else (),
        keyframes=known,
        keypoints=people,
    )
    prior = interpolate(known, len(frames)) if known else None
    return performer_keypoints(take, prior, tracks)
