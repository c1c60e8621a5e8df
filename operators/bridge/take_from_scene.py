"""A scene as core's take, and the performer's keypoints before there is an actor."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from bpy.types import Action, Object

from ...core.arrays import Array
from ...core.body.kinematics import Body
from ...core.body.posture import Posture
from ...core.camera.camera import Camera
from ...core.detect.keypoints import Keypoints
from ...core.errors import InputError
from ...core.estimate.clip_problem import uncalibrated
from ...core.estimate.keypoint_evidence import KeypointEvidence
from ...core.estimate.performer_placement import place_standing
from ...core.estimate.single_frame import calibrated, expected_in_frame, frame_residuals
from ...core.markers.markers import regions_of_frame
from ...core.markers.reading import Reading, clip_times, of_same_footage, reading_key
from ...core.markers.region_tracks import ExpectedRegions, MarkerStyle, RegionTracks
from ...core.poses.clip_input import PosedFrames
from ...core.poses.found_poses import Candidate
from ...core.poses.frame import find_frame_poses, near_pose
from ...core.poses.frame_search import FrameShown
from ...core.prior.frame_prior import prior_from_keyframes, prior_from_pose
from ...core.prior.keyframes import Keyframe
from ...core.prior.library import Library
from ...core.progress import Job, within
from ...core.take.performer_keypoints import performer_keypoints
from ...core.take.reference import reference_of_take
from ...core.take.take import Take
from ...core.terms.keypoints import ObservedKeypoints
from ...core.terms.region_model import MarkerPlacement, RegionModel
from ...core.terms.regions import ObservedRegions
from .armature import read_body
from .footage import Footage, read_camera, read_lens
from .keyframes import NEAREST, NOT_MATCHED, Matches, read_keyframes
from .motions.import_motion import armature_reference
from .pose import read_posture
from .scene_evidence import SceneEvidence
from .scene_frames import scene_frames


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
        reference=reference_of_take(evidence.reference, None, armature_reference),
    )


# --- Fit an actor to one frame of the footage: from a scene to core's single-frame fit


@dataclass(frozen=True, eq=False)
class FrameInFootage:
    """The scene's current frame as a frame of the footage."""

    footage: Footage
    evidence: SceneEvidence  # what is followed
    reading: Reading | None  # an earlier reading of the clip, if it is of this footage and these markers
    clip_frames: Array  # (F,) scene frames of the clip's, estimated from its header where it was not read
    index: int  # index of the current frame in the clip

    @property
    def styles(self) -> tuple[MarkerStyle, ...]:
        return self.evidence.markers

    @property
    def segments(self) -> tuple[str, ...]:
        """The segment each marker is bound to."""
        return tuple(style.segment for style in self.styles)

    @property
    def tracks(self) -> RegionTracks:
        """The markers' regions in all frames where the clip was read, else those of no marker."""
        if self.reading is not None:
            return self.reading.tracks
        time_s = (self.clip_frames - self.footage.first_frame) / self.footage.rate
        return RegionTracks.unmarked(time_s, tuple(self.footage.clip.size))

    def regions(self, expected: ExpectedRegions | None = None) -> RegionTracks:
        """The markers' regions in the frame, read or found now; expected ones tell similar colors apart."""
        if self.reading is not None or not self.styles:
            return self.tracks.frame(self.index)
        time_s, ignored = float(self.tracks.time_s[self.index]), self.evidence.ignored_regions
        return regions_of_frame(self.footage.open(), time_s, self.styles, expected, ignored, self.index)

    def keypoints(self, body: Body, keyframes: Sequence[Keyframe] = ()) -> Keypoints:
        """The performer's keypoints in all frames (F, N), told from other people's by keyframes, if any."""
        if not self.evidence.has_keypoints:
            return Keypoints.none(len(self.clip_frames))
        tracks, footage = self.tracks, self.footage
        own = replace(self.evidence, markers=self.styles if tracks.names else (), reference=None)
        take = scene_take(footage, own, self.clip_frames, body, read_lens(footage))
        known = tuple(keyframes) if any(people.most_people > 1 for people in take.keypoints) else ()
        if known:  # a moving camera is evaluated in every frame, which takes a while
            take = replace(take, camera=read_camera(footage, self.clip_frames), keyframes=known)
        return performer_keypoints(take, tracks)


def frame_in_footage(
    footage: Footage, evidence: SceneEvidence, reading: Reading | None = None
) -> FrameInFootage:
    """The scene's current frame in the footage, with the reading if it is of this; InputError outside it."""
    key = reading_key(footage.path, footage.rate, evidence.markers, None, evidence.ignored_regions)
    if reading is not None and of_same_footage(reading.key, key):
        frames = scene_frames(reading.tracks.time_s, footage.first_frame, footage.rate)
    else:
        reading = None
        frames = footage.first_frame + np.arange(footage.clip.frame_duration, dtype=np.float64)
    current = footage.scene.frame_current_final
    index = int(np.argmin(np.abs(frames - current)))
    if abs(float(frames[index]) - current) > NEAREST + 1e-6:
        if frames[0] < current < frames[-1]:
            advice = f"go to frame {round(float(frames[index]))}"
            raise InputError(
                f"the footage, whose rate varies, has no frame of its own at {current:g}; {advice}"
            )
        raise InputError(
            f"frame {current:g} lies outside the footage, whose frames are {frames[0]:g} to {frames[-1]:g}"
        )
    return FrameInFootage(footage, evidence, reading, frames, index)


