"""Who of the people that a detector saw is the performer: the likeliest path through all frames.

A detector counts people anew in every frame, swaps them where they cross, and misses them where they are
hidden. The path is found by the Viterbi algorithm, which may pass over frames. A person's cost is the
distance from where the performer is expected; a step's cost is the distance from where the last sighting was
heading and the change of its shape, both of which may grow with the time between. All are half squares of
deviations, each limited, so that one wrong point or frame decides nothing.
"""

from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..body.human import HUMAN
from .keypoints import Keypoints

NOBODY = -1
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
    frames = len(seen.pixel)
    costs, absent = _costs(seen, expected)
    before = np.concatenate([[0.0], np.cumsum(absent)])  # of all frames before each
    window = max(1, round(1.0 * fps))  # seconds; after them a person may be anywhere
    kept: list[_Reached] = []
    # Least cost of a path that ended before the window, without the frames passed over since, and its end.
    best_far, far = np.inf, (0, 0)
    end, last = before[-1], (NOBODY, 0)
    for frame in range(frames):
        if frame > window and len(kept[frame - window - 1].cost):
            old = kept[frame - window - 1]
            value = old.cost - before[frame - window]
            if value.min() < best_far:
                best_far, far = float(value.min()), (frame - window - 1, int(value.argmin()))
        rows = np.flatnonzero(np.isfinite(costs[frame]))
        reached = _Reached.start(seen.pixel[frame][rows], rows, before[frame])
        if len(rows):
            if best_far + before[frame] + JUMP_COST < reached.cost.min():
                reached.cost[:] = best_far + before[frame] + JUMP_COST
                reached.previous[:] = far
            _step(reached, kept, frame, window, before, fps)
            reached.cost += costs[frame][rows]
            value = reached.cost + before[-1] - before[frame + 1]
            if value.min() < end:
                end, last = float(value.min()), (frame, int(value.argmin()))
        kept.append(reached)
    chosen = np.full(frames, NOBODY, dtype=np.intp)
    frame, row = last
    while frame != NOBODY:
        chosen[frame] = kept[frame].rows[row]
        frame, row = (int(value) for value in kept[frame].previous[row])
    return chosen


@dataclass(eq=False)
class _Reached:
    """The best path to each candidate of a frame."""

    pixel: Array  # (H, K, 2)
    rows: IndexArray  # (H,) their indices among the frame's people
    cost: Array
    previous: IndexArray
    """(H, 2) frame and candidate from which the path comes; frame `NOBODY` where it begins."""
    velocity: Array  # (H, 2) px a second along the path; NaN where it begins

    @classmethod
    def start(cls, pixel: Array, rows: IndexArray, cost: float) -> "_Reached":
        count = len(rows)
        previous = np.full((count, 2), NOBODY, dtype=np.intp)
        return cls(pixel, rows, np.full(count, cost), previous, np.full((count, 2), np.nan))


def _step(
    reached: _Reached, kept: list[_Reached], frame: int, window: int, before: Array, fps: float
) -> None:
    """Continue the paths of the last frames where that costs less than to begin one."""
    first = max(0, frame - window)
    where = np.array([(index, row) for index in range(first, frame) for row in range(len(kept[index].cost))])
    if not len(where):
        return
    cost = np.concatenate([one.cost for one in kept[first:frame]]) + before[frame] - before[where[:, 0] + 1]
    useful = cost <= cost.min() + JUMP_COST  # no step costs more
    where, cost = where[useful], cost[useful]
    pixel = np.stack([kept[index].pixel[row] for index, row in where])
    velocity = np.stack([kept[index].velocity[row] for index, row in where])
    time_s = (frame - where[:, 0]) / fps
    step, moved = _step_cost(pixel, velocity, time_s, reached.pixel)
    total = cost + step  # (H, S)
    best = total.argmin(axis=1)
    row = np.arange(len(best))
    better = total[row, best] < reached.cost
    reached.cost[better] = total[row, best][better]
    reached.previous[better] = where[best][better]
    speed = moved[row, best] / time_s[best, None]
    known = velocity[best]
    smooth = np.where(np.isnan(known), speed, 0.5 * (known + speed))
    jumped = step[row, best] >= JUMP_COST
    reached.velocity[better & ~jumped] = smooth[better & ~jumped]


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
                weight = float(expected.weight[frame])
                cost = cost + weight * _distance_cost(pixel, score, expected, frame, known)
                absent[frame] = weight * ABSENT_COST
        if len(cost) > MOST_CANDIDATES:
            cost = np.where(cost.argsort().argsort() < MOST_CANDIDATES, cost, np.inf)
        costs.append(cost)
    return costs, absent


