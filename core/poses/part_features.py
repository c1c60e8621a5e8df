"""Features of parts: where what is seen of them lies, in the frame of what they hang on.

Torsos in all headings are *stances*: a stance gives the frames of the pelvis and of the chest, from which
legs and arms hang.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..arrays import Array, BoolArray, IndexArray, SingleArray, single
from ..body.body_volume import sole_places
from ..body.human import HUMAN, LIMBS, TRUNK, limb_of
from ..body.mirror import mirrored
from ..body.posture import Posture, yaw_rotation
from ..estimate.performer_placement import standing_ankle_m
from .frame_likelihood import ENTRIES, products
from .match_evidence import MatchEvidence, marker_moments
from .part_pools import ARM, PartPool, PartPools

HEADINGS = 24
TRUNK_POINTS = [index for index, name in enumerate(HUMAN.point_names) if limb_of(name) == TRUNK]
"""The trunk's among the principal points."""


@dataclass(frozen=True, eq=False)
class PartFeatures:
    """Features of the N parts of a pool, or of all stances, for some evidence."""

    observed: IndexArray  # (A,) which of the evidence's markers and keypoints lie on this part; markers first
    place: SingleArray  # (N, A, 3) where they are in the frame of what the part hangs on [m]
    second_moment: SingleArray  # (N, M, 6) second moments of the markers among them [m²], see `ENTRIES`
    points: SingleArray  # (N, Q, 3) elbow and wrist, knee and ankle; of stances all others [m]
    soles: SingleArray  # (N, 2, 3) heel and tip of a leg's foot; none else [m]
    cost: SingleArray  # (N,) how unusual each is

    @cached_property
    def middle(self) -> SingleArray:
        """(A, 3) means of `place`."""
        return np.asarray(self.place.mean(axis=0))

    @cached_property
    def variance(self) -> SingleArray:
        """(A,) variances of `place` along an axis [m²]."""
        return np.asarray(self.place.var(axis=0).mean(axis=-1))

    @cached_property
    def products(self) -> list[SingleArray]:
        """(10, N) of each column of `place`, see `products`."""
        return [products(np.ascontiguousarray(own)) for own in np.swapaxes(self.place, 0, 1)]

    def columns(self, seen: BoolArray) -> list[tuple[int, int]]:
        """Columns of `place` of those of the evidence (A,) that are seen in a frame, and which these are."""
        return [(column, int(own)) for column, own in enumerate(self.observed) if seen[own]]


@dataclass(frozen=True, eq=False)
class StanceFeatures:
    """S stances, T torsos in H headings: torso s // H in heading s % H."""

    pools: PartPools  # the parts
    features: PartFeatures
    pelvis: SingleArray  # (S, 3, 3) turn of the pelvis in the world
    chest: SingleArray  # (S, 3, 3) turn of the chest
    chest_place: SingleArray  # (S, 3) origin of the chest's frame from the hips [m], in the world's axes
    heading_rad: Array  # (H,)
    limbs: dict[str, PartFeatures]  # features of each limb's parts
    limb_cost: dict[str, SingleArray]  # (T, L) how unusual each part of a limb is with each torso
    ankle_height_m: float  # height of the ankles over flat soles

    def frame_of(self, limb: str, stance: IndexArray) -> tuple[SingleArray, SingleArray]:
        """Turn (N, 3, 3) and place (N, 3) from the hips of what a limb hangs on."""
        if limb.startswith(ARM):
            return self.chest[stance], self.chest_place[stance]
        turn = self.pelvis[stance]
        return turn, np.zeros((len(turn), 3), dtype=np.float32)

    def composed(self, stance: IndexArray, limbs: IndexArray, hips: Array | SingleArray) -> Posture:
        """Postures of stances (N,) with limbs (N, 4), in the order of `LIMBS`, the hips at (N, 3) [m]."""
        parts = {limb: limbs[:, column] for column, limb in enumerate(LIMBS)}
        heading = self.heading_rad[stance % HEADINGS]
        return self.pools.composed(stance // HEADINGS, parts, heading, np.asarray(hips, dtype=float))


def stance_features(pools: PartPools, evidence: MatchEvidence) -> StanceFeatures:
    """Features of all stances and limbs for some evidence."""
    body, torsos = pools.body, pools.torsos
    heading = 2.0 * np.pi * np.arange(HEADINGS) / HEADINGS
    turn = yaw_rotation(heading)
    pose = body.pose(torsos.posture)
    waist = HUMAN.joint_index("waist")

    def turned(vectors: Array) -> Array:
        """(S, ..., 3) vectors of torsos (T, ..., 3) in all headings."""
        flat = vectors.reshape(len(torsos), -1, 3)
        all_ways = np.einsum("hij,tqj->thqi", turn, flat)
        return all_ways.reshape(len(torsos) * HEADINGS, *vectors.shape[1:])

    observed = _observed(evidence, TRUNK)
    moments = marker_moments(body, evidence, torsos.posture)
    markers = observed[observed < len(evidence.segments)]
    second = np.einsum("hij,tmjk,hlk->thmil", turn, moments.second_moment[:, markers], turn, optimize=True)
    features = PartFeatures(
        observed,
        single(turned(moments.centroid[:, observed])),
        _symmetric(second.reshape(len(torsos) * HEADINGS, len(markers), 3, 3)),
        single(turned(moments.points)),
        np.zeros((len(torsos) * HEADINGS, 0, 3), dtype=np.float32),
        single(np.repeat(torsos.cost, HEADINGS)),
    )
    frames = [
        np.einsum("hij,tjk->thik", turn, pose.rotation[:, joint]).reshape(-1, 3, 3) for joint in (0, waist)
    ]
    limbs = {limb: _limb_features(pools, evidence, limb) for limb in LIMBS}
    return StanceFeatures(
        pools,
        features,
        single(frames[0]),
        single(frames[1]),
        single(turned(pose.origin[:, waist])),
        heading,
        limbs,
        {limb: single(pools.limb_cost[limb]) for limb in LIMBS},
        standing_ankle_m(body),
    )


def limb_points(limb: str) -> list[int]:
    """Indices of a limb's two principal points: elbow and wrist, or knee and ankle."""
    return [index for index, name in enumerate(HUMAN.point_names) if limb_of(name) == limb]


def _limb_features(pools: PartPools, evidence: MatchEvidence, limb: str) -> PartFeatures:
    kind, side = limb.split(".")
    pool: PartPool = pools.arms if kind == ARM else pools.legs
    posture = pool.posture if side == "L" else mirrored(pool.posture)
    body = pools.body
    observed = _observed(evidence, limb)
    moments = marker_moments(body, evidence, posture)
    chest = body.offsets[HUMAN.joint_index("waist")] if kind == ARM else np.zeros(3)
    markers = observed[observed < len(evidence.segments)]
    points = limb_points(limb)
    soles = np.zeros((len(pool), 0, 3))
    if kind != ARM:
        soles = sole_places(body, body.pose(posture))[:, ("L", "R").index(side)]
    return PartFeatures(
        observed,
        single(moments.centroid[:, observed] - chest),
        _symmetric(moments.second_moment[:, markers]),
        single(moments.points[:, points] - chest),
        single(soles),
        single(pool.cost),
    )


def _observed(evidence: MatchEvidence, part: str) -> IndexArray:
    return np.array([i for i, name in enumerate(evidence.names) if limb_of(name) == part], dtype=np.intp)


def _symmetric(matrices: Array) -> SingleArray:
    """(..., 6) entries of symmetric matrices (..., 3, 3)."""
    return single(np.stack([matrices[..., i, j] for i, j in ENTRIES], axis=-1))
