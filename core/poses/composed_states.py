"""What one frame says of stances at several distances, with the best limbs on each.

Given a stance and its place a frame's evidence splits into parts: the cost of a whole body is that of its
torso and the sum of its limbs' own, so that the best of all compositions is found limb by limb. Only the
floor asks both legs: one of them stands on it, or none does.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import reduce

import numpy as np

from ..arrays import Array, BoolArray, IndexArray, SingleArray, single
from ..body.human import HUMAN, LIMBS, mass_weights
from ..numerics.robust import DEGREES, multivariate_cost
from ..terms.contact import STEP_M
from ..terms.keypoints import EXCHANGED_COST
from .frame_likelihood import FrameLikelihood, image_moments, lowest, spread, squared_distances
from .part_features import HEADINGS, TRUNK_POINTS, StanceFeatures, limb_points
from .part_pools import ARM

MOST_STATES = 240  # states kept of a frame
MARGIN = 14.0  # states whose cost exceeds the frame's least by more are dropped
LEGS = tuple(limb for limb in LIMBS if not limb.startswith(ARM))
NO_CONTACT_COST = 4.0  # where neither foot stands: jumps, steps, furniture


@dataclass(frozen=True, eq=False)
class FrameStates:
    """K states of a frame: a stance at a place, with the best limb of each kind."""

    stance: IndexArray  # (K,)
    hips: SingleArray  # (K, 3) places of the hips in the world [m]
    cost: SingleArray  # (K,) negative log likelihood, up to a constant of the frame
    limbs: IndexArray  # (K, 4) the best of each limb, in the order of `LIMBS`
    exchanged: BoolArray  # (K,) whether left and right of the keypoints are exchanged for it

    def chosen(self, rows: IndexArray) -> "FrameStates":
        """Some of the states."""
        return FrameStates(
            self.stance[rows], self.hips[rows], self.cost[rows], self.limbs[rows], self.exchanged[rows]
        )

    def with_exchanged(self, other: "FrameStates") -> "FrameStates":
        """The best of these and of those with left and right of the keypoints exchanged."""
        count = len(self.cost)
        both = FrameStates(
            np.concatenate([self.stance, other.stance]),
            np.concatenate([self.hips, other.hips]),
            np.concatenate([self.cost, other.cost + np.float32(EXCHANGED_COST)]),
            np.concatenate([self.limbs, other.limbs]),
            np.arange(count + len(other.cost)) >= count,
        )
        return both.chosen(lowest(both.cost, MOST_STATES, MARGIN))


@dataclass(frozen=True, eq=False)
class LegChoices:
    """C parts of one leg for each of N stances."""

    index: IndexArray  # (N, C) which parts
    cost: SingleArray  # (N, C) of what is seen of them, and of feet below the floor
    height: SingleArray  # (N, C) of the foot above the floor [m]
    foot: SingleArray  # (N, C, 2) where the foot is, from the hips [m]
    mass: SingleArray  # (N, C, 2) what the leg adds to the center of mass, from the hips [m]


class FrameCosts:
    """Costs of stances and limbs in one frame."""

    def __init__(
        self,
        likelihood: FrameLikelihood,
        stances: StanceFeatures,
        floor_m: float | None,
    ) -> None:
        self.likelihood, self.stances, self.floor_m = likelihood, stances, floor_m
        self.seen = likelihood.weight > 0.0

    def states(self, depths_m: Array) -> FrameStates:
        """The states that explain the frame best, at some distances from the camera, the middle one first."""
        every = np.arange(len(self.stances.pelvis))
        middle = np.float32(depths_m[0])
        places = self.places(every, np.full(len(every), middle))
        cost = self.torso_cost(every, places)
        kept = lowest(cost, 500, 2.0 * MARGIN)  # stances that limbs are hung on, by how well their torsos fit
        whole, _ = self.whole_cost(every[kept], places[kept], cost[kept])
        kept = kept[lowest(whole, 90, 1.5 * MARGIN)]  # of these the ones that are tried at all distances
        stance = np.tile(every[kept], len(depths_m))
        depth = np.repeat(np.asarray(depths_m, dtype=np.float32), len(kept))
        places = self.places(stance, depth)
        cost, limbs = self.whole_cost(stance, places, self.torso_cost(stance, places))
        kept = lowest(cost, 2 * MOST_STATES, MARGIN)
        stance, depth, limbs = stance[kept], depth[kept], limbs[kept]
        places = self.places(stance, depth, limbs)
        cost, limbs = self.whole_cost(stance, places, self.torso_cost(stance, places), paired=True)
        kept = lowest(cost, MOST_STATES, MARGIN)
        plain = np.zeros(len(kept), dtype=bool)
        return FrameStates(
            stance[kept], places[kept] + self.likelihood.location, cost[kept], limbs[kept], plain
        )

    def places(
        self, stance: IndexArray, depth_m: SingleArray, limbs: IndexArray | None = None
    ) -> SingleArray:
        """(N, 3) places of the hips from the camera [m], by least squares at given distances.

        Without limbs each counts as the middle of all of its kind, and little.
        """
        backward, torso = self.likelihood.backward, self.stances.features
        firm = 0.02**-2.0  # how firmly a state keeps to its distance [1/m²]
        matrix = firm * np.outer(backward, backward) + np.eye(3) * 1e-4
        right = -firm * np.outer(depth_m, backward)

        for column, point in torso.columns(self.seen):
            own = self.likelihood.rows[point].T @ self.likelihood.rows[point]
            matrix = matrix + own
            right -= torso.place[stance, column] @ own
        for row, limb in enumerate(LIMBS):
            features = self.stances.limbs[limb]
            turn, origin = self.stances.frame_of(limb, stance)
            for column, point in features.columns(self.seen):
                own = self.likelihood.rows[point].T @ self.likelihood.rows[point]
                if limbs is None:
                    local = features.middle[column]
                    own = own / (1.0 + features.variance[column] * float(self.likelihood.weight[point]) ** 2)
                else:
                    local = features.place[limbs[:, row], column, :, None]
                matrix = matrix + own
                right -= (origin + (turn @ local).reshape(-1, 3)) @ own
        return single(np.linalg.solve(matrix, right.T).T)

    def torso_cost(self, stance: IndexArray, places: SingleArray) -> SingleArray:
        """(N,) cost of stances at places from the camera, without limbs."""
        seen, features = self.likelihood, self.stances.features
        cost = np.array(features.cost[stance])
        for column, point in features.columns(self.seen):
            local = features.place[stance, column]
            at = local + places
            off = at @ seen.rows[point].T
            cost += seen.share * multivariate_cost((off * off).sum(axis=-1), DEGREES, 2)
            if seen.depth_weight[point]:
                deep = (local @ seen.sight - seen.depth_m[point]) * seen.depth_weight[point]
                cost += seen.share * multivariate_cost(deep * deep, DEGREES, 1)
            if seen.whole[point]:
                moment = features.second_moment[stance, column]
                entries = [moment @ each for each in image_moments(seen.image_axes[point])]
                cost += seen.extent_cost(point, entries, -at @ seen.backward)
        cost[-places @ seen.backward < 0.3] += np.float32(1e3)
        return cost

    def limb_table(self, limb: str, stance: IndexArray, places: SingleArray) -> SingleArray:
        """(N, L) cost of each of a limb's parts on stances at places from the camera, without the floor."""
        seen, features = self.likelihood, self.stances.limbs[limb]
        turn, origin = self.stances.frame_of(limb, stance)
        away = origin + places
        cost = self.stances.limb_cost[limb][stance // HEADINGS]
        columns = features.columns(self.seen)
        for column, point in columns:
            if seen.whole[point]:
                local = features.place[:, column].T  # (3, L)
                moment = features.second_moment[:, column].T  # (6, L)
                entries = [each @ moment for each in image_moments(seen.image_axes[point] @ turn)]
                behind = -(away @ seen.backward)[:, None] - (seen.backward @ turn) @ local
                cost += seen.extent_cost(point, entries, behind)
        turns = np.ascontiguousarray(np.moveaxis(turn, 0, -1)).reshape(3, -1)
        deep = [each for each in columns if seen.depth_weight[each[1]]]
        shown, guessed = ([point for _, point in own] for own in (columns, deep))
        weight = seen.depth_weight[guessed][:, None, None]
        off = weight * (origin @ seen.sight - seen.depth_m[guessed][:, None, None])
        for own, rows, at_root in (
            (columns, seen.rows[shown], seen.rows[shown] @ away.T),
            (deep, weight * seen.sight, off),
        ):
            if own:
                slopes = (rows.reshape(-1, 3) @ turns).reshape(*rows.shape, -1)
                terms = zip(spread(slopes, at_root), own, strict=True)
                each = [term.T @ features.products[column] for term, (column, _) in terms]
                # One logarithm of their product: logarithms of each would take longer.
                cost += np.float32(0.5 * seen.share * (DEGREES + rows.shape[1])) * np.log(
                    reduce(np.multiply, each)
                )
        return cost

    def foot_heights(self, limb: str, stance: IndexArray, places: SingleArray) -> SingleArray:
        """(N, L) height of each of a leg's feet over the floor [m], by its ankle, 0 where it lies flat."""
        turn, origin = self.stances.frame_of(limb, stance)
        ankle = self.stances.limbs[limb].points[:, 1]
        base = origin[:, 2] + places[:, 2] + self.likelihood.location[2] - np.float32(self.floor_m or 0.0)
        above = turn[:, 2] @ ankle.T + base[:, None]
        return np.asarray(above - np.float32(self.stances.ankle_height_m))

    def whole_cost(
        self, stance: IndexArray, places: SingleArray, torso: SingleArray, paired: bool = False
    ) -> tuple[SingleArray, IndexArray]:
        """(N,) cost with the best limbs, and (N, 4) which these are; legs balance the body where paired."""
        cost, limbs = np.array(torso), np.zeros((len(stance), len(LIMBS)), dtype=np.intp)
        tables = {}
        for column, limb in enumerate(LIMBS):
            tables[limb] = self.limb_table(limb, stance, places)
            limbs[:, column] = tables[limb].argmin(axis=1)
            # How many explain a frame counts, as well as how well one does: a limb that points at the camera
            # explains whatever a nearer body shows, but few limbs do so.
            least = tables[limb].min(axis=1)
            # Exponents of numbers that single precision can hardly hold take three times as long.
            chance = np.exp(np.maximum(least[:, None] - tables[limb], np.float32(-60.0)))
            cost += least - np.log(chance.sum(axis=1))
        if paired and self.floor_m is not None:
            rows = np.arange(len(stance))
            left, right, pairs = self.leg_pairs(stance, places, tables, limbs)
            first, second = (np.exp(leg.cost.min(axis=1, keepdims=True) - leg.cost) for leg in (left, right))
            chance = (np.exp(-pairs) @ second[..., None])[..., 0]
            cost -= np.log((first * chance).sum(axis=1) / (first.sum(axis=1) * second.sum(axis=1)))
            pairs += left.cost[:, :, None] + right.cost[:, None]
            best = np.unravel_index(pairs.reshape(len(stance), -1).argmin(axis=1), pairs.shape[1:])
            for limb, choices, which in zip(LEGS, (left, right), best, strict=True):
                limbs[:, LIMBS.index(limb)] = choices.index[rows, which]
        return cost, limbs

    def leg_pairs(
        self, stance: IndexArray, places: SingleArray, tables: Mapping[str, SingleArray], limbs: IndexArray
    ) -> tuple[LegChoices, LegChoices, SingleArray]:
        """The likeliest legs of N stances at places (N, 3), with (N, C, C) costs of their pairs.

        `tables` has costs (N, L) of each limb's parts, `limbs` (N, 4) the best ones: arms count for balance.
        """
        weights = mass_weights(HUMAN).astype(np.float32)
        trunk = self.stances.features.points[stance][:, TRUNK_POINTS, :2]
        mass = (trunk * weights[TRUNK_POINTS, None]).sum(axis=1)
        choices = {}
        for column, limb in enumerate(LIMBS):
            turn, origin = self.stances.frame_of(limb, stance)
            level = np.swapaxes(turn[:, :2], -1, -2)
            features, own = self.stances.limbs[limb], weights[limb_points(limb)]
            shares = (features.points * own[:, None]).sum(axis=1)  # (L, 3) of the center of mass
            if limb not in LEGS:
                mass += (shares[limbs[:, column], None] @ level)[:, 0] + own.sum() * origin[:, :2]
                continue
            height = self.foot_heights(limb, stance, places)
            table = tables[limb] if self.floor_m is None else tables[limb] + below_cost(height)
            index = likeliest(table, height)
            choices[limb] = LegChoices(
                index,
                np.take_along_axis(table, index, axis=1),
                np.take_along_axis(height, index, axis=1),
                features.soles.mean(axis=1)[index] @ level,
                shares[index] @ level,
            )
        left, right = (choices[limb] for limb in LEGS)
        if self.floor_m is None:
            return left, right, np.zeros((*left.index.shape, right.index.shape[1]), dtype=np.float32)
        return left, right, pair_costs(left, right, mass)


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
        self.hips = single(hips - likelihood.location)
        self.points = single(points)
        # Distance of a posed point from the nearest part's: what pools are rough by, and a person's error.
        self.posed_weight = np.float32(0.5 / 0.06**2 / tempering)

    def places(
        self, stance: IndexArray, depth_m: SingleArray, limbs: IndexArray | None = None
    ) -> SingleArray:
        """(N, 3) the posed place of the hips from the camera [m]."""
        return np.broadcast_to(self.hips, (len(stance), 3)).copy()

    def torso_cost(self, stance: IndexArray, places: SingleArray) -> SingleArray:
        """(N,) cost of stances by shoulders, hips and head."""
        off = self.stances.features.points[stance][:, TRUNK_POINTS] - self.points[TRUNK_POINTS]
        return np.asarray(self.posed_weight * (off * off).sum(axis=(1, 2)))

    def limb_table(self, limb: str, stance: IndexArray, places: SingleArray) -> SingleArray:
        """(N, L) cost of each of a limb's parts."""
        turn, origin = self.stances.frame_of(limb, stance)
        local = (self.points[limb_points(limb)] - origin[:, None]) @ turn  # (N, 2, 3)
        return 2.0 * self.posed_weight * squared_distances(local, self.stances.limbs[limb].points)

    def states(self, depths_m: Array) -> FrameStates:
        """The nearest states; there is one distance."""
        return super().states(depths_m[:1])


# --- Two legs on a stance: which stands on the floor, and whether the body is balanced over that


def likeliest(table: SingleArray, height: SingleArray) -> IndexArray:
    """(N, C) the parts of a leg to pair, by costs and heights (N, L)."""
    # Parts of each leg that are paired: so many of the likeliest, and of the likeliest that stand.
    count = min(12, table.shape[1])
    free = np.argpartition(table, count - 1, axis=1)[:, :count]
    standing = np.argpartition(table + standing_cost(height), count - 1, axis=1)[:, :count]
    return np.asarray(np.concatenate([free, standing], axis=1))


def pair_costs(left: LegChoices, right: LegChoices, mass: SingleArray) -> SingleArray:
    """(N, C, C) cost of each pair beyond the legs' own: that neither stands, or that the body falls.

    `mass` (N, 2) is the center of mass without the legs' shares, times the rest's share, from the hips [m].
    """
    # The center of mass over the left foot, without the right leg's share, and what squares and products with
    # that share and the right foot need: each a product of matrices, where arrays of pairs would be added up.
    foot, over = left.foot, mass[:, None] + left.mass - left.foot

    def sums(*parts: tuple[SingleArray, SingleArray]) -> SingleArray:
        """(N, C, C) sums of products of what belongs to left legs (N, C, K) and to right ones."""
        ones, others = (np.concatenate(own, axis=-1) for own in zip(*parts, strict=True))
        return np.asarray(ones @ np.swapaxes(others, -1, -2))

    def dot(first: SingleArray, second: SingleArray) -> SingleArray:
        return np.asarray((first * second).sum(axis=-1, keepdims=True))

    one, other = np.ones_like(foot[..., :1]), np.ones_like(right.foot[..., :1])
    along = sums(
        (over, right.foot), (-dot(over, foot), other), (-foot, right.mass), (one, dot(right.mass, right.foot))
    )
    way = sums((dot(foot, foot), other), (-2.0 * foot, right.foot), (one, dot(right.foot, right.foot)))
    away = sums((dot(over, over), other), (2.0 * over, right.mass), (one, dot(right.mass, right.mass)))
    higher = right.height[:, None] - left.height[:, :, None]
    share = np.clip(along / np.maximum(way, np.float32(1e-4)), 0.0, 1.0)
    share = np.where(np.abs(higher) > STEP_M, (higher < 0.0).astype(np.float32), share)
    # Horizontal distance of the center of mass from the feet that stand: a foot's length, a step under way.
    squared = np.maximum(away + share * (share * way - 2.0 * along), 0.0) / np.float32(0.12**2)
    # Of Student's t: who runs, leaps or leans on something is forgiven.
    falling = multivariate_cost(squared, 3.0, 2)
    stands = np.minimum(standing_cost(left.height)[:, :, None], standing_cost(right.height)[:, None])
    return np.asarray(np.minimum(stands + falling, np.float32(NO_CONTACT_COST)))


def below_cost(height: SingleArray) -> SingleArray:
    """Cost of feet below the floor."""
    # Height of an ankle over a foot that stands: shoes are not measured, nor the floor's last centimeters.
    off = np.minimum(height, 0.0) / np.float32(0.05)
    return multivariate_cost(off * off, DEGREES, 1)


def standing_cost(height: SingleArray) -> SingleArray:
    """Cost of feet above the floor that should stand on it."""
    # A heel that is off the floor by this much is nothing unusual.
    return below_cost(np.float32(0.05) - height)
