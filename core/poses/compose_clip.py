"""Postures of a clip, put together from parts: the likeliest path, and the mean of probable parts around it.

The likeliest path takes one part of a pool a frame, some centimeters from the truth whatever is seen. The
mean of the parts near it, weighed by their probabilities, is nearer; parts of another kind, as those on the
other depth side, do not enter.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array, IndexArray, SingleArray
from ..body.body_volume import rested
from ..body.human import ANKLES, LIMBS
from ..body.posture import Posture
from ..camera.camera import Camera
from ..estimate.performer_placement import SAME_FLOOR_M, place_standing, standing_ankle_m
from ..estimate.sigma import SIZE_STD, place_depth_std_m
from ..estimate.windows import windows
from ..numerics.vectors import columns_at
from ..prior.library import Library
from ..progress import Part, scaled
from .clip_input import PosingInput, tempering
from .composed_path import ComposedPath, best_path
from .composed_states import LEGS, FrameCosts, FrameStates, PosedCosts
from .frame_likelihood import frame_likelihood
from .match_evidence import MatchEvidence
from .part_features import StanceFeatures, stance_features
from .part_pools import TORSO, part_dofs, part_pools


def mean_postures(stances: StanceFeatures, states: Sequence[FrameStates], path: ComposedPath) -> Posture:
    """(T,) means of the likely postures around a path through T frames' states."""
    likeliest = stances.composed(path.stance, path.limbs, path.hips)
    skeleton = likeliest.skeleton
    step = np.zeros((len(path.stance), skeleton.dof_count))
    torso = [0, 1, 2, *part_dofs(skeleton, TORSO)]
    points = stances.features.points
    for row, (own, chance) in enumerate(zip(states, path.posterior, strict=True)):
        apart = np.linalg.norm(points[own.stance] - points[path.stance[row]], axis=-1).mean(axis=-1)
        kept, weight = _weights(chance, apart)
        near = own.chosen(kept)
        others = stances.composed(near.stance, near.limbs, near.hips)
        step[row, torso] = weight @ others.minus(likeliest[np.full(len(kept), row)])[:, torso]
    for limb, chosen in zip(LIMBS, path.limbs.T, strict=True):
        kind, _, side = limb.partition(".")
        dofs = part_dofs(skeleton, kind, side)
        shapes = stances.limbs[limb].points
        none = np.zeros(len(shapes), dtype=np.intp)
        # Postures with each of the limb's parts, everything else alike.
        parts = {other: np.arange(len(shapes)) if other == limb else none for other in LIMBS}
        every = stances.pools.composed(none, parts, np.zeros(len(shapes)), np.zeros((len(shapes), 3)))
        for row, part in enumerate(chosen):
            apart = np.linalg.norm(shapes - shapes[part], axis=-1).mean(axis=-1)
            kept, weight = _weights(path.limb_posterior[limb][row], apart)
            step[row, dofs] = weight @ every[kept].minus(every[np.full(len(kept), part)])[:, dofs]
    return likeliest.plus(step)


def _weights(chance: Array | SingleArray, apart_m: Array | SingleArray) -> tuple[IndexArray, Array]:
    # Parts within about this distance are of one kind: less than there is between a limb's depth sides.
    near = np.exp(-0.5 * (apart_m / 0.15) ** 2)
    weight = np.asarray(chance, dtype=float) * near
    if not weight.any():  # all that is probable is far away
        weight = near
    kept = np.flatnonzero(weight >= 1e-3 * weight.max())
    return kept, weight[kept] / weight[kept].sum()


WIDE = (1.0, 0.92, 1.09, 0.84, 1.19, 0.77, 1.3)  # distances tried, as shares of one good to a tenth
MOST_PLACED = 16  # frames in which the performer is placed by size


@dataclass(frozen=True, eq=False)
class Composition:
    """Postures of T frames, put together from parts."""

    stances: StanceFeatures
    stance: IndexArray  # (T,) the likeliest
    wanted: dict[int, tuple[FrameStates, SingleArray]]
    """By the row of each frame whose posture is asked for: its states, and their probabilities."""
    posture: Posture  # (T,)
    floor_m: float  # height of the floor


