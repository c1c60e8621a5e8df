"""The ground under both feet, by where they rest: levels, the way between them, and feet that are in it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array, BoolArray
from ..errors import frames_in_words
from ..numerics.vectors import runs
from .contacts import Contact
from .fading import smooth_above

SAME_LEVEL_M = 0.03
"""Rests whose heights follow each other within this are on one level: the noise of an estimate."""
SCENE_GROUND_M = 0.025
"""A level that near to the scene's ground, z = 0, is it: no ankle's height over its sole is known better."""
CHANGE_S = 0.15
"""Time in which the ground under a moving foot changes its height, after a rest and before the next one."""


@dataclass(frozen=True, eq=False)
class Ground:
    """The ground under both feet in F frames."""

    rests: tuple[Contact, ...]  # rests of the ankles; points are counted left, right
    on_toes: BoolArray  # (N,) whether the foot rests on its toes
    height_m: Array  # (F, 2) height of the ground under the left and the right foot [m]
    ankle_m: float  # height of a resting ankle over the ground [m]

    @property
    def lowest_m(self) -> Array:
        """(F,) the lower of both heights [m]."""
        return np.asarray(self.height_m.min(axis=1))


def find_ground(
    ankles: Array,
    depth_m: Array,
    flat_m: float,
    time_s: Array,
    rests: Sequence[Contact],
    on_scene: bool = False,
) -> Ground:
    """Find the ground under both feet.

    `ankles` (F, 2, 3) are their places, `depth_m` (F, 2) that of the lowest point of the sole below the
    ankle, `flat_m` the same of a foot that lies flat. With `on_scene` rests on one level are at one height,
    and those near the scene's ground on it.
    """
    soles = ankles[..., 2] - depth_m
    if not rests:
        # Percentile of the ankles' heights that stands for rest where no foot rests.
        low = float(np.percentile(ankles[..., 2].min(axis=1), 5.0))
        level = 0.0 if on_scene and abs(low - flat_m) <= SCENE_GROUND_M else low - flat_m
        height = np.full(soles.shape, level)
        return Ground((), np.zeros(0, dtype=bool), height, max(low - level, 0.5 * flat_m))
    own = np.array([np.median(soles[rest.frames, rest.point]) for rest in rests])
    places = np.array([rest.place for rest in rests])
    # Distance on the ground within which two rests are on one floor: the higher one is on the toes.
    here = np.linalg.norm(places[:, None, :2] - places[:, :2], axis=-1) < 0.12
    lowest = np.where(here, own, np.inf).argmin(axis=1)
    on_toes = own - own[lowest] >= SAME_LEVEL_M
    levels = np.where(on_toes, own[lowest], own)
    if on_scene:
        levels = _leveled(levels)
    height = np.stack([_under(point, rests, levels, time_s) for point in range(2)], axis=1)
    # Where a sole is clearly lower than where it rests, the ground is no higher than it: a step down without
    # a rest. Not so under the scene's own ground.
    for under, sole in zip(height.T, soles.T, strict=True):
        least = np.maximum(SAME_LEVEL_M - smooth_above(-sole, time_s, CHANGE_S), 0.0)
        under[:] = np.where(under > 0.0, np.minimum(under, least), under)
    flat = places[:, 2] - own < 1.2 * flat_m
    ankle_m = float(np.median((places[:, 2] - levels)[flat])) if flat.any() else flat_m
    return Ground(tuple(rests), on_toes, height, ankle_m)


def _leveled(heights: Array) -> Array:
    """Heights of rests (N,), those on one level made equal, and 0 on the scene's ground [m]."""
    order = np.argsort(heights)
    levels = np.array(heights)
    for group in np.split(order, np.flatnonzero(np.diff(heights[order]) > SAME_LEVEL_M) + 1):
        # A slope is no level.
        if np.ptp(heights[group]) <= 0.05:
            levels[group] = heights[group].mean()
    return np.where(np.abs(levels) <= SCENE_GROUND_M, 0.0, levels)


def _under(point: int, rests: Sequence[Contact], levels: Array, time_s: Array) -> Array:
    """(F,) height of the ground under one foot: at each rest its own, between two levels the lower one.

    Before its first rest and after its last the other foot's rests tell.
    """
    own = [rest for rest in rests if rest.point == point]
    first = min((rest.first for rest in own), default=len(time_s))
    last = max((rest.last for rest in own), default=-1)
    known = [
        (rest, float(level))
        for rest, level in zip(rests, levels, strict=True)
        if rest.point == point or rest.last < first or rest.first > last
    ]
    times: list[float] = []
    heights: list[float] = []
    for rest, level in sorted(known, key=lambda pair: pair[0].first):
        start, end = float(time_s[rest.first]), float(time_s[rest.last])
        if times and abs(level - heights[-1]) > SAME_LEVEL_M:
            low, before = min(level, heights[-1]), times[-1]
            change = min(CHANGE_S, 0.5 * (start - before))
            times += [before + change, start - change]
            heights += [low, low]
        times += [start, end]
        heights += [level, level]
    return np.interp(time_s, np.maximum.accumulate(times), heights)


# --- Feet that are in the ground all the same


IN_FLOOR_M = 0.002
"""Depth from which a foot counts as below the floor, at a performer's size [m]: more than key reduction may
make of it."""


def floor_notes(
    depth_m: Mapping[str, Array], frames: Array, whose: str = "", size: float = 1.0
) -> tuple[str, ...]:
    """Sentences, without a full stop, on feet that are in the floor: which, how deep, and in which frames.

    Depths (F,) are by side, negative above the floor; `whose` follows the foot, and `size` is the body's over
    a performer's.
    """
    notes = []
    for side, depth in depth_m.items():
        deep = runs(depth > size * IN_FLOOR_M)
        if deep:
            longest = sorted(deep, key=lambda run: -float(depth[slice(*run)].max()))[:3]
            named = frames_in_words([frame for run in sorted(longest) for frame in frames[slice(*run)]])
            more = f" and {len(deep) - 3} more times" if len(deep) > 3 else ""
            notes.append(
                f"The {'left' if side == 'L' else 'right'} foot{whose} is up to "
                f"{1000.0 * float(depth.max()):.3g} mm below the floor, in {named}{more}"
            )
    return tuple(notes)
