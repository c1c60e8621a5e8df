"""What whole motions of the libraries tell of a clip, part by part.

A motion that a library knows ties limbs and moments to each other, which parts composed freely lack: which
arm swings with which leg, and when. So the motions of the library nearest to a first composition are led
through the clip by a hidden Markov model over whole postures and headings, and parts near those that are
probable become likelier. A part that the library has wrong is left to the evidence: the belief is bounded.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array, IndexArray, SingleArray
from ..body.human import HUMAN, LIMBS
from ..body.kinematics import Body
from ..body.posture import Posture, headings_rad, yaw_rotation, yawed_at
from ..numerics.markov_chain import path_posteriors
from ..progress import Part
from .known_motions import KnownMotions
from .match_evidence import (
    DEGREES_OF_FREEDOM,
    ENTRIES,
    EXCHANGED_COST,
    FrameLikelihood,
    MatchEvidence,
    extent_cost,
    frame_likelihoods,
    lowest,
    marker_moments,
    products,
    squared_distances,
    student_cost,
)
from .part_features import HEADINGS, TRUNK_POINTS, StanceFeatures, limb_points
from .part_pools import ARM, PartPools
from .posing_input import PosingInput, tempering

MOST_STATES, MARGIN = 500, 15.0  # states kept of a frame, and how much more than the likeliest they may cost
DEPTH_STD = 0.07  # error of the distance that a first composition has, as a share
HIPS_STD_M = 0.05  # difference of the hips' height between performers at the same moment of a motion
TURN_STD, TURN_ROUGH_RAD = 0.5, 0.13  # besides the motion's own [rad/s]; headings are as rough [rad]


@dataclass(frozen=True, eq=False)
class PartBelief:
    """What one frame's parts cost less for being near a library's: 0 far from it, negative near it."""

    stance: SingleArray  # (S,) of the stances
    limbs: dict[str, SingleArray]  # (L,) of each limb's parts, by limb


@dataclass(frozen=True, eq=False)
class _Whole:
    """Whole postures N of a library in all headings H, heading by heading: N H states."""

    motions: KnownMotions
    places: SingleArray  # (3 A, N H) of markers and keypoints from the hips [m]
    second_moment: SingleArray  # (M, 6, N H) see `part_features.ENTRIES`
    height_m: SingleArray  # (N H,)
    velocity: SingleArray  # (N H, 2) in the world [m/s]


@dataclass(frozen=True, eq=False)
class _States:
    """K states that explain a frame."""

    row: IndexArray
    cost: SingleArray
    explained: SingleArray  # (K,) mean weight of what is seen under Student's t, 0 to 1


def part_beliefs(
    given: PosingInput,
    pools: PartPools,
    stances: StanceFeatures,
    posture: Posture,
    hips: Array,
    floor_m: float,
) -> Part[list[PartBelief]]:
    """What the library that fits a clip best tells of some frames.

    Args:
        given: The take.
        pools: The parts of the libraries.
        stances: The stances and limbs of these.
        posture: (N,) a first composition of some frames of the clip.
        hips: (T, 3) its places, smoothed [m].
        floor_m: Height of the floor.
    """
    evidence, sampled, time_s = given.evidence, given.sampled, given.time_s
    likelihoods = [
        frame_likelihoods(given.camera, each, sampled)
        for each in ((evidence, evidence.exchanged()) if len(evidence.points) else (evidence,))
    ]
    velocity = np.gradient(hips[:, :2], time_s, axis=0) if len(hips) > 1 else np.zeros((1, 2))

    def states(whole: _Whole, row: int) -> _States:
        both = [
            _states(
                each[row], whole, hips[row], floor_m, velocity[row], float(EXCHANGED_COST) if swap else 0.0
            )
            for swap, each in enumerate(likelihoods)
        ]
        return both[0] if len(both) == 1 else _merged(*both)

    few = np.unique(np.linspace(0, len(sampled) - 1, 15).astype(int))
    least, best = np.inf, None
    # Libraries whose postures are compared with the footage: those nearest to a first composition.
    for number in nearest_libraries(pools, posture)[:4]:
        whole = _whole(pools.motions.of_library(number), pools.body, evidence)
        cost = float(np.mean([states(whole, row).cost.min() for row in few]))
        if cost < least:
            least, best = cost, whole
        yield 0.0
    assert best is not None
    found = []
    for row in range(len(sampled)):
        found.append(states(best, row))
        if row % 8 == 0:
            yield 0.2 + 0.5 * row / len(sampled)
    weight = np.float32(tempering(time_s))
    own = [weight * each.cost for each in found]
    steps = [
        _step_cost(best.motions, a.row, b.row, float(duration))
        for a, b, duration in zip(found, found[1:], np.diff(time_s), strict=False)
    ]
    posterior = path_posteriors(own, steps)
    explained = float(
        np.mean([chance @ each.explained for chance, each in zip(posterior, found, strict=True)])
    )
    # How many times likelier parts at a library's own places are than others if it explains half the
    # footage, which grows with the square of the explained share's odds.
    odds = 0.4 * (explained / max(1.0 - explained, 0.02)) ** 2
    yield 0.9
    return _beliefs(best.motions, pools.body, stances, found, posterior, odds)


def nearest_libraries(pools: PartPools, posture: Posture) -> list[int]:
    """Numbers of the libraries by how near they have a posture to each of some (N,), in any heading."""
    body, known = pools.body, pools.motions
    facing = yawed_at(posture, -headings_rad(posture), np.zeros_like(posture.translation))
    shapes, points = (body.points(body.pose(each)) for each in (facing, known.posture))
    away = np.array([np.linalg.norm(points - shape, axis=-1).mean(axis=-1) for shape in shapes])
    numbers = np.unique(known.library)
    nearest = [away[:, known.library == number].min(axis=1).mean() for number in numbers]
    return [int(number) for number in numbers[np.argsort(nearest, kind="stable")]]


def _whole(motions: KnownMotions, body: Body, evidence: MatchEvidence) -> _Whole:
    moments = marker_moments(body, evidence, motions.posture)
    turn = yaw_rotation(2.0 * np.pi * np.arange(HEADINGS) / HEADINGS)
    places = np.einsum("hij,naj->ainh", turn, moments.centroid)
    second = np.einsum("hia,nmab,hjb->mijnh", turn, moments.second_moment, turn, optimize=True)
    rows = np.stack([second[:, i, j] for i, j in ENTRIES], axis=1)
    velocity = np.einsum("hij,nj->nhi", turn[:, :2, :2], motions.velocity)
    count = len(motions.names) * HEADINGS
    return _Whole(
        motions,
        places.reshape(-1, count).astype(np.float32),
        rows.reshape(len(rows), 6, count).astype(np.float32),
        np.repeat(motions.height_m, HEADINGS).astype(np.float32),
        velocity.reshape(-1, 2).astype(np.float32),
    )


def _states(
    seen: FrameLikelihood, whole: _Whole, hips: Array, floor_m: float, velocity: Array, cost_of_it: float
) -> _States:
    """The states that explain a frame best, each at its best place."""
    rows = (seen.image_axes * seen.weight[:, None, None]).reshape(-1, 3)
    along = (hips - seen.location) @ seen.backward  # negative
    depth = -seen.backward[None] / (DEPTH_STD * along)
    up = np.array([[0.0, 0.0, 1.0]]) / HIPS_STD_M
    by_hips = np.concatenate([rows, depth, up])
    matrix = np.zeros((len(rows), len(whole.places)))
    for point in range(len(seen.weight)):
        matrix[2 * point : 2 * point + 2, 3 * point : 3 * point + 3] = rows[2 * point : 2 * point + 2]
    count = whole.places.shape[1]
    offset = np.empty((len(by_hips), count), dtype=np.float32)
    offset[:-2] = matrix.astype(np.float32) @ whole.places
    offset[-2] = 1.0 / DEPTH_STD
    offset[-1] = (seen.location[2] - floor_m - whole.height_m) / HIPS_STD_M
    solve = -np.linalg.solve(by_hips.T @ by_hips + 1e-6 * np.eye(3), by_hips.T)
    place = solve.astype(np.float32) @ offset
    residual = offset + by_hips.astype(np.float32) @ place
    residual *= residual
    visible = np.flatnonzero(seen.visible)
    cost = student_cost(residual[-1], 1) + student_cost(residual[-2], 1) + np.float32(cost_of_it)
    # Going besides the motion's own [m/s].
    going = ((whole.velocity - velocity.astype(np.float32)) ** 2).sum(axis=1) / np.float32(0.6**2)
    cost += student_cost(going, 2)
    explained = np.zeros(count, dtype=np.float32)
    share = np.float32(seen.share)
    for point in visible:
        squared = residual[2 * point] + residual[2 * point + 1]
        cost += share * student_cost(squared, 2)
        explained += np.float32(1.0) / (np.float32(1.0) + squared / np.float32(DEGREES_OF_FREEDOM))
    markers = len(seen.unclipped)
    for guess in np.flatnonzero(seen.depth_weight):
        column = 3 * (markers + guess)
        off = seen.sight.astype(np.float32) @ whole.places[column : column + 3] - np.float32(
            seen.depth_m[guess]
        )
        cost += share * student_cost((off * np.float32(seen.depth_weight[guess])) ** 2, 1)
    kept = lowest(cost, 4 * MOST_STATES, MARGIN + 6.0)
    cost = cost[kept]
    for marker in np.flatnonzero(seen.unclipped):
        at = place[:, kept] + whole.places[3 * marker : 3 * marker + 3, kept]
        a, b = seen.image_axes[marker].astype(np.float32)
        moment = whole.second_moment[marker][:, kept]
        entries = [products(*pair) @ moment for pair in ((a, a), (a, b), (b, b))]
        cost += extent_cost(seen, marker, entries, np.asarray(-seen.backward @ at, dtype=np.float32))
    best = lowest(cost, MOST_STATES, MARGIN)
    return _States(kept[best], cost[best], explained[kept[best]] / np.float32(max(len(visible), 1)))


def _merged(plain: _States, other: _States) -> _States:
    """The best of both hypotheses, each state once."""
    row, cost, explained = (
        np.concatenate([getattr(plain, n), getattr(other, n)]) for n in ("row", "cost", "explained")
    )
    order = np.lexsort((cost, row))
    _, first = np.unique(row[order], return_index=True)
    best = order[first]
    best = best[lowest(cost[best], MOST_STATES, MARGIN)]
    return _States(row[best], cost[best], explained[best])


def _step_cost(
    motions: KnownMotions, before: IndexArray, after: IndexArray, duration_s: float
) -> SingleArray:
    """(J, K) costs of steps: on in the motion at about its speed, or to any other posture."""
    first, second = before // HEADINGS, after // HEADINGS
    gone = motions.time_s[second] - motions.time_s[first][:, None]
    late = gone - duration_s
    period = np.where(np.isfinite(motions.period_s), motions.period_s, 1e9)[second]
    late -= period * np.round(late / period)
    step = np.maximum(motions.step_s[second], 1e-3)
    spread = np.hypot(0.45 * duration_s, 0.5 * step)  # difference of the speed from a library's, as a share
    on = 0.5 * (late / spread) ** 2 + np.log(np.maximum(np.sqrt(2.0 * np.pi) * spread / step, 1.0))
    single = motions.step_s[second] == 0.0
    on = np.where(single, 0.0, on)
    on = np.where(motions.motion[second] == motions.motion[first][:, None], on, np.inf)
    # Jumps to another posture per second: one movement lasts a few seconds.
    jump = np.log(len(motions.names)) - np.log(-np.expm1(-0.4 * duration_s))
    turned = 2.0 * np.pi / HEADINGS * (after % HEADINGS - (before % HEADINGS)[:, None])
    turned = turned - duration_s * 0.5 * (motions.turn_rate[second] + motions.turn_rate[first][:, None])
    turned = np.remainder(turned + np.pi, 2.0 * np.pi) - np.pi
    squared = (turned / np.hypot(TURN_STD * duration_s, TURN_ROUGH_RAD)) ** 2
    return np.minimum(on, jump).astype(np.float32) + student_cost(squared.astype(np.float32), 1)


def _beliefs(
    motions: KnownMotions,
    body: Body,
    stances: StanceFeatures,
    states: Sequence[_States],
    posterior: Sequence[SingleArray],
    odds: float,
) -> list[PartBelief]:
    """Beliefs in the parts of probable postures, which are `odds` times likelier than parts far away."""
    pose = body.pose(motions.posture)
    points = body.points(pose)
    waist = HUMAN.joint_index("waist")
    near = {}
    for limb in LIMBS:
        joint = waist if limb.startswith(ARM) else 0
        local = (points[:, limb_points(limb)] - pose.origin[:, None, joint]) @ pose.rotation[:, joint]
        near[limb] = _nearness(local, stances.limbs[limb].points)
    trunk = points[:, TRUNK_POINTS]
    turn = yaw_rotation(stances.heading_rad)
    found = []
    for own, chance in zip(states, posterior, strict=True):
        kept = np.flatnonzero(chance > 1e-3)
        weight = np.asarray(chance[kept], dtype=np.float32)
        row, heading = np.divmod(own.row[kept], HEADINGS)
        limbs = {limb: -np.log1p(np.float32(odds) * (weight @ near[limb][row])) for limb in LIMBS}
        turned = trunk[row] @ np.swapaxes(turn[heading], -1, -2)
        alike = _nearness(turned, stances.features.points[:, TRUNK_POINTS])
        found.append(PartBelief(-np.log1p(np.float32(odds) * (weight @ alike)), limbs))
    return found


def _nearness(first: Array, second: SingleArray) -> SingleArray:
    """(J, K) of points (J, Q, 3) and (K, Q, 3): 1 for the same place, 0 far away."""
    mean = squared_distances(np.asarray(first, dtype=np.float32), second)
    # Distance of a part's points between performers at the same moment of a motion.
    return np.asarray(np.exp(np.float32(-0.5 / 0.10**2) * mean))