def posed_standing(
    frame: FrameInFootage, body: Body, regions: RegionTracks | None, keypoints: Keypoints
) -> Posture:
    """A standing body at the performer's location in the frame; `keypoints` (F, N) are of all frames."""
    camera = read_camera(frame.footage, frame.clip_frames[[frame.index]])
    return place_standing(body, camera, 0, regions, frame.segments, keypoints.frame(frame.index))


@dataclass(frozen=True, eq=False)
class FrameResult:
    """What fitting a frame has found."""

    candidates: tuple[Candidate, ...]  # postures that it may show, the likeliest first; one near a pose
    contradictions: tuple[str, ...]  # names of the markers and keypoints that the first one does not explain
    residual_px: Array  # (M + N,) of markers and keypoints from where the first one has them; NaN if hidden
    cost: float = 0.0  # near a pose, what tells the likelier of several poses apart, as in `FramePoses`


def fit_to_frame(
    frame: FrameInFootage,
    armature_object: Object,
    action: Action | None,
    start: str,
    matches: Matches = NOT_MATCHED,
    libraries: Sequence[Library] = (),
    floor_m: float | None = None,
) -> FrameResult:
    """Fit the actor's posture to the frame; scene, Action and pose are as before.

    `start` is KEYFRAMES for any posture that the frame shows, of which the nearest keyframes tell too, ANEW
    for any without asking keyframes, POSE for one near the actor's pose as it is, when no library is asked.
    Only posed keyframes calibrate, and say where the floor is unless `floor_m` does. InputError where neither
    a marker nor a keypoint is seen in the frame, or something is missing.
    """
    body = read_body(armature_object)
    keyframes: tuple[Keyframe, ...] = ()  # at other frames
    if action is not None:
        read = read_keyframes(frame.footage.scene, armature_object, action, body, frame.clip_frames, matches)
        keyframes = tuple(keyframe for keyframe in read.keyframes if keyframe.index != frame.index)
    posed = tuple(keyframe for keyframe in keyframes if keyframe.matched is None)
    indices = np.array([keyframe.index for keyframe in posed], dtype=np.intp)
    keypoints = frame.keypoints(body, keyframes)
    camera = read_camera(frame.footage, frame.clip_frames[np.append(indices, frame.index)])
    model = RegionModel(body, camera, tuple(MarkerPlacement.usual(segment) for segment in frame.segments))
    belief = None
    if start == "POSE":
        belief = prior_from_pose(read_posture(armature_object, body).posture)
    elif start == "KEYFRAMES" and keyframes:
        belief = prior_from_keyframes(keyframes, frame.index, frame.footage.rate)
    expected = belief
    if expected is None and frame.reading is None and frame.styles:
        expected = prior_from_pose(posed_standing(frame, body, frame.regions(), keypoints))
    regions = frame.regions(None if expected is None else expected_in_frame(model, expected, len(posed)))
    points = ObservedKeypoints.of(keypoints)
    here = points[np.array([frame.index])]
    if not (regions.visible.any() or here.seen.any()):
        names = {"markers": frame.styles, "keypoints": keypoints.names}
        wanted = " and ".join(name for name, has in names.items() if has)
        why = f"none of the {wanted} is seen in frame {frame.clip_frames[frame.index]:g}"
        if not wanted:
            why = "neither markers nor keypoints are followed, which a pose is fitted to"
        raise InputError(f"{why}; pose the actor by hand")
    usual = KeypointEvidence.usual(body, camera, keypoints.names, keypoints.sources)
    evidence = uncalibrated(model, usual)
    if posed and (frame.reading is not None or not frame.styles):
        seen, frames = ObservedRegions.from_tracks(frame.tracks)[indices], np.arange(len(posed))
        postures = Posture.stack([keyframe.posture for keyframe in posed])
        evidence = calibrated(model, seen, postures, frames, usual, points[indices])
    shown = FrameShown(evidence, len(posed), regions, keypoints.frame(frame.index), here)
    if start == "POSE" and belief is not None:
        found = near_pose(shown, belief)
    else:
        floor_m = PosedFrames.of(body, posed).floor_m() if floor_m is None else floor_m
        found = find_frame_poses(shown, libraries, floor_m, belief)
    off = frame_residuals(evidence, shown.regions, here, found.candidates[0].posture, len(posed))
    residual_px = np.append(off.marker_px, off.keypoint_px)
    return FrameResult(found.candidates, found.contradictions, residual_px, found.cost)
