"""Postures of one frame to start a descent from: whole known ones, with their limbs exchanged for better ones.

Every known posture in every heading is screened in one product (`matching/frame_likelihood`). Each limb of the
likely ones is then compared with all known limbs on that trunk, and the likeliest of each depth side are
combined: given the trunk, limbs are independent, so that the costs of combinations are sums.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import product

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..body.heading import yaw_rotation, yawed_at
from ..body.kinematics import Body
from ..body.limbs import limb_of
from ..body.posture import Posture
from ..footage.camera import Camera
from ..matching.emissions import evaluate_emissions, state_features
from ..matching.frame_likelihood import FrameLikelihood, frame_likelihoods
from ..matching.marker_moments import MarkerMoments, marker_moments
from ..matching.match_evidence import MatchEvidence
from .known_postures import CARRIERS, LIMBS, KnownPostures
from .plausibility import plausibility_of

HEADINGS = 24
MOST_TRUNKS = 240
"""Placed postures whose limbs are exchanged."""
SAME_TRUNK_M = 0.04
"""Placed postures whose trunks are nearer than this count once."""
SAME_LIMB_M = 0.05
"""Known limbs nearer than this, in root mean square, count once."""
LIMB_STD_M = 0.07
"""What a known limb differs from the performer's, as the nearest one usually does."""
OTHER_LIMB_M = 0.12
"""Alternatives of a limb end farther apart than this."""
LIMB_ALTERNATIVES = 3
DEGREES = 4.0
"""Of Student's t."""
DISTINCT_M = 0.06
"""Starts whose points, hips aligned, are nearer than this lead to the same posture."""


@dataclass(frozen=True, eq=False)
class FrameStarts:
    """S placed postures to start from, the likeliest first."""

    posture: Posture
    """(S,) in the world."""
    nearest: IndexArray
    """(S,) number of the known posture that the trunk is of."""
    exchanged: BoolArray
    """(S,) whether left and right of the keypoints are exchanged."""


