"""What whole motions of the libraries tell of a clip, part by part.

A motion that a library knows ties limbs and moments to each other, which parts composed freely lack: which
arm swings with which leg, and when. So the motions of the library nearest to a first composition are led
through the clip by a hidden Markov model over whole postures and headings, and parts near those that are
probable become likelier. A part that the library has wrong is left to the evidence: the belief is bounded.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array, IndexArray, SingleArray, single
from ..body.human import LIMBS
from ..body.kinematics import Body
from ..body.posture import Posture, headings_rad, yaw_rotation, yawed_at
from ..estimate.single_frame import EXCHANGED_COST
from ..numerics.markov_chain import Steps, path_posteriors
from ..numerics.robust import DEGREES, multivariate_cost
from ..progress import Part
from .clip_input import PosingInput, tempering
from .frame_likelihood import (
    ENTRIES,
    FrameLikelihood,
    frame_likelihoods,
    image_moments,
    lowest,
    squared_distances,
)
from .known_motions import KnownMotions, limb_places
from .match_evidence import MatchEvidence, marker_moments
from .part_features import HEADINGS, TRUNK_POINTS, StanceFeatures
from .part_pools import PartPools

MOST_STATES, MARGIN = 500, 15.0  # states kept of a frame, and how much more than the likeliest they may cost


@dataclass(frozen=True, eq=False)
class PartBelief:
    """What one frame's parts cost less for being near a library's: 0 far from it, negative near it."""

    stance: SingleArray  # (S,) of the stances
    limbs: dict[str, SingleArray]  # (L,) of each limb's parts, by limb


@dataclass(frozen=True, eq=False)
class _Whole:
    """Whole postures N of a library in all headings H, heading by heading: N H states."""

    motions: KnownMotions
    places: SingleArray  # (A, 3, N H) of markers and keypoints from the hips [m]
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
    stances: StanceFeatures,
    posture: Posture,
    hips: Array,
    floor_m: float,
) -> Part[list[PartBelief]]:
    """What the library that fits a clip best tells of some frames.

    Args:
        given: The take.
        stances: The stances and limbs of the libraries.
        posture: (N,) a first composition of some frames of the clip.
        hips: (T, 3) its places, smoothed [m].
        floor_m: Height of the floor.
    """
    evidence, sampled, time_s = given.evidence, given.sampled, given.time_s
    pools = stances.pools
    likelihoods = [
        frame_likelihoods(given.camera, each, sampled)
        for each in ((evidence, evidence.exchanged()) if evidence.keypoints.names else (evidence,))
    ]
    velocity = np.gradient(hips[:, :2], time_s, axis=0) if len(hips) > 1 else np.zeros((1, 2))

    def states(whole: _Whole, row: int) -> _States:
        both = [_states(each[row], whole, hips[row], floor_m, velocity[row]) for each in likelihoods]
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
    motions, duration_s = best.motions, np.diff(time_s)
    steps = Steps(
        len(duration_s),
        lambda at: _step_cost(motions, found[at].row, found[at + 1].row, float(duration_s[at])),
    )
    posterior = path_posteriors([weight * each.cost for each in found], steps)
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
        places.reshape(len(places), 3, count).astype(np.float32),
        rows.reshape(len(rows), 6, count).astype(np.float32),
        np.repeat(motions.height_m, HEADINGS).astype(np.float32),
        velocity.reshape(-1, 2).astype(np.float32),
    )


def _states(seen: FrameLikelihood, whole: _Whole, hips: Array, floor_m: float, velocity: Array) -> _States:
    """The states that explain a frame best, each at its best place."""
    along = (hips - seen.location) @ seen.backward  # negative
    # Error of the distance that a first composition has, as a share; difference of the hips' height between
    # performers at the same moment of a motion [m].
    depth_std, hips_std_m = 0.07, 0.05
    depth, up = -seen.backward / (depth_std * along), np.array([0.0, 0.0, 1.0]) / hips_std_m
    by_hips = np.concatenate([seen.rows.reshape(-1, 3), depth[None], up[None]])
    count = whole.places.shape[-1]
    offset = np.empty((len(by_hips), count), dtype=np.float32)
    offset[:-2] = (seen.rows @ whole.places).reshape(-1, count)
    offset[-2] = 1.0 / depth_std
    offset[-1] = (seen.location[2] - floor_m - whole.height_m) / hips_std_m
    solve = -np.linalg.solve(by_hips.T @ by_hips + 1e-6 * np.eye(3), by_hips.T)
    place = solve.astype(np.float32) @ offset
    squared = (offset + by_hips.astype(np.float32) @ place) ** 2
    cost = multivariate_cost(squared[-1], DEGREES, 1) + multivariate_cost(squared[-2], DEGREES, 1)
    # Going besides the motion's own [m/s].
    going = ((whole.velocity - velocity.astype(np.float32)) ** 2).sum(axis=1) / np.float32(0.6**2)
    cost += multivariate_cost(going, DEGREES, 2)
    explained = np.zeros(count, dtype=np.float32)
    visible = np.flatnonzero(seen.visible)
    for point in visible:
        own = squared[2 * point] + squared[2 * point + 1]
        cost += seen.place_cost(own)
        explained += np.float32(DEGREES) / (np.float32(DEGREES) + own)
        if seen.depth_weight[point]:
            cost += seen.depth_cost(point, seen.sight @ whole.places[point])
    kept = lowest(cost, 4 * MOST_STATES, MARGIN + 6.0)
    cost = cost[kept]
    for marker in np.flatnonzero(seen.whole):
        at = place[:, kept] + whole.places[marker][:, kept]
        moment = whole.second_moment[marker][:, kept]
        entries = [each @ moment for each in image_moments(seen.image_axes[marker])]
        cost += seen.extent_cost(marker, entries, -seen.backward @ at)
    best = lowest(cost, MOST_STATES, MARGIN)
    return _States(kept[best], cost[best], explained[kept[best]] / np.float32(max(len(visible), 1)))


def _merged(plain: _States, exchanged: _States) -> _States:
    """The best of both hypotheses, each state once."""
    row = np.concatenate([plain.row, exchanged.row])
    cost = np.concatenate([plain.cost, exchanged.cost + np.float32(EXCHANGED_COST)])
    explained = np.concatenate([plain.explained, exchanged.explained])
    order = np.lexsort((cost, row))
    _, first = np.unique(row[order], return_index=True)
    best = order[first]
    best = best[lowest(cost[best], MOST_STATES, MARGIN)]
    return _States(row[best], cost[best], explained[best])


def _step_cost(
    motions: KnownMotions, before: IndexArray, after: IndexArray, duration_s: float
) -> SingleArray:
    """(J, K) costs of steps: on in the motion at about its speed, or to any other posture."""
    # States share postures in several headings: what depends on these alone is told once for each.
    first, from_row = np.unique(before // HEADINGS, return_inverse=True)
    second, to_row = np.unique(after // HEADINGS, return_inverse=True)
    step, period = np.maximum(motions.step_s[second], 1e-3), np.minimum(motions.period_s[second], 1e9)
    late = motions.time_s[second] - motions.time_s[first][:, None] - duration_s
    late -= period * np.round(late / period)
    spread = np.hypot(0.45 * duration_s, 0.5 * step)  # difference of the speed from a library's, as a share
    on = 0.5 * (late / spread) ** 2 + np.log(np.maximum(np.sqrt(2.0 * np.pi) * spread / step, 1.0))
    on = np.where(motions.step_s[second] == 0.0, 0.0, on)
    on = np.where(motions.motion[second] == motions.motion[first][:, None], on, np.inf)
    # Jumps to another posture per second: one movement lasts a few seconds.
    jump = np.log(len(motions.names)) - np.log(-np.expm1(-0.4 * duration_s))
    moved = single(np.minimum(on, jump))[from_row[:, None], to_row]
    spin = 0.5 * duration_s * motions.turn_rate
    width = 2.0 * np.pi / HEADINGS
    ahead = width * (after % HEADINGS) - spin[after // HEADINGS]
    behind = width * (before % HEADINGS) + spin[before // HEADINGS]
    turned: SingleArray = single(ahead) - single(behind)[:, None]
    turned -= np.float32(2.0 * np.pi) * np.round(turned / np.float32(2.0 * np.pi))
    # Turning besides the motion's own [rad/s]; headings are as rough [rad].
    turned /= np.float32(np.hypot(0.5 * duration_s, 0.13))
    return moved + multivariate_cost(turned * turned, DEGREES, 1)


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
    near = {limb: _nearness(limb_places(body, pose, limb), stances.limbs[limb].points) for limb in LIMBS}
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
    mean = squared_distances(single(first), second)
    # Distance of a part's points between performers at the same moment of a motion.
    return np.asarray(np.exp(np.float32(-0.5 / 0.10**2) * mean))
