"""Fit an actor to one frame of the footage: from a scene to core's single-frame fit."""

from collections.abc import Sequence
from dataclasses import dataclass

import bpy
import numpy as np

from ...core.arrays import Array
from ...core.body.human import HUMAN
from ...core.body.kinematics import Body
from ...core.body.posture import Posture
from ...core.errors import InputError
from ...core.estimate.actor_measure import MeasuredActor, measure_standing
from ...core.estimate.keyframe_evidence import uncalibrated
from ...core.estimate.performer_placement import place_standing
from ...core.estimate.single_frame import FrameFit, calibrated, expected_in_frame, fit_frame
from ...core.estimate.terms.regions import ObservedRegions
from ...core.footage.marker_style import MarkerStyle
from ...core.footage.reading import Reading
from ...core.footage.reading_key import of_same_footage, reading_key
from ...core.footage.region_tracks import ExpectedRegions, RegionTracks
from ...core.footage.single_frame_regions import regions_of_frame
from ...core.observation.depths import DEPTH_STD_M
from ...core.observation.regions import MarkerPlacement, RegionModel
from ...core.prior.frame_prior import FramePrior, prior_from_keyframes, prior_from_pose, prior_from_standing
from ...core.prior.keyframes import Keyframe
from .actor_lengths import read_body
from .camera_from_scene import read_camera
from .footage import Footage
from .keyframes import NEAREST, NOT_MATCHED, Matches, read_keyframes
from .pose import read_posture
from .scene_frames import scene_frames

STANDS_HERE = 1.5
"""Ratio of marker distances, shown body to one placed anew, above which the shown body is elsewhere."""


@dataclass(frozen=True, eq=False)
class FrameInFootage:
    """The scene's current frame as a frame of the footage."""

    footage: Footage
    styles: tuple[MarkerStyle, ...]
    reading: Reading | None
    """An earlier reading of the clip, if it is of this footage and these markers."""
    clip_frames: Array
    """(F,) scene frame of every frame of the clip; estimated from its header where it was not read."""
    index: int
    """Index of the current frame in the clip."""

    @property
    def segments(self) -> tuple[str, ...]:
        """The segment each marker is bound to."""
        return tuple(style.segment for style in self.styles)

    def regions(self, expected: ExpectedRegions | None = None) -> RegionTracks:
        """The markers' regions in the frame: from the reading, else found now.

        Args:
            expected: Expected regions (1, M), which tell markers of similar color apart.

        Raises:
            InputError: A color does not occur in the clip, or the clip cannot be read.
        """
        if self.reading is not None:
            return self.reading.tracks.frame(self.index)
        time_s = (float(self.clip_frames[self.index]) - self.footage.first_frame) / self.footage.rate
        return regions_of_frame(self.footage.open(), time_s, self.styles, expected)


def frame_in_footage(
    footage: Footage, styles: Sequence[MarkerStyle], reading: Reading | None = None
) -> FrameInFootage:
    """The scene's current frame in the footage.

    Args:
        footage: Clip and camera in their scene.
        styles: The markers.
        reading: An earlier reading of the clip; used if it is of this footage and these markers.

    Raises:
        InputError: The clip is missing, or the current frame lies outside it.
    """
    key = reading_key(footage.path, footage.rate, styles, None)
    if reading is not None and of_same_footage(reading.key, key):
        frames = scene_frames(reading.tracks.time_s, footage.first_frame, footage.rate)
    else:
        reading = None
        frames = footage.first_frame + np.arange(footage.clip.frame_duration, dtype=np.float64)
    current = footage.scene.frame_current_final
    index = int(np.argmin(np.abs(frames - current)))
    if abs(float(frames[index]) - current) > NEAREST + 1e-6:
        if frames[0] < current < frames[-1]:
            raise InputError(
                f"the footage, whose rate varies, has no frame of its own at {current:g}; "
                f"go to frame {round(float(frames[index]))}"
            )
        raise InputError(
            f"frame {current:g} lies outside the footage, whose frames are {frames[0]:g} to {frames[-1]:g}"
        )
    return FrameInFootage(footage, tuple(styles), reading, frames, index)


def posed_standing(frame: FrameInFootage, body: Body, regions: RegionTracks | None) -> Posture:
    """A standing body at the performer's location in the frame."""
    camera = read_camera(frame.footage, frame.clip_frames[[frame.index]])
    return place_standing(body, camera, 0, regions, frame.segments)


