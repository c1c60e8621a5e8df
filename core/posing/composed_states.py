"""What one frame says of stances at several distances, with the best limbs on each.

Given a stance and its place a frame's evidence splits into parts: the cost of a whole body is that of its
torso and the sum of its limbs' own, so that the best of all compositions is found limb by limb. Only the
floor asks both legs: one of them stands on it, or none does.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array, IndexArray, SingleArray
from ..matching.frame_likelihood import FrameLikelihood, square_root
from ..matching.noise_scales import DEGREES_OF_FREEDOM
from .part_features import StanceFeatures
from .part_pools import ARM, LIMBS

MOST_STANCES = 500
"""Stances that limbs are hung on, by how well their torsos fit."""
MOST_NEAR = 120
"""Of these the ones that are tried at all distances."""
MOST_STATES = 240
"""States kept of a frame."""
MARGIN = 14.0
"""States whose cost exceeds the frame's least by more are dropped."""
FLOOR_STD_M = 0.06
"""Height of a sole that stands on the floor: feet are rigid here, shoes are not measured."""
NO_CONTACT_COST = 3.0
"""Cost of a frame in which neither foot is on the floor: jumps, steps, furniture."""
DEPTH_STD_M = 0.02
"""How firmly a state keeps to its distance."""
LEGS = tuple(limb for limb in LIMBS if not limb.startswith(ARM))


@dataclass(frozen=True, eq=False)
class FrameStates:
    """K states of a frame: a stance at a place, with the best limb of each kind."""

    stance: IndexArray
    """(K,)."""
    hips: SingleArray
    """(K, 3) places of the hips in the world [m]."""
    cost: SingleArray
    """(K,) negative log likelihood, up to a constant of the frame."""
    limbs: IndexArray
    """(K, 4) the best of each limb, in the order of `LIMBS`."""

    def chosen(self, rows: IndexArray) -> "FrameStates":
        """Some of the states."""
        return FrameStates(self.stance[rows], self.hips[rows], self.cost[rows], self.limbs[rows])


