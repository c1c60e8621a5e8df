"""Who of the people that a detector saw is the performer: the likeliest path through all frames.

A detector counts people anew in every frame, swaps them where they cross, and misses them where they are
hidden. The path is found by the Viterbi algorithm, which may pass over frames. A person's cost is the
distance from where the performer is expected; a step's cost is the distance from where the last sighting was
heading and the change of its shape, both of which may grow with the time between. All are half squares of
deviations, each limited, so that one wrong point or frame decides nothing.
"""

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..body.human import HUMAN
from ..numerics.markov_chain import NOBODY, cheapest_track
from .keypoints import Keypoints, SeenPeople

MOST_CANDIDATES = 8  # people a frame that are looked at: those nearest to the expected place, or the largest
ABSENT_COST = 4.5  # of taking nobody where the performer is expected: three standard deviations
JUMP_COST = 12.0  # of a step to anywhere: five standard deviations
FITS = 0.1
"""Mean distance of two detectors' points of the same person, in sizes of the person, that they stay below:
what they call a hip or an ankle differs by some 3 %."""


@dataclass(frozen=True, eq=False)
class Sightings:
    """People of every frame, H of them in each with K points, which need not be a detector's."""

    pixel: tuple[Array, ...]  # (H, K, 2) [px] a frame, NaN where not seen
    score: tuple[Array, ...]  # (H, K) 0 to 1 a frame


@dataclass(frozen=True, eq=False)
class Expected:
    """Where the performer's points are expected."""

    pixel: Array  # (F, K, 2) [px], NaN where nothing is known
    std_px: Array  # (F, K) standard deviation in each direction [px]
    weight: Array  # (F,) how much a frame counts: more than 1 where a person has said where the performer is


def choose_performer(seen: Sightings, expected: Expected | None, fps: float) -> IndexArray:
    """The performer's index among the people of each of F frames, `NOBODY` where it is none of them."""
    costs, absent = _costs(seen, expected)
    rows = [np.flatnonzero(np.isfinite(cost)) for cost in costs]
    first = np.concatenate([[0], np.cumsum([len(own) for own in rows])]).astype(np.intp)
    if not first[-1]:
        return np.full(len(rows), NOBODY, dtype=np.intp)
    pixel, own = (
        np.concatenate([values[kept] for values, kept in zip(every, rows, strict=True)])
        for every in (seen.pixel, costs)
    )
    time_s = np.repeat(np.arange(len(rows)), np.diff(first)) / fps
    velocity = np.full((len(own), 2), np.nan)  # px a second along the path; NaN where it begins

    def step_costs(here: IndexArray, before: IndexArray) -> Array:
        passed_s = time_s[here[0]] - time_s[before]
        return _step_cost(pixel[before], velocity[before], passed_s, pixel[here])[0]

    def taken(here: IndexArray, source: IndexArray) -> None:
        for row, before in zip(here, source, strict=True):
            if before != NOBODY:
                passed_s = time_s[[row]] - time_s[before]
                _, moved = _step_cost(pixel[[before]], velocity[[before]], passed_s, pixel[[row]])
                speed, known = moved[0, 0] / passed_s, velocity[before]
                velocity[row] = np.where(np.isnan(known), speed, 0.5 * (known + speed))

    # After a second a person may be anywhere.
    track = cheapest_track(first, own, absent, JUMP_COST, max(1, round(fps)), step_costs, taken)
    return np.where(track == NOBODY, NOBODY, np.concatenate(rows)[track])