def fit_to_frame(
    frame: FrameInFootage,
    armature_object: bpy.types.Object,
    action: bpy.types.Action | None,
    start: str,
    matches: Matches = NOT_MATCHED,
) -> FrameFit:
    """Fit the actor's posture to the frame; scene, Action and pose are as before.

    Args:
        frame: The frame.
        armature_object: The actor.
        action: The animator's keyframes; None for none.
        start: KEYFRAMES for the nearest ones (standing where there are none), POSE for the actor's pose as it
            is, STANDING for a body that stands where the performer is.
        matches: The matched keyframes; marker placements are not calibrated on these.

    Raises:
        InputError: No marker is visible in the frame, or clip, camera or a bone is missing.
    """
    body = read_body(armature_object, HUMAN)
    keyframes = _keyframes(frame, armature_object, action, body, matches)
    posed = tuple(keyframe for keyframe in keyframes if keyframe.matched is None)
    indices = np.array([keyframe.index for keyframe in posed], dtype=np.intp)
    camera = read_camera(frame.footage, frame.clip_frames[np.append(indices, frame.index)])
    model = RegionModel(body, camera, tuple(MarkerPlacement.usual(segment) for segment in frame.segments))
    if start == "POSE":
        belief = prior_from_pose(read_posture(armature_object, body).posture)
    elif start == "KEYFRAMES" and keyframes:
        belief = prior_from_keyframes(keyframes, frame.index, frame.footage.rate)
    else:
        belief = _standing_belief(frame, model, read_posture(armature_object, body).posture)
    regions = frame.regions(expected_in_frame(model, belief, len(posed)))
    if not regions.visible.any():
        raise InputError(
            f"none of the markers is seen in frame {frame.clip_frames[frame.index]:g}; pose the actor by hand"
        )
    evidence = uncalibrated(model)
    if frame.reading is not None and posed:
        seen = ObservedRegions.from_tracks(frame.reading.tracks)[indices]
        evidence = calibrated(
            model, seen, Posture.stack([keyframe.posture for keyframe in posed]), np.arange(len(posed))
        )
    return fit_frame(evidence, ObservedRegions.from_tracks(regions), belief, len(posed))


def _standing_belief(frame: FrameInFootage, model: RegionModel, shown: Posture) -> FramePrior:
    """Prior about the shown posture if it is at the performer's location, else about one placed there."""
    regions = frame.regions()
    placed = posed_standing(frame, model.body, regions)
    both = Posture.stack([shown, placed])
    last = model.camera.matrix_world.shape[0] - 1 if model.camera.is_moving else 0
    predicted = model.evaluate(model.body.pose(both), np.array([last, last]))
    apart = np.linalg.norm(predicted.centroid - regions.centroid, axis=-1)
    if not np.isfinite(apart).any():
        return prior_from_standing(placed)
    of_shown, of_placed = np.nanmean(apart, axis=1)
    if of_shown <= STANDS_HERE * of_placed:
        return prior_from_standing(shown, DEPTH_STD_M)
    return prior_from_standing(placed)


def _keyframes(
    frame: FrameInFootage,
    armature_object: bpy.types.Object,
    action: bpy.types.Action | None,
    body: Body,
    matches: Matches,
) -> tuple[Keyframe, ...]:
    """The keyframes at other frames."""
    if action is None:
        return ()
    found = read_keyframes(frame.footage.scene, armature_object, action, body, frame.clip_frames, matches)
    return tuple(keyframe for keyframe in found.keyframes if keyframe.index != frame.index)


def measured_in_frame(
    frame: FrameInFootage,
    stature_m: float,
    crown_px: tuple[float, ...],
    ground_px: tuple[float, ...],
    arms_stretched: bool,
) -> MeasuredActor:
    """Measure the performer in a frame in which they stand; see `measure_standing`.

    Raises:
        InputError: The two pixels cannot be those of a person.
    """
    camera = read_camera(frame.footage, frame.clip_frames[[frame.index]])
    regions = frame.regions() if frame.styles else None
    return measure_standing(
        camera, 0, stature_m, crown_px, ground_px, regions, frame.segments, arms_stretched
    )
