"""Feet: how they are turned, and where their ankles go so that resting feet stand and none is in the ground.

A resting foot lies flat and stands still. Before the rest the heel stands still while the toes come down,
after it the ball of the foot (its tip, where it has no toe bone) while the heel rises. What that changes
fades to either side.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from ...arrays import Array, BoolArray
from ...body import rotations
from ...body.body_volume import sole_offsets
from ...body.posture import UP
from ...body.skeleton import SIDES
from ...feet.contacts import RELEASE_SPEED_M_S, Contact, speeds
from ...feet.fading import Hold, ease, faded, held_turns, smooth_above
from .foot_shape import FootShape
from .stage import Stage
from .two_bone import LimbPose

TOUCHING_M = (0.01, 0.04)  # height of a toe tip on the ground, and of one in the air
MOST_TOE_BEND_RAD = np.radians(75.0)
ACROSS = np.eye(3)[0]  # canonical axis about which feet and toes pitch


@dataclass(frozen=True, eq=False)
class FootPath:
    """A foot over F frames."""

    turn: Array  # (F, 3, 3) turn of the foot from its rest, canonical
    ankle: Array  # (F, 3) where the ankle shall be [m]
    planted: BoolArray  # (F,) whether the ankle must get there: the foot stands on the ground
    over_m: Array  # (F,) how much higher that is than with the sole on the ground [m]
    ground_m: Array  # (F,) height of the ground under it [m]


def plan_foot(stage: Stage, shape: FootShape, side: str, leg: LimbPose, lift_m: Array | float) -> FootPath:
    """The path of a foot, from the leg by the performer's directions, on ground raised by `lift_m` (F,)."""
    point, time_s, ankle = SIDES.index(side), stage.source.time_s, leg.end
    ground_m = stage.heights(stage.ground.height_m[:, point]) + lift_m
    turn = _rolled(stage, shape, side, ankle[:, 2] - ground_m)
    rests = [rest for rest in stage.ground.rests if rest.point == point]
    stands = []
    for rest in rests:  # the turn throughout a rest: its mean, flat where it nearly is
        mean = Rotation.from_matrix(turn[rest.frames]).mean().as_matrix()
        # Tilts up to which a resting sole lies flat, and from which it stays as it is (on tiptoe, kneeling).
        flat = 1.0 - ease(np.arccos(np.clip(mean[2, 2], -1.0, 1.0)), *np.radians([15.0, 30.0]))
        upright = rotations.logarithm(rotations.smallest(mean[:, 2], UP))
        stands.append(rotations.exponential(flat * upright) @ mean)
    turn = held_turns(turn, rests, stands, time_s)
    # Depth of the foot's lowest point under the ankle, the toes bent up as far as they bend.
    points = shape.foot
    if shape.toe_joint is not None:
        toe = shape.toe_joint + shape.toe @ rotations.hinge(ACROSS, np.array(-MOST_TOE_BEND_RAD)).T
        points = np.concatenate([points, toe])
    depth_m = -(turn[:, 2] @ points.T).min(axis=1)
    planted = np.zeros(len(time_s), dtype=bool)
    holds = []
    for rest, stand, (first, last) in zip(rests, stands, _rolls(stage, side, rests), strict=True):
        # The place of the rest is the mean of where the leg's directions put the ankle. Frames in which the
        # leg is nearly straight count more: there a knee bends a lot for a little way.
        middle = np.average(leg.end[rest.frames], axis=0, weights=leg.straightness[rest.frames])
        frames, into, out = slice(first, last + 1), slice(first, rest.first), slice(rest.last + 1, last + 1)
        place = ankle.copy()
        place[rest.frames] = middle
        place[into] = middle + stand @ shape.heel - turn[into] @ shape.heel
        place[out] = middle + stand @ shape.front - turn[out] @ shape.front
        place[:, 2] = ground_m + depth_m
        holds.append(Hold(first, (place - ankle)[frames]))
        planted[frames] = True
    path = ankle + faded(holds, time_s)
    path[:, 2] = np.maximum(path[:, 2], ground_m + depth_m)
    return FootPath(turn, path, planted, path[:, 2] - ground_m - depth_m, ground_m)


def floor_lifts(
    depth_m: Array, stands: Sequence[tuple[int, int]], time_s: Array, spare_m: float = 0.0
) -> Array:
    """(F,) smooth lift that brings a foot out of the ground again that is (F,) deep in it [m].

    It is `spare_m` more than that, and the same throughout the frames (first, last) in which the foot stands,
    so that it goes on standing.
    """
    lift = np.where(depth_m > 0.0, depth_m + spare_m, 0.0)
    for first, last in stands:
        lift[first : last + 1] = lift[first : last + 1].max()
    return smooth_above(lift, time_s, 0.1)


