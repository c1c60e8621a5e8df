"""A search for the postures that one frame may show, from nothing but its regions and keypoints."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..body.kinematics import Body
from ..body.posture import Posture
from ..camera.camera import Camera
from ..detect.keypoints import Keypoints
from ..estimate.assembly import free_frame_terms
from ..estimate.clip_problem import KeyframeEvidence
from ..estimate.performer_placement import place_standing
from ..estimate.single_frame import exchanged
from ..markers.region_tracks import RegionTracks
from ..prior.frame_prior import ROUGH_POSE_SHARE, unrelated_std
from ..prior.library import Library
from ..terms.keypoints import ObservedKeypoints
from ..terms.regions import FEATURES, ObservedRegions, limb_widths
from ..terms.solver import descend
from ..terms.state import ClipState
from ..terms.term import total_cost
from .candidates import distinct_rows
from .compose_clip import WIDE, frame_costs
from .composed_states import NO_CONTACT_COST
from .frame_likelihood import EXCHANGED_COST
from .match_evidence import MatchEvidence
from .part_features import HEADINGS, StanceFeatures, composed_postures, stance_features
from .part_pools import PartPools, kept, part_pools
from .plausibility import KnownPostures, known_postures


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

    def points_of(self, is_exchanged: bool) -> ObservedKeypoints | None:
        """The keypoints, with left and right exchanged if so; None without any."""
        known = self.evidence.keypoints
        if not known.model.names:
            return None
        return exchanged(self.points, known.model.names, known.sources) if is_exchanged else self.points

    def frames(self, count: int) -> IndexArray:
        """(count,) the frame's index."""
        return np.full(count, self.frame, dtype=np.intp)

    def without(self, marker: int) -> "FrameShown":
        """The same with a marker hidden."""
        hidden: dict[str, Any] = {}
        for name in ("centroid", "second_moment", "area", "quality"):
            values = np.array(getattr(self.tracks, name))
            values[:, marker] = 0.0 if name == "quality" else np.nan
            hidden[name] = values
        return replace(self, tracks=replace(self.tracks, **hidden))


# --- A search for the postures that one frame may show, from nothing but what is seen in it


MOST_STARTS = 80  # postures that descend side by side
PLACE_STD_M, TURN_STD_RAD = 0.3, 0.3  # of a descent: sizes are good to a tenth, headings to 15 degrees
FROM_START = (16.0, 8.0, 4.0, 2.0, *(1.0 for _ in range(6)))  # factors of the image noise, one a step


@dataclass(frozen=True, eq=False)
class Knowledge:
    """What is known of postures on one body."""

    pools: PartPools
    postures: KnownPostures


@dataclass(frozen=True, eq=False)
class Hypotheses:
    """S postures that the frame may show."""

    posture: Posture  # (S,) in the world
    cost: Array  # (S,) negative log probability, up to a constant of the frame
    torso: IndexArray  # (S,) torso of the pools that each began with
    exchanged: BoolArray  # (S,) whether left and right of the keypoints are exchanged

    @classmethod
    def given(cls, posture: Posture, exchanged: BoolArray) -> "Hypotheses":
        """Postures (S,) that come from elsewhere, whose costs nobody has asked yet."""
        count = len(exchanged)
        return cls(posture, np.zeros(count), np.zeros(count, dtype=np.intp), exchanged)

    @classmethod
    def concatenate(cls, parts: Sequence["Hypotheses"]) -> "Hypotheses":
        """Those of several searches, in order."""
        return cls(
            Posture.concatenate([part.posture for part in parts]),
            np.concatenate([part.cost for part in parts]),
            np.concatenate([part.torso for part in parts]),
            np.concatenate([part.exchanged for part in parts]),
        )

    def chosen(self, rows: IndexArray) -> "Hypotheses":
        """Some of them, in the order of their rows."""
        return Hypotheses(self.posture[rows], self.cost[rows], self.torso[rows], self.exchanged[rows])


def knowledge(body: Body, libraries: Sequence[Library]) -> Knowledge:
    """What some libraries tell of postures on a body; that of the last few bodies is kept.

    Raises:
        InputError: No library has a posture.
    """
    usable = [each for each in libraries if each.postures]

    def learn() -> Knowledge:
        postures = known_postures(body, usable)
        return Knowledge(part_pools(usable, body), postures)

    return kept(Knowledge, usable, body, learn)


def search(
    known: Knowledge, shown: FrameShown, floor_m: float | None, count: int = MOST_STARTS
) -> Hypotheses:
    """Hypotheses, in no order, of the postures that a frame may show, from `count` starts.

    Where the floor is not known, it is asked whether z = 0 may be it.
    """
    starts, screened, floor_m = _starts(known, shown, floor_m, count)
    posture, cost = _descended(known, shown, starts, floor_m)
    # Weight of a start's cost in screening, in which the many compositions around it count: a posture that
    # only one combination leads to is less likely than its own evidence says.
    return replace(starts, posture=posture, cost=cost + 0.5 * (screened - screened.min()))


