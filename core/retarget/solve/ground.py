"""The ground under a performer: where feet rest, how high the ground is there, and between.

Nothing says where the floor of the footage is but the performer's own resting soles. Rests on one level are
leveled, steps and beams keep their own height.
"""

from dataclasses import dataclass

import numpy as np

from ...arrays import Array
from ...body.segment_motion import SegmentMotion
from ...body.skeleton import SIDES
from ...body.soles import sole_offsets
from ...finish.contacts import STRAY_M, Contact, find_contacts
from .smoothing import smooth_above

SAME_LEVEL_M = 0.03
"""Rests whose heights follow each other within this are on one level: the noise of an estimate ..."""
LEVEL_RANGE_M = 0.05
"""... if all of them lie within this; a slope is no level."""
SCENE_GROUND_M = 0.025
"""A level that near to the scene's ground, z = 0, is it: no ankle's height over its sole is known better."""
CHANGE_S = 0.15
"""Time in which the ground under a moving foot changes its height, after a rest and before the next one."""
LOW_SHARE = 5.0
"""Percentile of the ankles' heights that stands for rest where no foot rests."""


@dataclass(frozen=True, eq=False)
class Ground:
    """The ground under a performer's feet."""

    rests: tuple[Contact, ...]
    """Rests of the ankles; points are counted left, right."""
    levels_m: tuple[float, ...]
    """Height of the ground at each of them [m]."""
    height_m: Array
    """(F, 2) height of the ground under the left and the right foot [m]."""
    ankle_m: float
    """Height of a resting ankle over the ground [m]."""


def find_ground(source: SegmentMotion) -> Ground:
    """Find the ground under a performer."""
    ankles = np.stack([source.start[f"foot.{side}"] for side in SIDES], axis=1)
    rests = find_contacts(ankles, source.time_s, STRAY_M)
    depth = np.stack([_depth_m(source, side) for side in SIDES], axis=1)
    flat = float(-sole_offsets(source.body)[..., 2].min(axis=1).mean())
    if not rests:
        low = float(np.percentile(ankles[..., 2].min(axis=1), LOW_SHARE))
        level = _level_m(low - flat)
        return Ground((), (), np.full(ankles.shape[:2], level), max(low - level, 0.5 * flat))
    heights = np.array(
        [np.median((ankles[..., 2] - depth)[rest.first : rest.last + 1, rest.point]) for rest in rests]
    )
    levels = _leveled(heights)
    standing = [
        float(np.median(ankles[rest.first : rest.last + 1, rest.point, 2])) - level
        for rest, level, height in zip(rests, levels, heights, strict=True)
        if rest.place[2] - height < 1.2 * flat
    ]
    under = np.stack([_under(number, rests, levels, source.time_s) for number in range(2)], axis=1)
    for number in range(2):
        # Where a sole is clearly lower than where it rests, the ground is no higher than it: a step down
        # without a rest. Not so under the scene's own ground.
        lowest = -smooth_above(depth[:, number] - ankles[:, number, 2], source.time_s, CHANGE_S)
        lowered = np.minimum(under[:, number], lowest + SAME_LEVEL_M)
        under[:, number] = np.where(under[:, number] > 0.0, np.maximum(lowered, 0.0), under[:, number])
    return Ground(rests, tuple(levels), under, float(np.median(standing)) if standing else flat)


def is_rigid(source: SegmentMotion, side: str) -> bool:
    """Whether a foot is only carried along by its shin."""
    return bool(np.allclose(source.turn[f"foot.{side}"], source.turn[f"shin.{side}"], atol=1e-6))


def _depth_m(source: SegmentMotion, side: str) -> Array:
    """(F,) depth of the lowest point of the sole below the ankle [m]."""
    offsets = sole_offsets(source.body)[SIDES.index(side)]
    if is_rigid(source, side):
        return np.full(len(source.time_s), -offsets[:, 2].min())
    return np.asarray(-(source.turn[f"foot.{side}"][:, 2] @ offsets.T).min(axis=1))


def _leveled(heights: Array) -> list[float]:
    """Heights of rests (N,), those on one level made equal [m]."""
    order = np.argsort(heights)
    groups = np.split(order, np.flatnonzero(np.diff(heights[order]) > SAME_LEVEL_M) + 1)
    levels = np.array(heights)
    for group in groups:
        if np.ptp(heights[group]) <= LEVEL_RANGE_M:
            levels[group] = heights[group].mean()
    return [_level_m(float(level)) for level in levels]


def _level_m(height_m: float) -> float:
    """A height, or 0 where it is the scene's ground [m]."""
    return 0.0 if abs(height_m) <= SCENE_GROUND_M else height_m


def _under(point: int, rests: tuple[Contact, ...], levels: list[float], time_s: Array) -> Array:
    """(F,) height of the ground under one foot: at each rest its own, between two the lower one."""
    own = [(rest, level) for rest, level in zip(rests, levels, strict=True) if rest.point == point]
    if not own:
        own = sorted(zip(rests, levels, strict=True), key=lambda pair: pair[0].first)
    times: list[float] = []
    heights: list[float] = []
    for rest, level in own:
        start, end = float(time_s[rest.first]), float(time_s[rest.last])
        if times:
            low, before = min(level, heights[-1]), times[-1]
            change = min(CHANGE_S, 0.5 * (start - before))
            times += [before + change, start - change]
            heights += [low, low]
        times += [start, end]
        heights += [level, level]
    return np.interp(time_s, np.maximum.accumulate(times), heights)
