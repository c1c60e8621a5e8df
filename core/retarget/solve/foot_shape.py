"""The shape of a character's foot: its sole at rest, and the places about which it rolls."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ...arrays import Array
from ...body.body_volume import HEEL_BEHIND, sole_offsets
from ...body.kinematics import SegmentMotion
from ...body.skeleton import SIDES
from ...finish.contacts import STRAY_M, Contact, find_contacts
from ...finish.foot_ground import smooth_above
from .rest_body import RestBody

TOE_ROOM = 0.05
"""Largest height of the lowest joint or toe over the armature's origin, as a share of the leg, at which the
origin is the ground that the character stands on."""
ANKLE_ROOM = 0.12  # the same where nothing is known of the foot but its ankle
TOE_THICKNESS = 0.02  # height of joints at the toes over the sole, as a share of the leg
ANKLE_HEIGHT = 0.08
"""Height of the ankle over the sole, as a share of the leg: 0.039 of a stature of which the leg is 0.49
(Winter 2009, *Biomechanics and Motor Control of Human Movement*)."""


@dataclass(frozen=True, eq=False)
class FootShape:
    """A foot at rest, in canonical axes."""

    foot: Array  # (N, 3) points of the sole fixed to the foot, from the ankle [m]
    toe: Array  # (M, 3) points fixed to the toe bone, from its joint [m]; none without one
    toe_joint: Array | None  # (3,) the toe's joint from the ankle [m]; None without one
    front: Array
    """(3,) where it rolls when the heel rises, from the ankle [m]: the ball; the tip without a toe."""
    heel: Array  # (3,) where it rolls when the toes rise, from the ankle [m]

    @property
    def ankle_m(self) -> float:
        """Height of the resting ankle over the ground [m]."""
        return float(-self.foot[:, 2].min())


def rest_floor_m(body: RestBody) -> float:
    """Height of the ground that the resting character stands on, along canonical up [m]."""
    soles = [point for points in body.character_map.soles.values() for point in points]
    if soles:
        return float((body.character.scale * np.array(soles) @ body.stance.T)[:, 2].min())
    ankles = [body.joint(f"foot.{side}") for side in SIDES]
    below = [point for side in SIDES for point in _beyond_ankle(body, side)]
    lowest = float(min(point[2] for point in (*ankles, *below)))
    room, thickness = (TOE_ROOM, TOE_THICKNESS) if below else (ANKLE_ROOM, ANKLE_HEIGHT)
    if 0.0 <= lowest <= room * body.leg_m:
        return 0.0
    return lowest - thickness * body.leg_m


def foot_shape(body: RestBody, side: str, floor_m: float) -> FootShape:
    """The foot of a side at rest on ground of some height [m], from the map's soles or from the bones."""
    ankle = body.joint(f"foot.{side}")
    toe = body.joint(f"toe.{side}") if body.is_moved(f"toe.{side}") else None
    soles = body.character_map.soles
    given = {
        part: np.asarray(body.character.scale * np.array(soles[f"{part}.{side}"]) @ body.stance.T)
        for part in ("foot", "toe")
        if f"{part}.{side}" in soles
    }
    if "foot" not in given:
        given = _sole_of_bones(body, side, ankle, toe, floor_m)
    foot = given["foot"] if toe is not None or "toe" not in given else np.concatenate(list(given.values()))
    ahead = _ahead(foot - ankle if toe is None else (toe - ankle)[None])
    front = foot[np.argmax((foot - ankle) @ ahead)] if toe is None else toe
    heel = foot[np.argmin((foot - ankle) @ ahead)]
    middle, low = ankle + ((heel - ankle) @ ahead) * ahead, float(foot[:, 2].min())
    front, heel = (np.array([place[0], place[1], low]) - ankle for place in (front, middle))
    none = np.empty((0, 3))
    if toe is None:
        return FootShape(foot - ankle, none, None, front, heel)
    return FootShape(foot - ankle, given.get("toe", none) - toe, toe - ankle, front, heel)


def sole_points(body: RestBody, shapes: Mapping[str, FootShape]) -> dict[str, Array]:
    """(N, 3) by role of foot and toe: the sole at rest in the armature's space and units."""
    found = {}
    for side, shape in shapes.items():
        ankle = body.joint(f"foot.{side}")
        found[f"foot.{side}"] = ankle + shape.foot
        if shape.toe_joint is not None and len(shape.toe):
            found[f"toe.{side}"] = ankle + shape.toe_joint + shape.toe
    return {role: points @ body.stance / body.character.scale for role, points in found.items()}


