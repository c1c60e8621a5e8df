"""Postures of a clip put together from parts: what frames say, the path through them, the place."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Array, IndexArray
from ..body.kinematics import Body
from ..body.posture import Posture
from ..estimate.performer_placement import place_standing
from ..footage.camera import Camera
from ..matching.coarse_pass import FLOOR_COST_MARGIN, WORLD_FLOOR_M
from ..matching.frame_likelihood import frame_likelihoods
from ..matching.library_match import CORRELATION_S
from ..matching.match_evidence import MatchEvidence
from ..matching.match_input import MatchInput
from ..matching.noise_scales import NoiseScales
from ..progress import Part, scaled
from .composed_path import ComposedPath, best_path
from .composed_states import LEGS, FrameCosts, FrameStates
from ..library.library import Library
from .library_belief import part_beliefs
from .mean_posture import mean_postures
from .part_features import HEADINGS, StanceFeatures
from .part_pools import LIMBS, PartPools
from .posed_costs import PosedCosts

PART_SCALE = 0.4
"""Deviation of a composed body from the performer, relative to that of another performer's posture."""
WIDE = (1.0, 0.92, 1.09, 0.84, 1.19, 0.77, 1.3)
"""Distances tried at first, as shares of a rough one: sizes in the picture are good to a tenth."""
NARROW = (1.0, 0.96, 1.04, 0.92, 1.08)
"""Distances tried about the first path."""
SMOOTH_S = 0.6
"""Time over which the rough distance is smoothed."""
FLOOR_STD_M = 0.06
"""Height of a standing foot where a likelihood has a floor of its own."""
MOST_PLACED = 16
"""Frames in which the performer is placed by size."""


@dataclass(frozen=True, eq=False)
class Composition:
    """Postures of T frames, put together from parts."""

    path: ComposedPath
    states: list[FrameStates]
    posture: Posture
    """(T,)."""
    floor_m: float
    """Height of the floor."""


