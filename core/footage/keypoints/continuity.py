"""What a detector's results over time say of themselves: which repeat the one before, and where it jumps.

Programs that run live look at some frames only and give their last result again in between. And a detector
that sees one person a frame may take somebody else for a while.
"""

from collections.abc import Collection, Sequence

import numpy as np

from ...arrays import Array, BoolArray
from .keypoints import SeenPeople
from .performer import person_size

JUMP = 0.4
"""Share of a person's size by which the middle of the body is off from where it was going, beyond what a run
explains: a detector that takes one limb for another moves it less."""
RUN_PER_S = 3.0  # sizes of a person: some five meters a second, faster than people are filmed
SMOOTH = 0.5  # how much of the speed is that of the last step
KNOWN = 0.5  # share of the points that tell where the middle of the body is


def repeated_results(frames: Sequence[SeenPeople]) -> list[int]:
    """Indices of the frames whose people are exactly those of the frame before.

    No two pictures of a camera give the same numbers, down to the scores.
    """
    found = []
    for index in range(1, len(frames)):
        last, now = frames[index - 1], frames[index]
        if not len(now.pixel) or now.pixel.shape != last.pixel.shape:
            continue
        same = np.array_equal(now.pixel, last.pixel, equal_nan=True)
        if same and np.array_equal(now.score, last.score):
            found.append(index)
    return found


def same_person(pixel: Array, fps: float, doubted: Collection[int] = ()) -> BoolArray:
    """(F,) which frames of one path (F, N, 2) [px] show the person whom most of it shows; NaN is not seen.

    The path is cut where the whole body jumps. Of the pieces those are kept that a person can have gone
    through one after the other and that have the most frames. `doubted` are frames in which the picture shows
    nobody there: a piece in which they are most of the frames that were looked at does not count.
    """
    seen = np.isfinite(pixel).all(axis=-1)
    told = np.flatnonzero(seen.sum(axis=1) > KNOWN * max(seen.sum(axis=1).max(initial=0), 1))
    kept = np.ones(len(pixel), dtype=np.bool_)
    if len(told) < 2:
        return kept
    middle = np.array([np.nanmedian(pixel[frame], axis=0) for frame in told])
    size = float(np.median(person_size(pixel[told])))
    pieces = _pieces(told, middle / size, fps)
    if len(pieces) < 2:
        return kept
    weight = [0.0 if _is_doubted(told[piece], doubted) else float(len(piece)) for piece in pieces]
    best, before = np.array(weight), np.full(len(pieces), -1)
    for later in range(len(pieces)):
        for earlier in range(later):
            first, last = pieces[later][0], pieces[earlier][-1]
            away = float(np.linalg.norm(middle[first] - middle[last])) / size
            time_s = (told[first] - told[last]) / fps
            total = best[earlier] + weight[later]
            if away < JUMP + RUN_PER_S * time_s and total > best[later]:
                best[later], before[later] = total, earlier
    chosen, piece = [], int(best.argmax())
    while piece >= 0:
        chosen += [piece] if weight[piece] else []
        piece = int(before[piece])
    for number, rows in enumerate(pieces):
        if number not in chosen:  # with the frames about it in which little is seen
            end = pieces[number + 1][0] if number + 1 < len(pieces) else None
            kept[told[rows[0]] : None if end is None else told[end]] = False
    return kept


def _is_doubted(frames: Array, doubted: Collection[int]) -> bool:
    """Whether the picture was looked at in such a piece, and shows nobody there."""
    return any(int(frame) in doubted for frame in frames)


def _pieces(frames: Array, middle: Array, fps: float) -> list[Array]:
    """Rows of the pieces without a jump of the middle of the body (G, 2) [sizes of a person]."""
    pieces: list[list[int]] = [[0]]
    speed = np.full(2, np.nan)
    for row in range(1, len(frames)):
        time_s = (frames[row] - frames[row - 1]) / fps
        step = middle[row] - middle[row - 1]
        onward = np.where(np.isfinite(speed), speed, 0.0) * time_s
        if np.linalg.norm(step - onward) > JUMP + RUN_PER_S * time_s:
            pieces.append([])
            speed[:] = np.nan
        else:
            now = step / time_s
            speed = np.where(np.isfinite(speed), SMOOTH * now + (1.0 - SMOOTH) * speed, now)
        pieces[-1].append(row)
    return [np.array(piece) for piece in pieces]