def _step_cost(pixel: Array, velocity: Array, time_s: Array, now: Array) -> tuple[Array, Array]:
    """Cost of the steps from S earlier sightings to H people, (H, S), and their lengths (H, S, 2) [px]."""
    shared = np.isfinite(now[:, None, :, 0]) & np.isfinite(pixel[None, :, :, 0])  # (H, S, K)
    count = np.maximum(shared.sum(axis=-1), 1)
    offset = np.where(shared[..., None], now[:, None] - pixel[None], 0.0)
    moved = offset.sum(axis=2) / count[..., None]
    shape2 = (np.where(shared[..., None], offset - moved[:, :, None], 0.0) ** 2).sum(axis=(2, 3)) / count
    size = np.maximum(person_size(now)[:, None], person_size(pixel)[None])
    known = np.isfinite(velocity).all(axis=-1)
    ahead = np.where(known[:, None], np.nan_to_num(velocity), 0.0) * time_s[:, None]
    # Shares of a person's size: a detector's error, half of what gravity does to a body, and a run of whom no
    # speed is known of. The points about their middle: a detector's error, limbs at 2 m/s, any two postures.
    spread = 0.02 + 3.0 * time_s**2 + np.where(known, 0.0, 2.0 * time_s)
    shift2 = ((moved - ahead) ** 2).sum(axis=-1) / (size * spread) ** 2
    shape = np.minimum(0.05 + 1.2 * time_s, 0.4)
    cost = 0.5 * (shift2 + shape2 / (size * shape) ** 2)
    return np.where(shared.any(axis=-1), np.minimum(cost, JUMP_COST), JUMP_COST), moved


def person_size(pixel: Array) -> Array:
    """(...) how large people are [px]: the diagonal of the box about their seen points (..., K, 2)."""
    seen = np.isfinite(pixel)
    low = np.where(seen, pixel, np.inf).min(axis=-2)
    high = np.where(seen, pixel, -np.inf).max(axis=-2)
    extent = np.where(high >= low, high - low, 0.0)
    return np.maximum(np.linalg.norm(extent, axis=-1), 1.0)


def _costs(seen: Sightings, expected: Expected | None) -> tuple[list[Array], Array]:
    """Cost of each person of each frame, infinite for those not looked at, and of taking nobody (F,)."""
    sizes = [person_size(pixel) for pixel in seen.pixel]
    largest = max((float(size.max()) for size in sizes if len(size)), default=1.0)
    preference = 0.25 if expected is None else 0.01  # of being large and sure; elsewhere it breaks ties alone
    costs, absent = [], np.zeros(len(seen.pixel))
    for frame, (pixel, score) in enumerate(zip(seen.pixel, seen.score, strict=True)):
        there = np.isfinite(pixel).all(axis=-1)
        mean_score = (score * there).sum(axis=1) / np.maximum(there.sum(axis=1), 1)
        cost = preference * (2.0 - sizes[frame] / largest - mean_score)
        absent[frame] = 1.0 if len(pixel) else 0.0  # somebody who is there longer is preferred
        if expected is not None and len(pixel):
            known = np.isfinite(expected.pixel[frame]).all(axis=-1)
            if known.any():
                weight, own = float(expected.weight[frame]), np.where(there & known, score, 0.0)
                apart2 = ((pixel - expected.pixel[frame]) ** 2).sum(axis=-1) / expected.std_px[frame] ** 2
                # Each point counts by its score, up to four deviations.
                off = (own * np.minimum(0.5 * np.where(own > 0.0, apart2, 0.0), 8.0)).sum(axis=1)
                total = own.sum(axis=1)
                # Somebody of whom no expected point is seen is as good as nobody.
                cost += weight * np.where(total > 0.0, off / np.where(total > 0.0, total, 1.0), ABSENT_COST)
                absent[frame] = weight * ABSENT_COST
        if len(cost) > MOST_CANDIDATES:
            cost = np.where(cost.argsort().argsort() < MOST_CANDIDATES, cost, np.inf)
        costs.append(cost)
    return costs, absent


