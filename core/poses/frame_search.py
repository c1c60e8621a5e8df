"""A search for the postures that one frame may show, from nothing but its regions and keypoints."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..body.kinematics import Body
from ..body.posture import Posture
from ..camera.camera import Camera
from ..detect.keypoints import Keypoints
from ..estimate.assembly import frame_terms, upright_terms
from ..estimate.clip_problem import KeyframeEvidence
from ..estimate.performer_placement import place_standing
from ..estimate.single_frame import exchanged
from ..markers.region_tracks import RegionTracks
from ..prior.frame_prior import ROUGH_POSE_SHARE, unrelated_std
from ..terms.keypoints import EXCHANGED_COST, ObservedKeypoints
from ..terms.regions import FEATURES, ObservedRegions, limb_widths
from ..terms.solver import descend
from ..terms.term import ClipState, total_cost
from .compose_clip import WIDE, frame_costs
from .composed_states import NO_CONTACT_COST
from .found_poses import ABOUT_RIGHT_M, distinct_rows
from .match_evidence import MatchEvidence
from .part_features import StanceFeatures, stance_features
from .part_pools import PartPools


@dataclass(frozen=True, eq=False)
class FrameShown:
    """One frame's evidence."""

    evidence: KeyframeEvidence  # models of what is seen, calibrated on keyframes or average
    frame: int  # the frame's index, which a moving camera's pose depends on
    tracks: RegionTracks  # the markers' regions in this frame alone
    keypoints: Keypoints  # the performer's keypoints in this frame alone
    points: ObservedKeypoints  # the same (1, N), with their confidence relative to the clip's

    @property
    def body(self) -> Body:
        """The take's body."""
        return self.evidence.model.body

    @property
    def is_empty(self) -> bool:
        """Whether nothing of the performer is seen."""
        return not (self.tracks.visible.any() or self.points.seen.any())

    @cached_property
    def segments(self) -> tuple[str, ...]:
        """The segment that each marker is bound to."""
        return tuple(placement.segment for placement in self.evidence.model.placements)

    @cached_property
    def camera(self) -> Camera:
        """The camera as it is in this frame."""
        camera = self.evidence.model.camera
        if not camera.is_moving:
            return camera
        return replace(camera, matrix_world=camera.matrix_world[self.frame])

    @cached_property
    def compared(self) -> MatchEvidence:
        """The same as screening compares it."""
        return MatchEvidence.of(self.tracks, self.segments, self.keypoints)

    @cached_property
    def regions(self) -> ObservedRegions:
        """The regions (1, M) with their axes."""
        return ObservedRegions.from_tracks(self.tracks)

    def points_of(self, is_exchanged: bool) -> ObservedKeypoints:
        """The keypoints, with left and right exchanged if so."""
        return exchanged(self.points, self.evidence.keypoints) if is_exchanged else self.points


# --- A search for the postures that one frame may show, from nothing but what is seen in it


FROM_START = (16.0, 8.0, 4.0, 2.0, *(1.0 for _ in range(6)))  # factors of the image noise, one a step
FROM_NEAR = FROM_START[-4:]
ALIKE = 3.0  # costs count for so many times less: what is seen of one body errs together, and so do its parts


@dataclass(frozen=True, eq=False)
class Hypotheses:
    """S postures that the frame may show."""

    posture: Posture  # (S,) in the world
    cost: Array  # (S,) negative log probability, up to a constant of the frame; 0 where nobody has asked yet
    exchanged: BoolArray  # (S,) whether left and right of the keypoints are exchanged

    @classmethod
    def concatenate(cls, parts: Sequence["Hypotheses"]) -> "Hypotheses":
        """Those of several searches, in order."""
        return cls(
            Posture.concatenate([part.posture for part in parts]),
            np.concatenate([part.cost for part in parts]),
            np.concatenate([part.exchanged for part in parts]),
        )

    def chosen(self, rows: IndexArray) -> "Hypotheses":
        """Some of them, in the order of their rows."""
        return Hypotheses(self.posture[rows], self.cost[rows], self.exchanged[rows])


