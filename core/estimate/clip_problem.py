"""The estimation problem of a whole clip: what is given, what was calibrated, and what has been learned."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..body.kinematics import Body
from ..body.posture import Posture
from ..body.skeleton import Skeleton
from ..camera.camera import Camera
from ..detect.keypoints import Keypoints
from ..markers.region_tracks import RegionTracks
from ..prior.frame_prior import REFERENCE_STEP_S, process_noise_factor
from ..prior.keyframes import with_turns
from ..terms.head import ObservedHeads
from ..terms.keypoints import ObservedKeypoints
from ..terms.region_model import MarkerPlacement, RegionModel
from ..terms.regions import FEATURES, ObservedRegions, limb_widths
from ..terms.term import ClipState
from ..video.album import Album
from .belief import Belief
from .keypoint_evidence import KeypointEvidence
from .windows import Window

LOOSE_NECK = 3.0
"""Factor on the neck's usual accelerations, and on what found keyframes err by there, where heads are seen:
how performers turn theirs is their own."""


def of_neck(skeleton: Skeleton, factor: float) -> Array:
    """(D,) a factor on the neck's degrees of freedom, 1 on others."""
    own = [name.startswith("neck.") for name in skeleton.dof_names]
    return np.where(own, factor, 1.0)


@dataclass(frozen=True, eq=False)
class KeyframeEvidence:
    """The calibrated model and the trust that keyframes and markers deserve."""

    model: RegionModel  # with the placements and the lens found
    posing_scale: float  # size of the posing error relative to a person's usual one
    distrust: Array  # (M,) factor, at least one, of the expected standard deviation of each marker's regions
    area_ratio: Array  # (M,) area of each marker's unhidden region, relative to the predicted one
    information: Array  # (K, D, D) inverse covariance of each keyframe's posing error
    keypoints: KeypointEvidence  # the calibrated model of keypoints, none where there are none


def uncalibrated(model: RegionModel, keypoints: KeypointEvidence | None = None) -> KeyframeEvidence:
    """Evidence before any keyframe is posed: average placements, full trust in all markers."""
    markers, dofs = len(model.placements), model.body.skeleton.dof_count
    return KeyframeEvidence(
        model,
        1.0,
        np.ones(markers),
        np.ones(markers),
        np.zeros((0, dofs, dofs)),
        keypoints or KeypointEvidence.usual(model.body, model.camera, (), ()),
    )


@dataclass(frozen=True, eq=False)
class Seen:
    """What was seen in the F frames of a clip."""

    tracks: RegionTracks  # regions of M markers
    segments: tuple[str, ...]  # the segment each marker is bound to
    keypoints: Keypoints | None = None  # the performer's; None for none
    album: Album | None = None  # pictures of all frames, in which contours are measured; None leaves them out
    there: BoolArray | None = None  # (F,) frames in which the performer is there; all where None


@dataclass(frozen=True, eq=False)
class ClipData:
    """What is known of a clip of F frames before anything is estimated."""

    body: Body
    camera: Camera  # as stated; the calibration has the lens found
    belief: Belief  # in the motion, with its keyframes
    seen: Seen
    keypoints: Keypoints  # of the performer, N of them; left and right exchanged back where they were swapped
    swapped: BoolArray  # (F, N) which of them were exchanged

    @property
    def time_s(self) -> Array:
        """(F,) of the frames [s]."""
        return self.seen.tracks.time_s

    @cached_property
    def there(self) -> BoolArray:
        """(F,) whether the performer is there; nothing is solved elsewhere."""
        return np.ones(len(self.time_s), dtype=bool) if self.seen.there is None else self.seen.there

    @cached_property
    def average(self) -> RegionModel:
        """The model of the markers' regions before anything is calibrated."""
        placements = tuple(MarkerPlacement.usual(name) for name in self.seen.segments)
        return RegionModel(self.body, self.camera, placements)

    @cached_property
    def observed(self) -> ObservedRegions:
        """The markers' regions."""
        return ObservedRegions.from_tracks(self.seen.tracks)

    @cached_property
    def width_px(self) -> Array:
        """(F, M) half-width of each marker's limb [px]."""
        return limb_widths(self.average, self.belief.prior.translation, np.arange(len(self.time_s)))

    @cached_property
    def points(self) -> ObservedKeypoints:
        """The keypoints as they are compared."""
        return ObservedKeypoints.of(self.keypoints)

    @cached_property
    def heads(self) -> ObservedHeads | None:
        """How the head turns; None where nobody looked."""
        return ObservedHeads.of(self.keypoints, self.camera)

    @cached_property
    def step_s(self) -> Array:
        """(F - 1,) time between frames [s]."""
        return np.maximum(np.diff(self.time_s), 1e-3)

    @cached_property
    def pace(self) -> float:
        """The usual time between frames, in those that accelerations are stated for."""
        return float(np.median(self.step_s)) / REFERENCE_STEP_S if len(self.step_s) else 1.0

    @cached_property
    def factor(self) -> Array:
        """(D, D) of the deviation's usual accelerations, as the keyframes have them."""
        belief = self.belief
        loose = of_neck(self.body.skeleton, 1.0 if self.heads is None else LOOSE_NECK)
        return process_noise_factor(belief.postures, self.time_s[belief.frame], loose)


@dataclass(frozen=True, eq=False)
class ClipProblem:
    """The estimation problem of a clip: what is given, what was calibrated, and what was learned."""

    data: ClipData
    evidence: KeyframeEvidence
    prior: Posture  # the interpolated postures with the turns
    turns: IndexArray  # (K - 1,) whole turns about the vertical that the prior adds in each gap
    limb_size: Array  # (D,) factor on the accelerations of each degree of freedom's limb
    depth_factor: Array  # (F, P) on the noise of the prior's depths, by how far the prior misses each point
    rests: Array | None = None  # (F - 1, A) how far each ankle seen rests; None where not asked

    @classmethod
    def begun(cls, data: ClipData, evidence: KeyframeEvidence) -> "ClipProblem":
        """The problem before anything has been learned."""
        prior, skeleton = data.belief.prior, data.body.skeleton
        return cls(
            data,
            evidence,
            prior,
            np.zeros(max(len(data.belief.frame) - 1, 0), dtype=np.intp),
            np.ones(skeleton.dof_count),
            np.ones((prior.batch[0], len(skeleton.points))),
        )

    @property
    def accelerations(self) -> Array:
        """(D, D) the factor L of usual accelerations, with what the footage shows."""
        return np.asarray(self.limb_size[:, None] * self.data.factor)

    @property
    def frames(self) -> int:
        """Number of frames F."""
        return self.prior.batch[0]

    def with_turns(self, turns: IndexArray) -> "ClipProblem":
        """The same with these whole turns (K - 1,) in the gaps between the keyframes."""
        prior = with_turns(self.data.belief.prior, self.data.belief.frame, turns)
        return replace(self, prior=prior, turns=turns)

    def start(self, window: Window) -> ClipState:
        """The state of a window to begin with: its prior, without biases."""
        frames, markers = window.last - window.first, self.data.observed.quality.shape[1]
        return ClipState(
            self.data.body,
            self.prior[window.frames],
            np.arange(window.first, window.last),
            self.accelerations,
            np.zeros((frames, self.data.body.skeleton.dof_count)),
            np.zeros((frames, markers * FEATURES)),
        )