def _starts(
    known: Knowledge, shown: FrameShown, floor_m: float | None, count: int
) -> tuple[Hypotheses, Array, float | None]:
    """The likeliest distinct compositions, their costs in screening, and the height of the floor if known."""
    stances = stance_features(known.pools, shown.compared)
    if floor_m is None:
        least = [_screened(known, stances, shown, height).cost.min() for height in (0.0, None)]
        floor_m = 0.0 if least[0] < least[1] + NO_CONTACT_COST else None
    found = [_screened(known, stances, shown, floor_m)]
    if shown.compared.keypoints.names:
        found.append(_screened(known, stances, shown, floor_m, is_exchanged=True))
    every = Hypotheses.concatenate(found)
    kept = distinct_rows(
        # Starts whose points, hips aligned, are nearer than this lead to the same posture.
        points_from_hips(known.pools.body, every.posture),
        np.argsort(every.cost),
        0.05,
        count,
    )
    return every.chosen(kept), every.cost[kept], floor_m


def _screened(
    known: Knowledge,
    stances: StanceFeatures,
    shown: FrameShown,
    floor_m: float | None,
    is_exchanged: bool = False,
) -> Hypotheses:
    evidence = shown.compared.exchanged() if is_exchanged else shown.compared
    (costs,) = frame_costs(shown.camera, evidence, stances, np.zeros(1, dtype=np.intp), floor_m)
    placed = place_standing(
        known.pools.body, shown.camera, 0, shown.tracks, shown.segments, evidence.keypoints
    )
    depth = float(shown.camera.depth(placed.translation))
    states = costs.states(depth * np.array(WIDE))
    cost = states.cost.astype(np.float64) + (EXCHANGED_COST if is_exchanged else 0.0)
    posture = composed_postures(known.pools, stances, states.stance, states.limbs, states.hips)
    return Hypotheses(posture, cost, states.stance // HEADINGS, np.full(len(cost), is_exchanged))


def refined(known: Knowledge, shown: FrameShown, given: Hypotheses, floor_m: float | None) -> Hypotheses:
    """Hypotheses brought to what is seen, from near it."""
    posture, cost = _descended(known, shown, given, floor_m, FROM_START[-4:])
    return replace(given, posture=posture, cost=cost)


def _descended(
    known: Knowledge,
    shown: FrameShown,
    starts: Hypotheses,
    floor_m: float | None,
    temperatures: Sequence[float] = FROM_START,
) -> tuple[Posture, Array]:
    """Postures at the end of all descents, and their costs."""
    count = len(starts.cost)
    order, postures, costs = [], [], []
    for is_exchanged in (False, True):
        own = np.flatnonzero(starts.exchanged == is_exchanged)
        if len(own):
            posture, cost = _side_by_side(shown, starts.posture[own], is_exchanged, floor_m, temperatures)
            order.append(own)
            postures.append(posture)
            costs.append(cost)
    place = np.argsort(np.concatenate(order)) if count else np.zeros(0, dtype=np.intp)
    posture = Posture.concatenate(postures)[place]
    cost = np.concatenate(costs)[place] + EXCHANGED_COST * starts.exchanged
    cost = cost + known.postures.costs(known.pools.body.pose(posture)).sum(axis=-1)
    # Cost of a body part of which lies behind the camera, where nothing can be compared.
    return posture, np.where(np.isfinite(cost), cost, 1e3)


def _side_by_side(
    shown: FrameShown,
    starts: Posture,
    is_exchanged: bool,
    floor_m: float | None,
    temperatures: Sequence[float],
) -> tuple[Posture, Array]:
    """Descents of the same evidence, and the costs of what is seen, floor, balance and limits."""
    body, model, count = shown.body, shown.evidence.model, starts.batch[0]
    std = ROUGH_POSE_SHARE * unrelated_std(body.skeleton)
    std[:3], std[5] = PLACE_STD_M, TURN_STD_RAD
    width = limb_widths(model, np.median(starts.translation, axis=0)[None], shown.frames(1))
    nothing = np.zeros((count, len(model.placements) * FEATURES))
    state = ClipState(body, starts, shown.frames(count), np.diag(std), np.zeros((count, len(std))), nothing)
    belief, terms = free_frame_terms(
        shown.evidence, shown.regions, count, floor_m, width, shown.points_of(is_exchanged)
    )
    best, _ = descend(state, [belief, *terms], temperatures)
    return best.posture, total_cost(terms, best)


def points_from_hips(body: Body, posture: Posture) -> Array:
    """(S, P, 3) principal points relative to the hips [m]."""
    return np.asarray(body.points(body.pose(posture)) - posture.translation[:, None])
