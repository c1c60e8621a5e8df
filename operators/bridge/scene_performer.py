"""The performer's keypoints in a scene, before there are keyframes or even an actor."""

from ...core.body.actor import Actor
from ...core.body.kinematics import Body
from ...core.footage.keypoints.keypoints import Keypoints
from ...core.footage.region_tracks import RegionTracks
from ...core.take.performer_keypoints import performer_keypoints
from ...core.take.take import Take
from .camera_from_scene import read_lens
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
    if not evidence.has_keypoints:
        return Keypoints.none(tracks.frame_count)
    frames = scene_frames(tracks.time_s, footage.first_frame, footage.rate)
    take = Take(
        folder=footage.path.parent,
        clip=footage.path,
        fps=footage.rate,
        frame_start=footage.first_frame,
        frame_count=tracks.frame_count,
        camera=read_lens(footage),
        body=Body(Actor.from_stature(stature_m)),
        markers=evidence.markers,
        keyframes=(),
        keypoints=evidence.people(footage, frames),
    )
    return performer_keypoints(take, None, tracks)