@dataclass(frozen=True, eq=False)
class FrameSearch:
    """Known postures, prepared for the markers and keypoints of a take."""

    known: KnownPostures
    evidence: MatchEvidence
    """Of which only the segments and the names of the keypoints count here."""

    @property
    def body(self) -> Body:
        """The take's body."""
        return self.known.body

    @cached_property
    def moments(self) -> MarkerMoments:
        """Where markers and keypoints are in each known posture."""
        return marker_moments(self.body, self.evidence, self.known.posture)

    @cached_property
    def states(self):  # type: ignore[no-untyped-def]
        """All postures in all headings."""
        return state_features(self.moments, HEADINGS)

    def starts(
        self, camera: Camera, evidence: MatchEvidence, frame: int, floor_m: float, floor_std_m: float, count: int
    ) -> FrameStarts:
        """The likeliest placed postures of a frame."""
        hypotheses = [evidence, evidence.exchanged()] if len(evidence.points) else [evidence]
        pool: list[tuple[float, int, int, Array, tuple[int, ...], bool]] = []
        for exchanged, one in enumerate(hypotheses):
            likelihood = frame_likelihoods(camera, one, np.array([frame]), floor_m, floor_std_m)[0]
            pool += self._composed(likelihood, bool(exchanged))
        return self._distinct(pool, count)

    def _composed(self, likelihood: FrameLikelihood, exchanged: bool):  # type: ignore[no-untyped-def]
        emissions = evaluate_emissions(likelihood, self.states)
        order = np.argsort(emissions.cost)
        heading = self.states.heading_rad
        own, turn = emissions.states // HEADINGS, emissions.states % HEADINGS
        kept: list[int] = []
        trunk = self._trunk_points
        places = np.einsum("nij,npj->npi", yaw_rotation(heading[turn]), trunk[own]) + emissions.hips.T[:, None]
        for index in order:
            if not kept or np.linalg.norm(places[kept] - places[index], axis=-1).mean(-1).min() > SAME_TRUNK_M:
                kept.append(int(index))
            if len(kept) == MOST_TRUNKS:
                break
        own, turn, hips = own[kept], turn[kept], emissions.hips.T[kept].astype(np.float64)
        rotation = yaw_rotation(heading[turn])
        base = self._trunk_cost(likelihood, own, rotation, hips)
        choices = [self._limb_choices(limb, likelihood, own, rotation, hips) for limb in LIMBS]
        pool = []
        for row in range(len(kept)):
            for picks in product(range(LIMB_ALTERNATIVES), repeat=len(LIMBS)):
                cost = base[row] + sum(choices[k][0][row, pick] for k, pick in enumerate(picks))
                limbs = tuple(int(choices[k][1][row, pick]) for k, pick in enumerate(picks))
                if np.isfinite(cost):
                    pool.append((float(cost + 3.0 * exchanged), int(own[row]), int(turn[row]), hips[row], limbs, exchanged))
        return pool

    @cached_property
    def _trunk_points(self) -> Array:
        names = self.body.skeleton.point_names
        trunk = [index for index, name in enumerate(names) if limb_of(name) == "trunk"]
        return self.moments.points[:, trunk]

    def _trunk_cost(self, likelihood, own, rotation, hips):  # type: ignore[no-untyped-def]
        """Cost of what the trunk shows, and of the trunk."""
        cost = self._prior[0][own]
        rows = [k for k, limb in enumerate(self._limb_of) if limb == "trunk" and likelihood.visible[k]]
        for k in rows:
            place = np.einsum("nij,nj->ni", rotation, self.moments.centroid[own, k]) + hips
            cost = cost + _point_cost(likelihood, k, place, 0.05)
        return cost

    @cached_property
    def _limb_of(self) -> list[str]:
        return [limb_of(name) for name in (*self.evidence.segments, *self.evidence.keypoints.names)]

    @cached_property
    def _prior(self) -> Array:
        return plausibility_of(self.known).costs(self.known.pose).T

    def _bank(self, limb: str) -> tuple[IndexArray, Array, Array, Array]:
        """Distinct known limbs: which postures', the evidence's places in the carrier's frame, cost, distal point."""
        return self._banks[limb]

    @cached_property
    def _banks(self):  # type: ignore[no-untyped-def]
        found = {}
        pose = self.known.pose
        names = self.body.skeleton.point_names
        for number, limb in enumerate(LIMBS):
            joint = self.body.skeleton.joint_index(CARRIERS[limb.partition(".")[0]])
            shape = self.known.parts[limb]
            prior = self._prior[1 + number]
            kept: list[int] = []
            for index in np.argsort(prior, kind="stable"):
                if not kept or np.linalg.norm(shape[kept] - shape[index], axis=-1).min() > SAME_LIMB_M:
                    kept.append(int(index))
            rows = [k for k, own in enumerate(self._limb_of) if own == limb]
            offset = pose.origin[:, joint] - self.known.posture.translation
            local = np.einsum("nkj,nji->nki", self.moments.centroid[:, rows] - offset[:, None], pose.rotation[:, joint])
            last = [i for i, name in enumerate(names) if limb_of(name) == limb][-1]
            distal = np.einsum("nj,nji->ni", self.moments.points[:, last] - offset, pose.rotation[:, joint])
            found[limb] = (np.array(kept), rows, local[kept], prior[kept], distal[kept], joint, offset)
        return found

    def _limb_choices(self, limb, likelihood, own, rotation, hips):  # type: ignore[no-untyped-def]
        kept, rows, local, prior, distal, joint, offset = self._banks[limb]
        carrier = rotation @ self.known.pose.rotation[own, joint]
        origin = hips + np.einsum("nij,nj->ni", rotation, offset[own])
        cost = np.broadcast_to(prior, (len(own), len(kept))).copy()
        for k, row in enumerate(rows):
            if likelihood.visible[row]:
                place = origin[:, None] + np.einsum("nij,mj->nmi", carrier, local[:, k])
                cost += _point_cost(likelihood, row, place, LIMB_STD_M)
        end = np.einsum("nij,mj->nmi", carrier, distal)
        best, index = np.full((len(own), LIMB_ALTERNATIVES), np.inf), np.zeros((len(own), LIMB_ALTERNATIVES), dtype=np.intp)
        open_cost = cost.copy()
        each = np.arange(len(own))
        for rank in range(LIMB_ALTERNATIVES):
            pick = open_cost.argmin(axis=1)
            best[:, rank], index[:, rank] = open_cost[each, pick], kept[pick]
            near = np.linalg.norm(end - end[each, pick][:, None], axis=-1) < OTHER_LIMB_M
            open_cost[near] = np.inf
        return best, index

    def _distinct(self, pool, count) -> FrameStarts:  # type: ignore[no-untyped-def]
        pool.sort(key=lambda one: one[0])
        pool = pool[: 40 * count]
        posture = self.assembled(pool)
        points = self.body.points(self.body.pose(posture)) - posture.translation[:, None]
        kept: list[int] = []
        for index in range(len(pool)):
            if not kept or np.linalg.norm(points[kept] - points[index], axis=-1).mean(-1).min() > DISTINCT_M:
                kept.append(index)
            if len(kept) == count:
                break
        chosen = np.array(kept)
        return FrameStarts(posture[chosen], np.array([pool[k][1] for k in kept]), np.array([pool[k][5] for k in kept]))

    def assembled(self, pool) -> Posture:  # type: ignore[no-untyped-def]
        known, skeleton = self.known.posture, self.body.skeleton
        trunk = np.array([one[1] for one in pool])
        rotations, angles = np.array(known.rotations[trunk]), np.array(known.angles[trunk])
        dofs = skeleton.limbs
        for number in range(len(LIMBS)):
            source = np.array([one[4][number] for one in pool])
            joints = {LIMB_JOINT_OF(skeleton, dof) for dof in dofs[number + 1]}
            balls = [c for c, j in enumerate(skeleton.ball_joints) if j in joints]
            hinges = [c for c, j in enumerate(skeleton.hinge_joints) if j in joints]
            rotations[:, balls] = known.rotations[source][:, balls]
            angles[:, hinges] = known.angles[source][:, hinges]
        hips = np.stack([one[3] for one in pool])
        turn = self.states.heading_rad[[one[2] for one in pool]]
        return yawed_at(Posture(skeleton, hips, rotations, angles), turn, hips)


def LIMB_JOINT_OF(skeleton, dof):  # type: ignore[no-untyped-def]
    starts = np.array(skeleton.dof_starts)
    return int(np.searchsorted(starts, dof, side="right") - 1)


def _point_cost(likelihood: FrameLikelihood, row: int, place: Array, std_m: float) -> Array:
    """Cost of one seen point's distance from places (..., 3) in the world."""
    error = (place - likelihood.location) @ likelihood.image_axes[row].T / std_m
    return 0.5 * (DEGREES + 2.0) * np.log1p((error**2).sum(-1) / DEGREES)
