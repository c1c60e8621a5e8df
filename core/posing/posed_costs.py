"""A frame that a person has posed, among frames that are composed: its parts are the nearest ones."""

import numpy as np

from ..arrays import Array, IndexArray, SingleArray
from .composed_states import FrameCosts, FrameStates
from .frame_likelihood import FrameLikelihood
from .part_features import TRUNK_POINTS, StanceFeatures, limb_points

POINT_STD_M = 0.06
"""Distance of a posed point from the nearest part's: what pools are rough by, and a person's error."""


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
        """Hold stances and limbs against a posed frame.

        Args:
            likelihood: The frame.
            stances: All stances.
            hips: (3,) place of the hips [m].
            points: (P, 3) points from there [m].
            tempering: What the frame's costs will be multiplied by; a posed frame says its own once.
        """
        super().__init__(likelihood, stances, None)
        self.hips = np.asarray(hips - likelihood.location, dtype=np.float32)
        self.points = np.asarray(points, dtype=np.float32)
        self.weight = np.float32(0.5 / POINT_STD_M**2 / tempering)

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
