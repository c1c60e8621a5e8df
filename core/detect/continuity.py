"""What a detector's results over time say of themselves: which repeat the one before, and where it jumps.

Programs that run live look at some frames only and give their last result again in between. And a detector
that sees one person a frame may take somebody else for a while.
"""

import itertools
from collections.abc import Mapping, Sequence
from types import MappingProxyType

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..numerics.markov_chain import NOBODY, cheapest_track
from .keypoints import SeenPeople
from .performer import person_size

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
    told = np.flatnonzero(np.isfinite(pixel).all(axis=-1).sum(axis=1) >= FEWEST)
    kept = np.ones(len(pixel), dtype=np.bool_)
    if len(told) < 2:
        return kept
    own = pixel[told] / float(np.median(person_size(pixel[told])))
    pieces = _pieces(told, own, fps, looked)
    if len(pieces) < 2:
        return kept
    answers = [[looked[frame] for frame in map(int, told[piece]) if frame in looked] for piece in pieces]
    weight = [
        len(piece) * float(np.mean(said or [True])) for piece, said in zip(pieces, answers, strict=True)
    ]
    ends = np.array([(rows[0], rows[-1]) for rows in pieces])

    def step_costs(here: IndexArray, before: IndexArray) -> Array:
        """0 for pieces that a person can have gone through one after the other, else infinite."""
        last, now = ends[before, 1], int(ends[here[0], 0])
        moved = np.array([np.linalg.norm(_moved(own[row], own[now])) for row in last])
        return np.where(moved < JUMP + RUN_PER_S * (told[now] - told[last]) / fps, 0.0, np.inf)[None]

    every = np.arange(len(pieces))
    track = cheapest_track(
        np.arange(len(pieces) + 1), -np.array(weight), np.zeros(len(pieces)), np.inf, len(pieces), step_costs
    )
    chosen = every[(track != NOBODY) & (np.array(weight) > 0.0)]
    starts = [told[rows[0]] for rows in pieces] + [len(pixel)]
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
    asked = [row for row, frame in enumerate(map(int, frames)) if frame in looked]
    for first, last in itertools.pairwise(asked):
        differ = looked[int(frames[first])] != looked[int(frames[last])]
        if differ and jumps and cuts.isdisjoint(range(first + 1, last + 1)):
            cuts.add(first + 1 + int(off[first:last].argmax()))
    ends = [0, *sorted(cuts), len(frames)]
    return [list(range(first, last)) for first, last in itertools.pairwise(ends)]
