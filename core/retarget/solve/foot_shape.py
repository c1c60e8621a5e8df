"""The shape of a character's foot: its sole at rest, and the places about which it rolls."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ...arrays import Array
from ...body.body_volume import HEEL_BEHIND, sole_offsets
from ...body.kinematics import SegmentMotion
from ...body.skeleton import SIDES
from ...feet.contacts import find_contacts
from ...feet.ground import Ground, find_ground
from .rest_body import RestBody


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