def principal_keypoints(keypoints: Keypoints) -> Keypoints:
    """The principal points (F, P), in the skeleton's order; NaN where none shows one.

    Where several sources show the same point, those that agree with the most confident one are averaged.
    """
    size = performer_size_px(keypoints)
    found = [_agreed(keypoints, name, size) for name in HUMAN.point_names]
    left, right, nose = (_agreed(keypoints, name, size) for name in ("ear.L", "ear.R", "nose"))
    ears = 0.5 * (left + right)
    ears[:, 2] = np.minimum(left[:, 2], right[:, 2])
    nose[:, 2] *= 0.3  # it lies a decimeter before the head's middle
    for other in (ears, nose):
        head = found[HUMAN.point_names.index("head")]
        head[:] = np.where(np.isfinite(head[:, :1]), head, other)
    points = np.stack(found, axis=1)
    names, nothing = HUMAN.point_names, ("",) * len(found)
    return Keypoints(names, nothing, points[..., :2], points[..., 2], points[..., 3:])


def performer_size_px(keypoints: Keypoints) -> Array:
    """(F,) larger side of the box around all keypoints [px], at least the clip's median; 0 without any."""
    seen = keypoints.seen
    if not seen.any():
        return np.zeros(keypoints.frame_count)
    high = np.where(seen[..., None], keypoints.pixel, -np.inf).max(axis=1)
    low = np.where(seen[..., None], keypoints.pixel, np.inf).min(axis=1)
    side = np.where(np.isfinite(high), high - low, 0.0).max(axis=1)
    return np.maximum(side, np.median(side[seen.any(axis=1)]))


def _agreed(keypoints: Keypoints, name: str, size_px: Array) -> Array:
    """(F, 6) place [px], score and hint [m] of a point by all sources that agree with the most confident one.

    Where it is not seen the score is 0, all else NaN.
    """
    own = [index for index, known in enumerate(keypoints.names) if known == name]
    if not own:
        return np.tile([np.nan, np.nan, 0.0, np.nan, np.nan, np.nan], (keypoints.frame_count, 1))
    pixel, hint = keypoints.pixel[:, own], keypoints.hint_m[:, own]
    score = np.where(keypoints.seen[:, own], keypoints.score[:, own], -1.0)
    best = (np.arange(len(score)), score.argmax(axis=1))
    apart = np.linalg.norm(pixel - pixel[best][:, None], axis=-1)  # NaN where not seen
    weight = np.where(apart <= 0.1 * size_px[:, None], np.maximum(score, 1e-6), 0.0)
    hinted = weight * np.isfinite(hint).all(axis=-1)
    return np.column_stack([_mean(pixel, weight), np.maximum(score[best], 0.0), _mean(hint, hinted)])


def _mean(values: Array, weight: Array) -> Array:
    """Weighted mean (F, C) of values (F, K, C); NaN where nothing weighs."""
    total = weight.sum(axis=1)[:, None]
    summed = (weight[..., None] * np.where(weight[..., None] > 0.0, values, 0.0)).sum(axis=1)
    return np.where(total > 0.0, summed / np.where(total > 0.0, total, 1.0), np.nan)


JUMP = 0.2
"""Share of a person's size by which the body is off from where it was going, beyond what a run explains; in
the middle of all points, so that a detector that takes one limb for another moves it less."""
RUN_PER_S = 3.0  # sizes of a person: some five meters a second, faster than people are filmed
SMOOTH = 0.5  # how much of the speed is that of the last step
NOTHING: Mapping[int, bool] = MappingProxyType({})
FEWEST = 4  # points seen in two frames that tell how the body moved


def repeated_results(frames: Sequence[SeenPeople]) -> list[int]:
    """Indices of the frames whose people are exactly those of the frame before.

    No two pictures of a camera give the same numbers for several points, down to the scores.
    """
    found = []
    for index in range(1, len(frames)):
        last, now = frames[index - 1], frames[index]
        if not len(now.pixel) or now.pixel.shape != last.pixel.shape or now.pixel.shape[1] < FEWEST:
            continue
        same = np.array_equal(now.pixel, last.pixel, equal_nan=True)
        if same and np.array_equal(now.score, last.score):
            found.append(index)
    return found