def _sole_of_bones(
    body: RestBody, side: str, ankle: Array, toe: Array | None, floor_m: float
) -> dict[str, Array]:
    """Heel, ball and tip on the ground, inside and outside, by part."""
    tip = _tip(body, side, ankle, toe)
    along = (tip - ankle) * [1.0, 1.0, 0.0]
    length = float(np.linalg.norm(along))
    ahead = along / length
    # Half-width of a sole, as a share of the length from ankle to tip.
    across = 0.2 * length * np.array([-ahead[1], ahead[0], 0.0])
    heel = ankle - HEEL_BEHIND * length * ahead
    ball = ankle + 0.6 * length * ahead if toe is None else toe
    parts = {"foot": [heel + 0.7 * across, heel - 0.7 * across, ball + across, ball - across], "toe": [tip]}
    return {part: np.stack(points) * [1.0, 1.0, 0.0] + [0.0, 0.0, floor_m] for part, points in parts.items()}


def _tip(body: RestBody, side: str, ankle: Array, toe: Array | None) -> Array:
    if toe is not None:
        ball = (toe - ankle) * [1.0, 1.0, 0.0]
        tip = body.tip(f"toe.{side}")
        if tip is not None and (tip - toe) @ ball > 0.0:
            return tip
        # Length of the toes, as a share of that from ankle to ball, where no bone tells.
        return np.asarray(toe + 0.4 * ball)
    beyond = [point for point in _beyond_ankle(body, side) if point[1] < ankle[1]]
    if beyond:
        return min(beyond, key=lambda point: float(point[1]))
    # Length from ankle to toe tip along the ground, as a share of the leg, where no bone tells.
    return np.asarray(ankle + 0.21 * body.leg_m * np.array([0.0, -1.0, 0.0]))


def _beyond_ankle(body: RestBody, side: str) -> list[Array]:
    """Joints below the ankle, and ends of bones where those mean something, canonical [m]."""
    character = body.character
    roles = [role for role in (f"foot.{side}", f"toe.{side}") if role in body.last]
    open_ = [character.index[body.bones[body.last[role]].name] for role in roles]
    found: list[Array] = []
    while open_:
        index = open_.pop()
        bone = character.bones[index]
        if bone.name != body.bones[body.first[f"foot.{side}"]].name:
            found.append(bone.head)
        if body.tails_are_meant and not character.children[index]:
            found.append(bone.tail)
        open_ += character.children[index]
    return [character.scale * body.stance @ point for point in found]


def _ahead(ways: Array) -> Array:
    """(3,) the level direction of the way that leads farthest."""
    level = ways * [1.0, 1.0, 0.0]
    longest = level[np.linalg.norm(level, axis=-1).argmax()]
    length = float(np.linalg.norm(longest))
    return longest / length if length > 1e-6 else np.array([0.0, -1.0, 0.0])


# --- The ground under a performer


SAME_LEVEL_M = 0.03
"""Rests whose heights follow each other within this are on one level: the noise of an estimate."""
SCENE_GROUND_M = 0.025
"""A level that near to the scene's ground, z = 0, is it: no ankle's height over its sole is known better."""
CHANGE_S = 0.15
"""Time in which the ground under a moving foot changes its height, after a rest and before the next one."""


@dataclass(frozen=True, eq=False)
class Ground:
    """The ground under a performer's feet."""

    rests: tuple[Contact, ...]  # rests of the ankles; points are counted left, right
    height_m: Array  # (F, 2) height of the ground under the left and the right foot [m]
    ankle_m: float  # height of a resting ankle over the ground [m]

    @property
    def lowest_m(self) -> Array:
        """(F,) the lower of both heights [m]."""
        return np.asarray(self.height_m.min(axis=1))


def find_ground(source: SegmentMotion) -> Ground:
    """Find the ground under a performer."""
    ankles = np.stack([source.start[f"foot.{side}"] for side in SIDES], axis=1)
    rests = find_contacts(ankles, source.time_s, STRAY_M)
    depth = np.stack([_depth_m(source, side) for side in SIDES], axis=1)
    flat = float(-sole_offsets(source.body)[..., 2].min(axis=1).mean())
    if not rests:
        # Percentile of the ankles' heights that stands for rest where no foot rests.
        low = float(np.percentile(ankles[..., 2].min(axis=1), 5.0))
        level = _level_m(low - flat)
        return Ground((), np.full(ankles.shape[:2], level), max(low - level, 0.5 * flat))
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
    return Ground(rests, under, float(np.median(standing)) if standing else flat)


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
        # A slope is no level.
        if np.ptp(heights[group]) <= 0.05:
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