def compose_frames(
    posing: PosingInput, floor_m: float | None, libraries: Sequence[Library], floor_open: bool = False
) -> Part[Composition]:
    """Compose the postures of the T frames of a clip that are looked at; `floor_m` is None where unknown.

    `floor_open` as in `floor_height_m`.

    At least one library has a posture.
    """
    evidence, camera = posing.evidence, posing.camera
    stances = stance_features(part_pools(libraries, posing.body), evidence)
    sampled, time_s = posing.sampled, posing.time_s
    # Distances tried about the first path.
    rounds: tuple[tuple[float, ...], ...] = (WIDE, (1.0, 0.96, 1.04, 0.92, 1.08))
    known = posing.posed
    # Between posed frames that are no farther apart nobody goes far away and comes back: the place is known.
    ends_posed = {int(sampled[0]), int(sampled[-1])} <= set(map(int, known.frames))
    if ends_posed and (np.diff(evidence.tracks.time_s[known.frames]) <= 2.0).all():
        depths = [camera.depth(hips, int(f)) for f, hips in zip(known.frames, known.hips, strict=True)]
        rough = np.interp(sampled, known.frames, depths)
        rounds = ((1.0, 0.96, 1.04),)  # distances tried between two posed frames, which tell the place
    else:
        # Distances of the hips along the camera's axis by sizes in the picture [m].
        far_m = np.full(len(sampled), np.nan)
        seen = evidence.visible[sampled].any(axis=1)
        for row in np.flatnonzero(seen)[:: max(1, seen.sum() // MOST_PLACED)]:
            frame = int(sampled[row])
            regions, keypoints = evidence.tracks.frame(frame), evidence.keypoints.frame(frame)
            placed = place_standing(posing.body, camera, frame, regions, evidence.segments, keypoints)
            far_m[row] = float(camera.depth(placed.translation, frame))
        known = np.isfinite(far_m)
        rough = _smoothed(np.interp(time_s, time_s[known], far_m[known]), time_s)
    if floor_m is None:
        floor_m = floor_height_m(posing, stances, rough, floor_open)
    floor_seen_m = floor_m if any(posing.feet_seen) else None  # feet never seen tell no place
    yield 0.1
    # Seconds that are composed together, and those on either side that are looked at besides: a posture
    # depends on those of a second about it.
    length, margin = (round(one / float(np.median(np.diff(time_s)))) for one in (20.0, 2.0))
    spans = list(windows(len(sampled), length, margin))
    rows = np.searchsorted(sampled, posing.keyframes)
    stance, wanted, pieces = [], {}, []
    for number, span in enumerate(spans):
        begun, ended = (0.1 + 0.9 * (number + end) / len(spans) for end in (0, 1))
        looking = _likeliest(posing, stances, np.arange(span.first, span.last), rough, rounds, floor_seen_m)
        states, path = yield from scaled(looking, begun, ended)
        pieces.append(mean_postures(stances, states, path)[span.kept])
        stance.append(path.stance[span.kept])
        for row in rows[(rows >= span.keep_first) & (rows < span.keep_last)]:
            wanted[int(row)] = states[row - span.first], path.posterior[row - span.first]
    posture = Posture.concatenate(pieces)
    if floor_seen_m is not None and not len(posing.posed.frames):
        posture = _on_floor(posing, posture, floor_seen_m)
    posture = rested(posing.body, posture, posing.unseen)
    return Composition(stances, np.concatenate(stance), wanted, posture, floor_m)


def _likeliest(
    posing: PosingInput,
    stances: StanceFeatures,
    own: IndexArray,
    rough: Array,
    rounds: Sequence[Sequence[float]],
    floor_m: float | None,
) -> Part[tuple[list[FrameStates], ComposedPath]]:
    """The likeliest path through some rows in a row of the frames that are looked at, and its states.

    `rough`: (T,) distances of all rows, about which shares of them are tried, in `rounds`.
    """
    camera, evidence = posing.camera, posing.evidence
    sampled, time_s, rough = posing.sampled[own], posing.time_s[own], rough[own]
    for turn, shares in enumerate(rounds):
        # The second of two rounds takes three times as long: all frames, and exchanged sides.
        begun, ended = (((turn + end) / len(rounds)) ** 2 for end in (0, 1))
        searched = begun + 0.85 * (ended - begun)
        is_last = turn == len(rounds) - 1
        # The first round is for the place; exchanged sides are tried where it is known.
        rows = np.unique(np.append(np.arange(0, len(sampled), 1 if is_last else 2), len(sampled) - 1))
        weight, posed = tempering(time_s[rows]), posing.posed
        costs = frame_costs(camera, evidence, stances, sampled[rows], floor_m)
        for index, frame in enumerate(posed.frames):
            for row in np.flatnonzero(sampled[rows] == frame):
                hips, points = posed.hips[index], posed.points[index]
                costs[row] = PosedCosts(costs[row].likelihood, stances, hips, points, weight)
        others: list[FrameCosts] = []
        if is_last and evidence.keypoints.names:
            others = frame_costs(camera, evidence.exchanged(), stances, sampled[rows], floor_m)
        states = yield from scaled(_states(costs, others, rough[rows], shares), begun, searched)
        step_m = float(np.median(rough)) * abs(shares[1] - shares[0])
        leading = best_path(stances, states, costs, others, time_s[rows], weight, step_m)
        path = yield from scaled(leading, searched, ended)
        if not is_last:
            hips = _smoothed(columns_at(time_s, time_s[rows], path.hips), time_s)
            rough = np.array([camera.depth(at, int(frame)) for at, frame in zip(hips, sampled, strict=True)])
    return states, path


def _on_floor(posing: PosingInput, posture: Posture, floor_m: float) -> Posture:
    """(T,) postures nearer to the camera or farther away, so that the lower foot is on the floor over a time.

    The floor is the better ruler of distance, the more the camera looks down on it; a detector's body is
    smaller than the skeleton. Feet far above the floor, on steps or in flight, say nothing.
    """
    sampled, time_s = posing.sampled, posing.time_s
    points = posing.body.points(posing.body.pose(posture))
    feet = points[:, ANKLES]
    foot = feet[np.arange(len(feet)), feet[..., 2].argmin(axis=1)]
    _, eye = posing.camera.pose(sampled)
    eye = np.broadcast_to(eye, foot.shape)
    wanted_m = floor_m + standing_ankle_m(posing.body)
    below, wanted_below = eye[:, 2] - foot[:, 2], eye[:, 2] - wanted_m
    usable = (np.minimum(below, wanted_below) > SAME_FLOOR_M) & (foot[:, 2] - wanted_m < SAME_FLOOR_M)
    if not usable.any():
        return posture
    sized_m = SIZE_STD * np.linalg.norm(foot - eye, axis=-1)
    sure = (
        1.0
        - (place_depth_std_m(points, np.full(len(points), wanted_m), posing.camera, frame=sampled) / sized_m)
        ** 2
    )
    share = sure * (wanted_below / np.maximum(below, SAME_FLOOR_M) - 1.0)
    share = _smoothed(np.interp(time_s, time_s[usable], share[usable]), time_s)
    hips = posture.translation + share[:, None] * (posture.translation - eye)
    return Posture(posture.skeleton, hips, posture.rotations, posture.angles)


def frame_costs(
    camera: Camera,
    evidence: MatchEvidence,
    stances: StanceFeatures,
    frames: IndexArray,
    floor_m: float | None,
) -> list[FrameCosts]:
    """What some frames say of stances and limbs."""
    # Deviation of a composed body, relative to that of another performer's posture.
    seen = (frame_likelihood(camera, evidence, int(frame), 0.4) for frame in frames)
    return [FrameCosts(each, stances, floor_m) for each in seen]


def floor_height_m(posing: PosingInput, stances: StanceFeatures, rough: Array, floor_open: bool) -> float:
    """Height of the floor by where feet are without it; 0 where sizes allow it, as scenes are built.

    `floor_open`: that height has no such preference, as before a camera whose own height was assumed.
    """
    sampled = posing.sampled
    rows = np.unique(np.linspace(0, len(sampled) - 1, MOST_PLACED).astype(int))
    free, heights, eyes = [], [], []
    every = frame_costs(posing.camera, posing.evidence, stances, sampled[rows], None)
    for row, cost in zip(rows, every, strict=True):
        if not cost.likelihood.visible.any():
            continue
        states = cost.states(rough[row] * np.array(WIDE))
        best = states.chosen(np.array([int(states.cost.argmin())]))
        relative = best.hips - cost.likelihood.location
        feet = [
            float(cost.foot_heights(limb, best.stance, relative)[0, best.limbs[0, LIMBS.index(limb)]])
            for limb in LEGS
        ]
        heights.append(min(feet))
        eyes.append(float(cost.likelihood.location[2]))
        free.append((row, float(states.cost.min())))
    found = float(np.median(heights)) if heights else 0.0
    if floor_open:
        return found
    if abs(found) < 0.25:  # sizes are no more exact, and scenes are built on z = 0
        return 0.0
    # On a floor the performer is as far away as the camera is above it.
    # Sizes rule out z = 0 where that would be half as far again, or nearer in proportion.
    eye = float(np.median(eyes))
    if not (eye - found) / 1.5 < eye < (eye - found) * 1.5:
        return found
    seen = np.array([row for row, _ in free])
    grounded = frame_costs(posing.camera, posing.evidence, stances, sampled[seen], 0.0)
    added = [
        float(cost.states(rough[row] * np.array(WIDE)).cost.min()) - least
        for (row, least), cost in zip(free, grounded, strict=True)
    ]
    # Mean cost of a frame that putting the floor at z = 0 may add before another height is preferred.
    return 0.0 if np.mean(added) < 1.5 else found


def _states(
    costs: Sequence[FrameCosts], others: Sequence[FrameCosts], rough: Array, shares: Sequence[float]
) -> Part[list[FrameStates]]:
    """The states of each frame, with those of exchanged sides where `others` are given."""
    found = []
    for index, (cost, depth) in enumerate(zip(costs, rough, strict=True)):
        states = cost.states(depth * np.array(shares))
        if others and not isinstance(cost, PosedCosts):
            states = states.with_exchanged(others[index].states(depth * np.array(shares[:1])))
        found.append(states)
        yield index / len(costs)
    return found


def _smoothed(values: Array, time_s: Array) -> Array:
    """Running medians of values (T, ...) over 0.6 s to either side, and then means."""
    near = [np.flatnonzero(np.abs(time_s - at) < 0.6) for at in time_s]
    median = np.array([np.median(values[own], axis=0) for own in near])
    return np.array([median[own].mean(axis=0) for own in near])