class FrameCosts:
    """Costs of stances and limbs in one frame."""

    def __init__(
        self,
        likelihood: FrameLikelihood,
        stances: StanceFeatures,
        floor_m: float | None,
        moments: bool = True,
    ) -> None:
        self.likelihood, self.stances, self.floor_m = likelihood, stances, floor_m
        self.axes = np.asarray(likelihood.image_axes, dtype=np.float32)  # (A, 2, 3)
        self.rows = self.axes * np.asarray(likelihood.weight, dtype=np.float32)[:, None, None]
        self.location = np.asarray(likelihood.location, dtype=np.float32)
        self.backward = np.asarray(likelihood.backward, dtype=np.float32)
        self.sight = np.asarray(likelihood.sight, dtype=np.float32)
        self.share = np.float32(likelihood.share)
        self.markers = len(likelihood.unclipped)
        self.moments = moments

    def states(self, depths_m: Array) -> FrameStates:
        """The states that explain the frame best, at some distances along the camera's axis, the middle first."""
        every = np.arange(len(self.stances.pelvis))
        middle = np.float32(depths_m[0])
        places = self.places(every, np.full(len(every), middle))
        cost = self.torso_cost(every, places)
        kept = lowest(cost, MOST_STANCES, 2.0 * MARGIN)
        whole, _ = self.whole_cost(every[kept], places[kept], cost[kept])
        kept = kept[lowest(whole, MOST_NEAR, 1.5 * MARGIN)]
        stance = np.tile(every[kept], len(depths_m))
        depth = np.repeat(np.asarray(depths_m, dtype=np.float32), len(kept))
        places = self.places(stance, depth)
        cost, limbs = self.whole_cost(stance, places, self.torso_cost(stance, places))
        kept = lowest(cost, 2 * MOST_STATES, MARGIN)
        stance, depth, limbs = stance[kept], depth[kept], limbs[kept]
        places = self.places(stance, depth, limbs)
        cost, limbs = self.whole_cost(stance, places, self.torso_cost(stance, places))
        kept = lowest(cost, MOST_STATES, MARGIN)
        return FrameStates(stance[kept], places[kept] + self.location, cost[kept], limbs[kept])

    def places(
        self, stance: IndexArray, depth_m: SingleArray, limbs: IndexArray | None = None
    ) -> SingleArray:
        """(N, 3) places of the hips from the camera [m], by least squares at given distances.

        Without limbs each counts as the middle of all of its kind, and little.
        """
        matrix = np.outer(self.backward, self.backward) / DEPTH_STD_M**2 + np.eye(3) * 1e-4
        torso = self.stances.features
        right = -np.outer(depth_m, self.backward) / DEPTH_STD_M**2
        for column, observed in enumerate(torso.observed):
            own = self.rows[observed].T @ self.rows[observed]
            matrix = matrix + own
            right -= torso.place[stance, column] @ own
        for row, limb in enumerate(LIMBS):
            features = self.stances.limbs[limb]
            if not len(features.observed):
                continue
            turn, origin = self.stances.frame_of(limb, stance)
            for column, observed in enumerate(features.observed):
                weight = float(self.likelihood.weight[observed])
                if weight == 0.0:
                    continue
                own = self.rows[observed].T @ self.rows[observed]
                if limbs is None:
                    local = np.broadcast_to(features.place[:, column].mean(axis=0), (len(stance), 3))
                    spread = float(features.place[:, column].var(axis=0).mean())
                    own = own / (1.0 + spread * weight**2)
                else:
                    local = features.place[limbs[:, row], column]
                matrix = matrix + own
                right -= (origin + (turn @ local[..., None])[..., 0]) @ own
        return np.asarray(np.linalg.solve(matrix, right.T).T, dtype=np.float32)

    def torso_cost(self, stance: IndexArray, places: SingleArray) -> SingleArray:
        """(N,) cost of stances at places from the camera, without limbs."""
        features = self.stances.features
        local = features.place[stance]
        cost = np.array(features.cost[stance])
        for column, observed in enumerate(features.observed):
            at = local[:, column] + places
            cost += self._point_cost(observed, at @ self.rows[observed].T)
            depth = self._hint_cost(observed, local[:, column] @ self.sight)
            if depth is not None:
                cost += depth
            if observed < self.markers and self.moments and self.likelihood.unclipped[observed]:
                moment = features.second_moment[stance, column]
                entries = [moment @ _products(*pair) for pair in self._pairs(observed)]
                cost += self._extent_cost(observed, entries, -at @ self.backward)
        nearness = -places @ self.backward
        cost[nearness < 0.3] += np.float32(1e3)
        return cost

    def limb_table(self, limb: str, stance: IndexArray, places: SingleArray) -> SingleArray:
        """(N, L) cost of each of a limb's parts on stances at places from the camera; the floor is not in it."""
        features = self.stances.limbs[limb]
        turn, origin = self.stances.frame_of(limb, stance)
        cost = np.broadcast_to(features.cost, (len(stance), len(features.cost))).copy()
        for column, observed in enumerate(features.observed):
            if self.likelihood.weight[observed] == 0.0:
                continue
            local = features.place[:, column].T  # (3, L)
            squared = np.zeros_like(cost)
            for row in self.rows[observed]:
                residual = (row @ turn) @ local
                residual += ((origin + places) @ row)[:, None]
                residual *= residual
                squared += residual
            cost += self.share * student_cost(squared, 2)
            guessed = self._hint_cost(observed, (self.sight @ turn) @ local + (origin @ self.sight)[:, None])
            if guessed is not None:
                cost += guessed
            if observed < self.markers and self.moments and self.likelihood.unclipped[observed]:
                moment = features.second_moment[:, column].T  # (6, L)
                first, second = (axis @ turn for axis in self.axes[observed])
                entries = [
                    _products(*pair) @ moment for pair in ((first, first), (first, second), (second, second))
                ]
                away = -((origin + places) @ self.backward)[:, None] - (self.backward @ turn) @ local
                cost += self._extent_cost(observed, entries, away)
        return cost

    def sole_heights(self, limb: str, stance: IndexArray, places: SingleArray) -> SingleArray:
        """(N, L) height of the sole of each of a leg's parts over the floor [m]."""
        turn, origin = self.stances.frame_of(limb, stance)
        soles = self.stances.limbs[limb].soles
        up = turn[:, 2]  # (N, 3)
        lowest_point = np.minimum(up @ soles[:, 0].T, up @ soles[:, 1].T)
        base = origin[:, 2] + places[:, 2] + self.location[2] - np.float32(self.floor_m or 0.0)
        return np.asarray(lowest_point + base[:, None])

    def whole_cost(
        self, stance: IndexArray, places: SingleArray, torso: SingleArray
    ) -> tuple[SingleArray, IndexArray]:
        """(N,) cost with the best limbs, and (N, 4) which these are."""
        cost, limbs = np.array(torso), np.zeros((len(stance), len(LIMBS)), dtype=np.intp)
        legs = []
        for column, limb in enumerate(LIMBS):
            table = self.limb_table(limb, stance, places)
            if limb in LEGS and self.floor_m is not None:
                height = self.sole_heights(limb, stance, places)
                table += below_cost(height)
                legs.append((column, table, table + standing_cost(height)))
                continue
            limbs[:, column] = table.argmin(axis=1)
            cost += soft_least(table)
        if legs:
            added, (left, right) = best_legs(legs[0][1:], legs[1][1:])
            cost += added
            limbs[:, legs[0][0]], limbs[:, legs[1][0]] = left, right
        return cost, limbs

    def _point_cost(self, observed: int, residual: SingleArray) -> SingleArray:
        return np.asarray(self.share * student_cost((residual**2).sum(axis=-1), 2))

    def _hint_cost(self, observed: int, depth: SingleArray) -> SingleArray | None:
        """Cost of depths behind the hips where one was guessed; None where it was not."""
        guess = observed - self.markers
        if guess < 0 or not len(self.likelihood.depth_weight) or self.likelihood.depth_weight[guess] == 0.0:
            return None
        off = (depth - np.float32(self.likelihood.depth_m[guess])) * np.float32(
            self.likelihood.depth_weight[guess]
        )
        return np.asarray(self.share * student_cost(off * off, 1))

    def _pairs(self, observed: int) -> list[tuple[SingleArray, SingleArray]]:
        a, b = self.axes[observed]
        return [(a, a), (a, b), (b, b)]

    def _extent_cost(self, marker: int, entries: list[SingleArray], depth: SingleArray) -> SingleArray:
        predicted = square_root(*entries)
        seen = self.likelihood.extent[marker].astype(np.float32)
        depth = np.maximum(depth, np.float32(0.1))
        variance = (
            np.float32(self.likelihood.extent_std_m[marker] ** 2)
            + (np.float32(self.likelihood.pixel_size) * depth) ** 2
        )
        squared = sum(
            (predicted[k] - seen[k] * depth) ** 2 * np.float32(2.0 if k == 1 else 1.0) for k in range(3)
        )
        return student_cost(np.asarray(squared / variance), 3)