def _distance_cost(pixel: Array, score: Array, expected: Expected, frame: int, known: BoolArray) -> Array:
    """(H,) mean over the points of half the squared distance, each limited, weighted by the scores."""
    weight = np.where(np.isfinite(pixel).all(axis=-1) & known, score, 0.0)
    distance2 = ((pixel - expected.pixel[frame]) ** 2).sum(axis=-1) / expected.std_px[frame] ** 2
    cost = np.minimum(0.5 * np.where(weight > 0.0, distance2, 0.0), 8.0)  # four deviations
    total = weight.sum(axis=1)
    # Somebody of whom no expected point is seen is as good as nobody.
    return np.where(total > 0.0, (weight * cost).sum(axis=1) / np.where(total > 0.0, total, 1.0), ABSENT_COST)


def principal_keypoints(keypoints: Keypoints) -> Keypoints:
    """The principal points (F, P), in the skeleton's order; NaN where none shows one.

    Where several sources show the same point, those that agree with the most confident one are averaged.
    """
    size = performer_size_px(keypoints)
    found = [_agreed(keypoints, name, size) for name in HUMAN.point_names]
    head = HUMAN.point_names.index("head")
    left, right, nose = (_agreed(keypoints, name, size) for name in ("ear.L", "ear.R", "nose"))
    doubted = replace(nose, score=0.3 * nose.score)  # it lies a decimeter before the head's middle
    found[head] = found[head].or_else(_middle(left, right)).or_else(doubted)
    return Keypoints(
        HUMAN.point_names,
        ("",) * len(found),
        np.stack([point.pixel for point in found], axis=1),
        np.stack([point.score for point in found], axis=1),
        np.stack([point.hint_m for point in found], axis=1),
    )


def performer_size_px(keypoints: Keypoints) -> Array:
    """(F,) larger side of the box around all keypoints [px], at least the clip's median; 0 without any."""
    seen = keypoints.seen
    if not seen.any():
        return np.zeros(keypoints.frame_count)
    high = np.where(seen[..., None], keypoints.pixel, -np.inf).max(axis=1)
    low = np.where(seen[..., None], keypoints.pixel, np.inf).min(axis=1)
    side = np.where(np.isfinite(high), high - low, 0.0).max(axis=1)
    return np.maximum(side, np.median(side[seen.any(axis=1)]))


@dataclass(frozen=True, eq=False)
class _Point:
    """One point of the body over F frames."""

    pixel: Array  # (F, 2) [px], NaN where not seen
    score: Array  # (F,) 0 where not seen
    hint_m: Array  # (F, 3) NaN where there is none

    def or_else(self, other: "_Point") -> "_Point":
        """This point where it is seen, the other elsewhere."""
        seen = np.isfinite(self.pixel).all(axis=-1)
        return _Point(
            np.where(seen[:, None], self.pixel, other.pixel),
            np.where(seen, self.score, other.score),
            np.where(seen[:, None], self.hint_m, other.hint_m),
        )


def _middle(first: _Point, second: _Point) -> _Point:
    """The point halfway between two that are both seen."""
    return _Point(
        0.5 * (first.pixel + second.pixel),
        np.minimum(first.score, second.score),
        0.5 * (first.hint_m + second.hint_m),
    )


def _agreed(keypoints: Keypoints, name: str, size_px: Array) -> _Point:
    """A point of the body by all sources that agree with the most confident one."""
    own = [index for index, known in enumerate(keypoints.names) if known == name]
    if not own:
        frames = keypoints.frame_count
        return _Point(np.full((frames, 2), np.nan), np.zeros(frames), np.full((frames, 3), np.nan))
    pixel, hint = keypoints.pixel[:, own], keypoints.hint_m[:, own]
    score = np.where(keypoints.seen[:, own], keypoints.score[:, own], -1.0)
    best = (np.arange(len(score)), score.argmax(axis=1))
    apart = np.linalg.norm(pixel - pixel[best][:, None], axis=-1)  # NaN where not seen
    weight = np.where(apart <= 0.1 * size_px[:, None], np.maximum(score, 1e-6), 0.0)
    hinted = weight * np.isfinite(hint).all(axis=-1)
    return _Point(_mean(pixel, weight), np.maximum(score[best], 0.0), _mean(hint, hinted))


def _mean(values: Array, weight: Array) -> Array:
    """Weighted mean (F, C) of values (F, K, C); NaN where nothing weighs."""
    total = weight.sum(axis=1)[:, None]
    summed = (weight[..., None] * np.where(weight[..., None] > 0.0, values, 0.0)).sum(axis=1)
    return np.where(total > 0.0, summed / np.where(total > 0.0, total, 1.0), np.nan)