@dataclass(frozen=True, eq=False)
class FrameSearch:
    """Hypotheses of the postures that one frame may show."""

    pools: PartPools
    shown: FrameShown
    floor_m: float | None  # height of the floor [m]; None where it is not known, when z = 0 may be it

    def hypotheses(self, count: int = 80) -> Hypotheses:
        """Hypotheses, in no order, at the end of the descents from `count` starts."""
        stances = stance_features(self.pools, self.shown.compared)
        floor_m = self.floor_m
        if floor_m is None:
            least = [self._screened(stances, height).cost.min() for height in (0.0, None)]
            floor_m = 0.0 if least[0] < least[1] + NO_CONTACT_COST else None
        sides = (False, True) if self.shown.compared.keypoints.names else (False,)
        every = Hypotheses.concatenate([self._screened(stances, floor_m, side) for side in sides])
        # Starts whose points, hips aligned, are nearer than this lead to the same posture.
        points = points_from_hips(self.pools.body, every.posture)
        starts = every.chosen(distinct_rows(points, np.argsort(every.cost), 0.05, count))
        found = replace(self, floor_m=floor_m).descended(starts, FROM_START)
        # Weight of a start's cost in screening, in which the many compositions around it count: a posture
        # that only one combination leads to is less likely than its own evidence says.
        return replace(found, cost=found.cost + 0.5 * (starts.cost - starts.cost.min()))

    def descended(self, starts: Hypotheses, temperatures: Sequence[float] = FROM_NEAR) -> Hypotheses:
        """Hypotheses brought to what is seen, by default from near it, with their costs."""
        order = np.argsort(starts.exchanged, kind="stable")
        found = [
            self._side_by_side(starts.posture[own], side, temperatures)
            for side in (False, True)
            if len(own := np.flatnonzero(starts.exchanged == side))
        ]
        place = np.argsort(order)
        posture = Posture.concatenate([postures for postures, _ in found])[place]
        cost = np.concatenate([costs for _, costs in found])[place] + EXCHANGED_COST * starts.exchanged
        # Cost of a body part of which lies behind the camera, where nothing can be compared.
        return replace(starts, posture=posture, cost=np.where(np.isfinite(cost), cost, 1e3))

    def likeliest_mean(self, found: Hypotheses) -> Posture:
        """The mean of the hypotheses around the one that most agree with, brought to what is seen."""
        weight, near = agreeing(points_from_hips(self.pools.body, found.posture), found.cost)
        row = int((near @ weight).argmax())
        mean = mean_posture(found.posture, row, near[row] * weight)
        return self.descended(replace(found.chosen(np.array([row])), posture=mean)).posture[0]

    def _screened(
        self, stances: StanceFeatures, floor_m: float | None, is_exchanged: bool = False
    ) -> Hypotheses:
        """The likeliest compositions of parts."""
        shown, pools = self.shown, self.pools
        evidence = shown.compared.exchanged() if is_exchanged else shown.compared
        (costs,) = frame_costs(shown.camera, evidence, stances, np.zeros(1, dtype=np.intp), floor_m)
        placed = place_standing(pools.body, shown.camera, 0, shown.tracks, shown.segments, evidence.keypoints)
        states = costs.states(float(shown.camera.depth(placed.translation)) * np.array(WIDE))
        cost = states.cost.astype(np.float64) + (EXCHANGED_COST if is_exchanged else 0.0)
        posture = stances.composed(states.stance, states.limbs, states.hips)
        return Hypotheses(posture, cost, np.full(len(cost), is_exchanged))

    def _side_by_side(
        self, starts: Posture, is_exchanged: bool, temperatures: Sequence[float]
    ) -> tuple[Posture, Array]:
        """Descents of the same evidence, and the costs of what is seen, floor, balance and limits."""
        shown, model, count = self.shown, self.shown.evidence.model, starts.batch[0]
        std = ROUGH_POSE_SHARE * unrelated_std(shown.body.skeleton)
        std[:3], std[5] = 0.3, 0.3  # sizes are good to a tenth, headings to 15 degrees
        frames = np.full(count, shown.frame, dtype=np.intp)
        width = limb_widths(model, np.median(starts.translation, axis=0)[None], frames[:1])
        bias = np.zeros((count, len(model.placements) * FEATURES))
        state = ClipState(shown.body, starts, frames, np.diag(std), np.zeros((count, len(std))), bias)
        points = shown.points_of(is_exchanged)
        standing = upright_terms(model.body, self.floor_m)
        terms = frame_terms(shown.evidence, shown.regions, count, width, points, standing)
        best, _ = descend(state, terms, temperatures)
        return best.posture, total_cost(terms[1:], best)


def points_from_hips(body: Body, posture: Posture) -> Array:
    """(S, P, 3) principal points relative to the hips [m]."""
    return np.asarray(body.points(body.pose(posture)) - posture.translation[:, None])


def agreeing(points: Array, cost: Array) -> tuple[Array, BoolArray]:
    """Probabilities (S,) of hypotheses, and (S, S) which of them are about the same.

    `points` (S, P, 3) relative to the hips [m], `cost` (S,).
    """
    weight = np.exp(-(cost - cost.min()) / ALIKE)
    near = np.linalg.norm(points[:, None] - points, axis=-1).mean(axis=-1) < ABOUT_RIGHT_M
    return weight / weight.sum(), near


def mean_posture(postures: Posture, row: int, weight: Array) -> Posture:
    """The mean (1,) of postures in the tangent space of one of them, by weights (S,)."""
    own = np.flatnonzero(weight)
    step = postures[own].minus(postures[np.full(len(own), row)])
    return postures[np.array([row])].plus((weight[own] @ step / weight[own].sum())[None])
