"""Feet: their shape, how they turn, and where ankles go so that resting feet stand and none is in the ground.

A resting foot lies flat and stands still. Before the rest the heel stands still while the toes come down,
after it the ball of the foot (its tip, where it has no toe bone) while the heel rises. What that changes
fades to either side.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from ...arrays import Array, BoolArray
from ...body import rotations
from ...body.body_volume import HEEL_BEHIND, sole_offsets
from ...body.kinematics import SegmentMotion
from ...body.posture import UP
from ...body.skeleton import SIDES
from ...feet.contacts import RELEASE_SPEED_M_S, Contact, find_contacts, speeds
from ...feet.fading import Hold, ease, faded, held_turns, smooth_above
from ...feet.ground import Ground, find_ground
from .rest_body import RestBody, Stage
from .two_bone import LimbPose


@dataclass(frozen=True, eq=False)
class FootShape:
    """A foot at rest, in canonical axes."""

    foot: Array  # (N, 3) points of the sole fixed to the foot, from the ankle [m]
    toe: Array  # (M, 3) points fixed to the toe bone, from its joint [m]; none without one
    toe_joint: Array | None  # (3,) the toe's joint from the ankle [m]; None without one
    front: Array  # (3,) where it rolls when the heel rises: the ball; the tip without a toe [m]
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
    # In shares of the leg: the largest height of the lowest joint or toe over the armature's origin at which
    # that is the ground, and the height of joints at the toes over the sole. Where only the ankle is known,
    # the latter is 0.039 of a stature of which the leg is 0.49 (Winter 2009, *Biomechanics and Motor Control
    # of Human Movement*).
    room, thickness = (0.05, 0.02) if below else (0.12, 0.08)
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
    # Ahead is, on the level, where the way to the ball or a point of the sole leads farthest.
    level = (foot - ankle if toe is None else (toe - ankle)[None]) * [1.0, 1.0, 0.0]
    longest = level[np.linalg.norm(level, axis=-1).argmax()]
    length = float(np.linalg.norm(longest))
    ahead = longest / length if length > 1e-6 else np.array([0.0, -1.0, 0.0])
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
    if toe is not None:
        forward, tip = (toe - ankle) * [1.0, 1.0, 0.0], body.tip(f"toe.{side}")
        if tip is None or (tip - toe) @ forward <= 0.0:
            tip = toe + 0.4 * forward  # usual length of the toes, as a share of that from ankle to ball
    else:
        beyond = [point for point in _beyond_ankle(body, side) if point[1] < ankle[1]]
        # Where no bone shows it, the usual length from ankle to toe tip, as a share of the leg.
        usual = ankle + 0.21 * body.leg_m * np.array([0.0, -1.0, 0.0])
        tip = min(beyond, key=lambda point: float(point[1]), default=usual)
    along = (tip - ankle) * [1.0, 1.0, 0.0]
    length = float(np.linalg.norm(along))
    ahead = along / length
    # Half-width of a sole, as a share of the length from ankle to tip.
    across = 0.2 * length * np.array([-ahead[1], ahead[0], 0.0])
    heel = ankle - HEEL_BEHIND * length * ahead
    ball = ankle + 0.6 * length * ahead if toe is None else toe
    parts = {"foot": [heel + 0.7 * across, heel - 0.7 * across, ball + across, ball - across], "toe": [tip]}
    return {part: np.stack(points) * [1.0, 1.0, 0.0] + [0.0, 0.0, floor_m] for part, points in parts.items()}


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
        if character.tails_are_meant and not character.children[index]:
            found.append(bone.tail)
        open_ += character.children[index]
    return [character.scale * body.stance @ point for point in found]


def performer_ground(source: SegmentMotion) -> Ground:
    """The ground under a performer, whose feet are turned."""
    ankles = np.stack([source.start[f"foot.{side}"] for side in SIDES], axis=1)
    turns = np.stack([source.turn[f"foot.{side}"][:, 2] for side in SIDES], axis=1)
    offsets = sole_offsets(source.body)
    depth_m = -np.einsum("fsi,ski->fsk", turns, offsets).min(axis=-1)
    flat_m = -float(offsets[..., 2].min(axis=1).mean())
    rests = find_contacts(ankles, source.time_s)
    return find_ground(ankles, depth_m, flat_m, source.time_s, rests, on_scene=True)


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