def same_person(pixel: Array, fps: float, looked: Mapping[int, bool] = NOTHING) -> BoolArray:
    """(F,) which frames of one path (F, N, 2) [px] show the person whom most of it shows; NaN is not seen.

    The path is cut where the whole body jumps. Of the pieces those are kept that a person can have gone
    through one after the other and that have the most frames. Of the frames that were looked at, `looked`
    says whether the picture shows somebody there: a piece counts as much as it does.
    """
    shown = np.flatnonzero(np.isfinite(pixel).all(axis=-1).sum(axis=1) >= FEWEST)
    kept = np.ones(len(pixel), dtype=np.bool_)
    if len(shown) < 2:
        return kept
    own = pixel[shown] / float(np.median(person_size(pixel[shown])))
    pieces = _pieces(shown, own, fps, looked)
    if len(pieces) < 2:
        return kept
    answers = [[looked[frame] for frame in map(int, shown[piece]) if frame in looked] for piece in pieces]
    weight = [
        len(piece) * float(np.mean(answer or [True])) for piece, answer in zip(pieces, answers, strict=True)
    ]
    ends = np.array([(rows[0], rows[-1]) for rows in pieces])

    def step_costs(here: IndexArray, before: IndexArray) -> Array:
        """0 for pieces that a person can have gone through one after the other, else infinite."""
        last, now = ends[before, 1], int(ends[here[0], 0])
        moved = np.array([np.linalg.norm(_moved(own[row], own[now])) for row in last])
        return np.where(moved < JUMP + RUN_PER_S * (shown[now] - shown[last]) / fps, 0.0, np.inf)[None]

    every = np.arange(len(pieces))
    track = cheapest_track(
        np.arange(len(pieces) + 1), -np.array(weight), np.zeros(len(pieces)), np.inf, len(pieces), step_costs
    )
    chosen = every[(track != NOBODY) & (np.array(weight) > 0.0)]
    starts = [shown[rows[0]] for rows in pieces] + [len(pixel)]
    for number in set(every) - set(chosen):
        kept[starts[number] : starts[number + 1]] = False
    return kept


def _moved(before: Array, now: Array) -> Array:
    """(2,) how far the points (N, 2) have moved in the middle; nowhere where too few are seen in both."""
    step = now - before
    known = np.isfinite(step).all(axis=-1)
    return np.median(step[known], axis=0) if known.sum() >= FEWEST else np.zeros(2)


def _pieces(frames: IndexArray, pixel: Array, fps: float, looked: Mapping[int, bool]) -> list[list[int]]:
    """Rows of the pieces without a jump, of points (G, N, 2) [sizes of a person] at some frames.

    Where the path jumps somewhere, a jump lies also between a frame in which the picture shows somebody there
    and one in which it does not: the way back may be small. Without any jump a picture says nothing.
    """
    time_s = np.diff(frames) / fps
    off = np.zeros(len(time_s))  # of each step from where the body was going
    speed = np.full(2, np.nan)
    cuts = set()
    for row, step_s in enumerate(time_s):
        step = _moved(pixel[row], pixel[row + 1])
        off[row] = np.linalg.norm(step - np.nan_to_num(speed) * step_s)
        now = step / step_s
        if off[row] > JUMP + RUN_PER_S * step_s:
            cuts.add(row + 1)
            speed[:] = np.nan
        else:
            speed = np.where(np.isfinite(speed), SMOOTH * now + (1.0 - SMOOTH) * speed, now)
    jumps = bool(cuts)
    answered = [row for row, frame in enumerate(map(int, frames)) if frame in looked]
    for first, last in itertools.pairwise(answered):
        differ = looked[int(frames[first])] != looked[int(frames[last])]
        if differ and jumps and cuts.isdisjoint(range(first + 1, last + 1)):
            cuts.add(first + 1 + int(off[first:last].argmax()))
    ends = [0, *sorted(cuts), len(frames)]
    return [list(range(first, last)) for first, last in itertools.pairwise(ends)]
