"""A posed frame among composed ones: its parts are the nearest; and how plausible any body's parts are."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.special import logsumexp

from ..arrays import Array, BoolArray, IndexArray, SingleArray
from ..body.human import TRUNK
from ..body.kinematics import Body, Pose
from ..numerics.robust import multivariate_cost
from ..prior.library import Library
from .composed_states import FrameCosts, FrameStates
from .known_motions import PARTS, KnownPostures, known_postures, part_shapes
from .match_evidence import FrameLikelihood
from .part_features import TRUNK_POINTS, StanceFeatures, limb_points
from .part_pools import TORSO, part_dofs


class PosedCosts(FrameCosts):
    """Costs of stances and limbs by how far they are from a posed frame's points."""

    def __init__(
        self,
        likelihood: FrameLikelihood,
        stances: StanceFeatures,
        hips: Array,
        points: Array,
        tempering: float,
    ) -> None:
        """Hold stances and limbs against hips (3,) and points (P, 3) from there of a posed frame [m].

        `tempering` is what the frame's costs will be multiplied by; a posed frame says its own once.
        """
        super().__init__(likelihood, stances, None)
        self.hips = np.asarray(hips - likelihood.location, dtype=np.float32)
        self.points = np.asarray(points, dtype=np.float32)
        # Distance of a posed point from the nearest part's: what pools are rough by, and a person's error.
        self.weight = np.float32(0.5 / 0.06**2 / tempering)

    def places(
        self, stance: IndexArray, depth_m: SingleArray, limbs: IndexArray | None = None
    ) -> SingleArray:
        """(N, 3) the posed place of the hips from the camera [m]."""
        return np.broadcast_to(self.hips, (len(stance), 3)).copy()

    def torso_cost(self, stance: IndexArray, places: SingleArray) -> SingleArray:
        """(N,) cost of stances by shoulders, hips and head."""
        off = self.stances.features.points[stance][:, TRUNK_POINTS] - self.points[TRUNK_POINTS]
        return np.asarray(self.weight * (off * off).sum(axis=(1, 2)))

    def limb_table(self, limb: str, stance: IndexArray, places: SingleArray) -> SingleArray:
        """(N, L) cost of each of a limb's parts."""
        turn, origin = self.stances.frame_of(limb, stance)
        local = (self.points[limb_points(limb)] - origin[:, None]) @ turn  # (N, 2, 3)
        points = self.stances.limbs[limb].points
        squared = (local**2).sum(axis=(1, 2))[:, None] + (points**2).sum(axis=(1, 2))
        squared = squared - 2.0 * np.einsum("nqi,lqi->nl", local, points)
        return np.asarray(self.weight * np.maximum(squared, 0.0), dtype=np.float32)

    def states(self, depths_m: Array) -> FrameStates:
        """The nearest states; there is one distance."""
        return super().states(depths_m[:1])


# --- How plausible a body's parts are by all postures that are known


KERNEL_M = 0.05  # three fifths of what performers differ by; libraries predict each other by 3 to 4 cm
DEGREES = 4.0  # of Student's t, the shape of a kernel: the likeliest for one library by the others, too
DIMENSIONS = 4.0  # of a part: two directions of two segments; lean, turn and bend of a trunk
MARGIN = 6.0  # how much more unusual an unknown motion may be: a part 40 cm from all known


@dataclass(frozen=True, eq=False)
class Plausibility:
    """The density of known postures, part by part."""

    known: KnownPostures

    def costs(self, pose: Pose) -> Array:
        """(N, 5) negative log density of each of `PARTS`, 0 for the median known posture."""
        shapes = part_shapes(self.known.body, pose)
        return np.stack(
            [_cost(shapes[part], self.known.parts[part]) - self.usual[part][0] for part in PARTS], axis=-1
        )

    def contorted(self, pose: Pose) -> BoolArray:
        """(N, 5) whether each part is where no known posture has anything like it."""
        most = np.array([self.usual[part][1] - self.usual[part][0] + MARGIN for part in PARTS])
        skeleton, vector = pose.posture.skeleton, pose.posture.to_vector()
        # A joint this far beyond its range is contorted, whatever is known.
        beyond = np.abs(vector - np.clip(vector, *skeleton.limits.T)) > 0.25
        parts = [
            beyond[:, part_dofs(skeleton, *part.replace(TRUNK, TORSO).split("."))].any(axis=-1)
            for part in PARTS
        ]
        return np.asarray((self.costs(pose) > most) | np.stack(parts, axis=-1))

    @cached_property
    def usual(self) -> Mapping[str, tuple[float, float]]:
        """Median cost of a known posture by the libraries it is not from, and that of the unusual ones."""
        library = self.known.library
        several = len(np.unique(library)) > 1
        other = library[:, None] != library if several else ~np.eye(len(library), dtype=bool)
        found = {}
        for part in PARTS:
            shape = self.known.parts[part]
            cost = _cost(shape, shape, other)
            median, unusual = np.quantile(cost, [0.5, 0.998])  # two in a thousand are called implausible
            found[part] = (float(median), float(unusual))
        return found


def plausibility(body: Body, libraries: Sequence[Library]) -> Plausibility:
    """The density of the postures of libraries, one of which has any, on a body."""
    return Plausibility(known_postures(body, libraries))


def _cost(shape: Array, known: Array, other: BoolArray | None = None) -> Array:
    """(N,) negative logarithm of the mean kernel of shapes (N, K) by known ones (M, K), or `other` ones."""
    # |a - b|² = |a|² + |b|² - 2 a·b: one product instead of all differences.
    squared = (shape**2).sum(-1)[:, None] + (known**2).sum(-1) - 2.0 * shape @ known.T
    kernel = -multivariate_cost(np.maximum(squared, 0.0) / KERNEL_M**2, DEGREES, DIMENSIONS)
    if other is None:
        return np.asarray(np.log(len(known)) - logsumexp(kernel, axis=-1))
    kernel = np.where(other, kernel, -np.inf)
    return np.asarray(np.log(other.sum(-1)) - logsumexp(kernel, axis=-1))