def best_legs(
    left: tuple[SingleArray, SingleArray], right: tuple[SingleArray, SingleArray]
) -> tuple[SingleArray, tuple[IndexArray, IndexArray]]:
    """The best two legs of each stance: the left one stands, or the right one, or neither.

    Args:
        left: (N, L) costs of the left leg's parts, free and standing on the floor.
        right: Of the right one.

    Returns:
        (N,) cost, and (N,) which parts.
    """
    index = [[table.argmin(axis=1) for table in leg] for leg in (left, right)]
    least = [[soft_least(table) for table in leg] for leg in (left, right)]
    options = np.stack(
        [least[0][1] + least[1][0], least[0][0] + least[1][1], least[0][0] + least[1][0] + NO_CONTACT_COST]
    )
    which = options.argmin(axis=0)
    chosen = np.where(which == 0, index[0][1], index[0][0]), np.where(which == 1, index[1][1], index[1][0])
    return soft_least(options.T), chosen


def soft_least(cost: SingleArray) -> SingleArray:
    """(N,) cost of any one of several (N, L): how many explain a frame counts, as well as how well one does.

    A limb that points at the camera explains whatever a nearer body shows; few limbs do so.
    """
    least = cost.min(axis=1)
    return np.asarray(least - np.log(np.exp(least[:, None] - cost).sum(axis=1)))


def below_cost(height: SingleArray) -> SingleArray:
    """Cost of soles below the floor."""
    sunk = np.minimum(height, 0.0) / np.float32(FLOOR_STD_M)
    return student_cost(sunk * sunk, 1)


def standing_cost(height: SingleArray) -> SingleArray:
    """Cost of soles above the floor that should stand on it."""
    raised = np.maximum(height, 0.0) / np.float32(FLOOR_STD_M)
    return student_cost(raised * raised, 1)


def student_cost(squared: SingleArray, dimensions: int) -> SingleArray:
    """Negative log likelihood under Student's t, up to a constant."""
    factor = np.float32(0.5 * (DEGREES_OF_FREEDOM + dimensions))
    return np.asarray(factor * np.log1p(squared / np.float32(DEGREES_OF_FREEDOM)))


def lowest(cost: SingleArray, count: int, margin: float) -> IndexArray:
    """Indices of the lowest costs within a margin of the least, at most `count`, in order of index."""
    kept = np.flatnonzero(cost <= cost.min() + np.float32(margin))
    if len(kept) > count:
        kept = np.sort(kept[np.argpartition(cost[kept], count)[:count]])
    return kept


def _products(first: SingleArray, second: SingleArray) -> SingleArray:
    """(..., 6) coefficients of a symmetric matrix's entries in uᵀ S v."""
    u, v = np.moveaxis(first, -1, 0), np.moveaxis(second, -1, 0)
    mixed = [u[i] * v[j] + u[j] * v[i] for i, j in ((0, 1), (0, 2), (1, 2))]
    return np.stack([u[0] * v[0], u[1] * v[1], u[2] * v[2], *mixed], axis=-1)