def compose_frames(
    given: MatchInput,
    pools: PartPools,
    stances: StanceFeatures,
    sampled: IndexArray,
    floor_m: float | None,
    libraries: Sequence[Library] = (),
) -> Part[Composition]:
    """Compose the postures of some frames.

    Args:
        given: The take.
        pools: All parts.
        stances: Their stances.
        sampled: (T,) which frames.
        floor_m: Height of the floor; None where it is not known.
    """
    evidence, camera = given.evidence, given.camera
    time_s = evidence.tracks.time_s[sampled]
    own_weight = tempering(time_s)
    rounds: tuple[tuple[float, ...], ...] = (WIDE, NARROW)
    if _posed_at_both_ends(given, sampled):  # the place is known, then, and what lies between is soon found
        known = given.constraints
        depths = [camera.depth(hips, int(f)) for f, hips in zip(known.frames, known.hips, strict=True)]
        rough = np.interp(sampled, known.frames, depths)
        rounds = (NARROW,)
    else:
        rough = rough_depths(given.body, camera, evidence, sampled, time_s)
    if floor_m is None:
        floor_m = floor_height_m(given, stances, sampled, rough)
    yield 0.1
    costs = frame_costs(given, stances, sampled, floor_m)
    swapped: list[FrameCosts] = []
    if len(evidence.points):
        mirrored = replace(given, evidence=evidence.exchanged())
        swapped = frame_costs(mirrored, stances, sampled, floor_m)
    posed = given.constraints
    for index, frame in enumerate(posed.frames):
        row = int(np.searchsorted(sampled, frame))
        if row < len(sampled) and sampled[row] == frame:
            hips, points = posed.hips[index], posed.points[index]
            costs[row] = PosedCosts(costs[row].likelihood, stances, hips, points, own_weight)
            if swapped:
                swapped[row] = costs[row]
    path: ComposedPath | None = None
    states: list[FrameStates] = []
    for turn, shares in enumerate(rounds):
        begun, ended = (0.1 + 0.9 * (turn + end) / len(rounds) for end in (0, 1))
        is_last = turn == len(rounds) - 1
        # The first round is for the place alone; exchanged sides are tried where it is known.
        rows = np.arange(len(sampled)) if is_last else _every_second(len(sampled))
        own = [costs[row] for row in rows]
        others = swapped if is_last else []
        states = yield from scaled(
            _states(own, others, rough[rows], shares), begun, 0.8 * ended + 0.2 * begun
        )
        step_m = float(np.median(rough)) * abs(shares[1] - shares[0])
        weight = tempering(time_s[rows])
        found = best_path(stances, states, own, others, time_s[rows], weight, step_m)
        path = yield from scaled(found, 0.8 * ended + 0.2 * begun, ended)
        at = zip(path.hips, sampled[rows], strict=True)
        depth = np.array([camera.depth(place, int(frame)) for place, frame in at])
        rough = _smoothed(np.interp(time_s, time_s[rows], depth), time_s)
        if not is_last and libraries:
            first = mean_postures(pools, stances, states, path.stance, path.hips, path.limbs, path.posterior, path.limb_posterior)
            beliefs = yield from scaled(part_beliefs(given, libraries, stances, sampled, first, floor_m), ended, ended)
            for row, belief in enumerate(beliefs):
                costs[row].belief = belief
                if swapped:
                    swapped[row].belief = belief
    assert path is not None
    import os
    if os.environ.get("MAPONLY"):
        posture = pools.composed(path.stance // HEADINGS, {limb: path.limbs[:, column] for column, limb in enumerate(LIMBS)}, stances.heading_rad[path.stance % HEADINGS], path.hips)
    else:
        posture = mean_postures(
            pools, stances, states, path.stance, path.hips, path.limbs, path.posterior, path.limb_posterior
        )
    return Composition(path, states, posture, floor_m)


def tempering(time_s: Array) -> float:
    """Weight of one of several frames at some times (T,), as what makes one doubtful makes its neighbors doubtful."""
    return min(1.0, float(np.median(np.diff(time_s))) / CORRELATION_S)


def _every_second(count: int) -> IndexArray:
    """Every second of some frames, and the last."""
    return np.unique(np.append(np.arange(0, count, 2), count - 1)).astype(np.intp)


def _posed_at_both_ends(given: MatchInput, sampled: IndexArray) -> bool:
    return {int(sampled[0]), int(sampled[-1])} <= set(map(int, given.constraints.frames))


def frame_costs(
    given: MatchInput, stances: StanceFeatures, frames: IndexArray, floor_m: float | None
) -> list[FrameCosts]:
    """What some frames say of stances and limbs."""
    unit = NoiseScales.of(given.evidence)
    scales = replace(unit, centroid=unit.centroid * PART_SCALE)
    likelihoods = frame_likelihoods(given.camera, given.evidence, frames, floor_m, FLOOR_STD_M, scales)
    return [FrameCosts(each, stances, floor_m) for each in likelihoods]


def floor_height_m(given: MatchInput, stances: StanceFeatures, sampled: IndexArray, rough: Array) -> float:
    """Height of the floor by where feet are without it; 0 where that is about right, as scenes are built."""
    rows = np.unique(np.linspace(0, len(sampled) - 1, MOST_PLACED).astype(int))
    free, heights = [], []
    for row, cost in zip(rows, frame_costs(given, stances, sampled[rows], None), strict=True):
        if not cost.likelihood.visible.any():
            continue
        states = cost.states(rough[row] * np.array(WIDE))
        best = states.chosen(np.array([int(states.cost.argmin())]))
        relative = best.hips - cost.location
        feet = [
            float(cost.foot_heights(limb, best.stance, relative)[0, best.limbs[0, LIMBS.index(limb)]])
            for limb in LEGS
        ]
        heights.append(min(feet))
        free.append((row, float(states.cost.min())))
    found = float(np.median(heights)) if heights else 0.0
    if abs(found) < WORLD_FLOOR_M:
        return 0.0
    seen = np.array([row for row, _ in free])
    grounded = frame_costs(given, stances, sampled[seen], 0.0)
    added = [
        float(cost.states(rough[row] * np.array(WIDE)).cost.min()) - least
        for (row, least), cost in zip(free, grounded, strict=True)
    ]
    return 0.0 if np.mean(added) < FLOOR_COST_MARGIN else found


def _states(
    costs: Sequence[FrameCosts], others: Sequence[FrameCosts], rough: Array, shares: Sequence[float]
) -> Part[list[FrameStates]]:
    """The states of each frame, with those of exchanged sides where `others` are given."""
    found = []
    for index, (cost, depth) in enumerate(zip(costs, rough, strict=True)):
        states = cost.states(depth * np.array(shares))
        if others and others[index] is not cost:
            states = states.with_exchanged(others[index].states(depth * np.array(shares[:1])))
        found.append(states)
        yield index / len(costs)
    return found


def rough_depths(
    body: Body, camera: Camera, evidence: MatchEvidence, frames: IndexArray, time_s: Array
) -> Array:
    """(T,) distances of the hips along the camera's axis by sizes in the picture [m], smoothed."""
    depths = np.full(len(frames), np.nan)
    seen = evidence.visible[frames].any(axis=1)
    for row in np.flatnonzero(seen)[:: max(1, seen.sum() // MOST_PLACED)]:
        frame = int(frames[row])
        regions, keypoints = evidence.tracks.frame(frame), evidence.keypoints.frame(frame)
        placed = place_standing(body, camera, frame, regions, evidence.segments, keypoints)
        depths[row] = float(camera.depth(placed.translation, frame))
    known = np.isfinite(depths)
    return _smoothed(np.interp(time_s, time_s[known], depths[known]), time_s)


def _smoothed(values: Array, time_s: Array) -> Array:
    """Running medians over `SMOOTH_S` and then means."""
    near = np.abs(time_s[:, None] - time_s) < SMOOTH_S
    median = np.array([np.median(values[own]) for own in near])
    return np.array([median[own].mean() for own in near])
