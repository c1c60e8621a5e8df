"""The estimation problem of a whole clip, without its pictures."""

from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..body.kinematics import Body
from ..body.posture import Posture
from ..camera.camera import Camera
from ..detect.keypoints import Keypoints
from ..markers.ignored_regions import IgnoredPixels
from ..prior.keyframes import with_turns
from ..terms.keypoints import ObservedKeypoints
from ..terms.reference import ExpectedPoints
from ..terms.region_model import RegionModel
from ..terms.regions import FEATURES, ObservedRegions, RegionNoise
from ..terms.state import ClipState
from .keypoint_evidence import KeypointEvidence
from .windows import Window


@dataclass(frozen=True, eq=False)
class KeyframeEvidence:
    """The calibrated model and the trust that keyframes and markers deserve."""

    model: RegionModel  # with the placements and the lens found
    posing_scale: float  # size of the posing error relative to a person's usual one
    timing_frames: float  # standard deviation of the keyframes' timing error [frames]
    distrust: Array  # (M,) factor, at least one, of the expected standard deviation of each marker's regions
    area_ratio: Array  # (M,) area of each marker's unhidden region, relative to the predicted one
    information: Array  # (K, D, D) inverse covariance of each keyframe's posing error
    keypoints: KeypointEvidence  # the calibrated model of keypoints, none where there are none


def uncalibrated(model: RegionModel) -> KeyframeEvidence:
    """Evidence before any keyframe is posed: average placements, full trust in all markers."""
    markers, dofs = len(model.placements), model.body.skeleton.dof_count
    return KeyframeEvidence(
        model,
        1.0,
        0.0,
        np.ones(markers),
        np.ones(markers),
        np.zeros((0, dofs, dofs)),
        KeypointEvidence.usual(model.body, model.camera, (), ()),
    )


@dataclass(frozen=True, eq=False, kw_only=True)
class ClipProblem:
    """Everything that the estimate of a clip of F frames follows from, except its pictures."""

    # What it is about.
    body: Body
    camera: Camera  # as stated; the evidence has the calibrated lens
    noise: RegionNoise

    # What the keyframes say.
    keyframes: IndexArray  # (K,) their frames
    matched: BoolArray  # (K,) which of them are matched, or corrected in the picture only
    corrected: BoolArray  # (K,) which of these a person vouches for in the picture
    evidence: KeyframeEvidence
    factor: Array  # (D, D) of the deviation's accelerations
    interpolated: Posture  # F postures: the keyframes interpolated, which turns the short way round
    depth_std_m: Array  # (F,) noise of the prior's depths [m]
    ankle_height_m: Array | None  # (F,) usual height of the lower ankle [m]; None where no floor is known

    # What the footage has taught.
    prior: Posture  # the interpolated postures with the turns
    turns: IndexArray  # (K - 1,) whole turns about the vertical that the prior adds in each gap
    limb_size: Array  # (D,) factor on the accelerations of each degree of freedom's limb
    rests: Array | None  # (F - 1, A) how far each ankle seen rests by the footage; None where not asked
    depth_factor: Array  # (F, P) on the noise of the prior's depths, by how far the prior misses each point
    observed: ObservedRegions  # the markers' regions: as tracked, and those found at a second look

    # What was seen.
    tracked: ObservedRegions  # the markers' regions as tracked
    width_px: Array  # (F, M) half-width of each marker's limb [px]
    ignored: IgnoredPixels | None  # what is never a marker, in all frames; None for nothing
    keypoints: Keypoints  # of the performer, N of them; left and right exchanged back where they were swapped
    points: ObservedKeypoints  # the same, as they are compared
    swapped: BoolArray  # (F, N) which of them were exchanged
    step_s: Array  # (F - 1,) time between frames [s]
    unseen: tuple[str, ...]  # limbs that are never seen
    there: BoolArray  # (F,) whether the performer is there; nothing is solved elsewhere
    reference: ExpectedPoints | None = None  # where a motion from elsewhere has the points; None without one

    @property
    def accelerations(self) -> Array:
        """(D, D) the factor L of usual accelerations, with what the footage shows."""
        return np.asarray(self.limb_size[:, None] * self.factor)

    @property
    def frames(self) -> int:
        """Number of frames F."""
        return self.prior.batch[0]

    def with_turns(self, turns: IndexArray) -> "ClipProblem":
        """The same with these whole turns (K - 1,) in the gaps between the keyframes."""
        prior = with_turns(self.interpolated, self.keyframes, turns)
        return replace(self, prior=prior, turns=turns)

    def start(self, window: Window) -> ClipState:
        """The state of a window to begin with: its prior, without biases."""
        frames, markers = window.last - window.first, self.observed.quality.shape[1]
        return ClipState(
            self.body,
            self.prior[window.frames],
            np.arange(window.first, window.last),
            self.accelerations,
            np.zeros((frames, self.body.skeleton.dof_count)),
            np.zeros((frames, markers * FEATURES)),
        )