def toe_bends(turn: Array, shape: FootShape, height_m: Array) -> Array:
    """(F, 3, 3) turns of the toes, bent up against the foot just as far as the ankle's height demands."""
    if shape.toe_joint is None or not len(shape.toe):
        return turn
    joint_m = height_m + turn[:, 2] @ shape.toe_joint
    bend = np.zeros(len(turn))
    for point in shape.toe:
        bend = np.maximum(bend, -_pitches_to_ground(turn, point, joint_m, toes=1.0))
    bend = np.minimum(bend, MOST_TOE_BEND_RAD)
    return np.asarray(turn @ rotations.hinge(ACROSS, -bend))


def _rolled(stage: Stage, shape: FootShape, side: str, height_m: Array) -> Array:
    """Turns of the foot, pitched so that its front stays on the ground where the performer's does.

    Nowhere is it pitched further than the ground lets it: a larger foot than the performer's lifts its toes.
    """
    source, ground_m = stage.source, stage.ground.height_m[:, SIDES.index(side)]
    own, turn = source.turn[f"foot.{side}"], np.asarray(stage.turn @ source.turn[f"foot.{side}"])
    tip = source.start[f"foot.{side}"] + own @ sole_offsets(source.body)[SIDES.index(side)][1]
    touching = 1.0 - ease(tip[:, 2] - ground_m, *TOUCHING_M)
    # Speeds [m/s] up to which a foot rolls over its tip, and from which it swings over the ground.
    touching *= 1.0 - ease(speeds(tip, source.time_s), 0.4, 1.2)
    rolled = np.clip(_pitches_to_ground(turn, shape.front, height_m, toes=1.0), -np.pi, np.pi)
    # Largest change of pitch for a front that is nearer to the ankle than the performer's: a heel that rises
    # higher than that front allows leaves the ground with it. And for a foot of another shape.
    most_rolled, most_changed = np.radians([20.0, 45.0])
    change = touching * most_rolled * np.tanh(rolled / most_rolled)
    most = np.full(len(turn), np.inf)  # a sole without points before or behind the ankle hits nothing there
    least = -most
    for point in shape.foot:
        toes = 1.0 if point[1] < 0.0 else -1.0
        pitch = _pitches_to_ground(turn, point, height_m, toes)
        most, least = (np.minimum(most, pitch), least) if toes > 0.0 else (most, np.maximum(least, pitch))
    change = np.clip(change, np.minimum(least, most), most)
    return np.asarray(turn @ rotations.hinge(ACROSS, np.clip(change, -most_changed, most_changed)))


def _pitches_to_ground(turn: Array, point: Array, height_m: Array, toes: float) -> Array:
    """(F,) pitches that bring a point to the ground, toes downward (1) or upward (-1); infinite for none."""
    up, (x, y, z) = turn[:, 2], point
    # The height of the point, pitched by p with the toes down, is up·x + a cos(p) + b sin(p).
    a, b = up[:, 1] * y + up[:, 2] * z, up[:, 2] * y - up[:, 1] * z
    ratio = (-height_m - up[:, 0] * x) / np.maximum(np.hypot(a, b), 1e-9)
    # The pitch at which the point is highest, a quarter turn or so from the standing foot.
    highest = toes * ((toes * np.arctan2(b, a) - 0.5 * np.pi) % (2.0 * np.pi) - 1.5 * np.pi)
    pitch = highest + toes * np.arccos(np.clip(ratio, -1.0, 1.0))
    return np.where(ratio < -1.0, toes * np.inf, pitch)


def _rolls(stage: Stage, side: str, rests: Sequence[Contact]) -> list[tuple[int, int]]:
    """First and last frame of each rest together with the roll onto the sole and off it.

    Before a rest the heel stands still on the ground with the toes up, after it the front with the heel up.
    """
    source, ground_m = stage.source, stage.ground.height_m[:, SIDES.index(side)]
    turn, ankle, time_s = source.turn[f"foot.{side}"], source.start[f"foot.{side}"], source.time_s
    heel, tip = (ankle + turn @ offset for offset in sole_offsets(source.body)[SIDES.index(side)])
    # Place of the ball between ankle and tip of the performer's foot.
    ball = ankle + 0.62 * (tip - ankle)
    pitch = turn[:, 2, 1]
    slow = [speeds(path, time_s) < RELEASE_SPEED_M_S for path in (heel, tip, ball)]
    on_heel = slow[0] & (heel[:, 2] - ground_m < TOUCHING_M[1]) & (pitch <= 0.0)
    on_front = (slow[1] | slow[2]) & (tip[:, 2] - ground_m < TOUCHING_M[1]) & (pitch >= 0.0)
    found = []
    for number, rest in enumerate(rests):
        before = rests[number - 1].last if number else -1
        after = rests[number + 1].first if number + 1 < len(rests) else len(time_s)
        # No roll is longer than half a second, or goes beyond the middle of the way to the next rest.
        start, stop = np.searchsorted(time_s, [time_s[rest.first] - 0.5, time_s[rest.last] + 0.5])
        first, last = rest.first, rest.last
        while first > max((before + rest.first) // 2 + 1, int(start)) and on_heel[first - 1]:
            first -= 1
        while last < min((rest.last + after) // 2, int(stop)) - 1 and on_front[last + 1]:
            last += 1
        found.append((first, last))
    return found
