"""Dragging a joint: the limb, or what else carries it, follows so that the joint lies where it should."""

from collections.abc import Mapping, Sequence

import numpy as np

from ..arrays import Array, IndexArray
from ..body.human import TRUNK, limb_of
from ..body.kinematics import Body
from ..body.mirror import other_side
from ..body.posture import Posture
from ..body.skeleton import SIDES
from ..estimate.performer_placement import SHOE_M, standing_ankle_m
from ..prior.keyframes import Keyframe, interpolate
from .inverse_kinematics import Pull, pulled
from .limb_chain import LimbChain

HELD_M = 0.05  # joints that should stay where they are, but may give way to the dragged one
HIPS = ("hip.L", "hip.R")
LEVEL = 0.1  # sine of the angle below the horizon under which a view looks level: depth tells no height
RAISES = 3  # times that a joint is brought to the floor along its sight, then as often straight up


def dragged(
    body: Body,
    posture: Posture,
    point: str,
    place: Array,
    sight: Array,
    pushed: bool = False,
    floor_m: float | None = None,
) -> Posture:
    """A posture with one joint dragged to a place; lengths are exact, and joint limits are springs.

    Wrists and ankles bend the limb, elbows and knees swing it about where wrist and ankle are, shoulders lean
    and turn the trunk over the feet, the head nods, and hips take the whole body along. All else stays.

    Seen along `sight`, the unit direction (3,) in which the view looks, the joint called `point` comes to lie
    on `place` (3,) [m]; in depth it comes as near as lengths allow. Where it is `pushed` along the line of
    sight, depth counts as much as the image. No ankle is dragged through a known floor: it stops there on its
    line of sight, or above where the view looks level.

    Raises:
        KeyError: The joint is no principal point.
    """
    moved = _dragged(body, posture, point, place, sight, pushed)
    stem, _, side = point.partition(".")
    carried = SIDES if stem == "hip" else (side,) if stem in ("knee", "ankle") else ()
    if floor_m is None or not carried:
        return moved
    ankles = [body.skeleton.point_names.index(f"ankle.{side}") for side in carried]
    least = floor_m + standing_ankle_m(body) - SHOE_M
    steep = -float(sight[2])
    for attempt in range(2 * RAISES):
        below = least - float(body.points(body.pose(moved))[ankles, 2].min())
        if below <= 0.0:
            break
        nearer = steep > LEVEL and attempt < RAISES  # as long as reach allows
        place = place + below * (-sight / steep if nearer else np.array([0.0, 0.0, 1.0]))
        moved = _dragged(body, posture, point, place, sight, pushed)
    return moved


def _dragged(body: Body, posture: Posture, point: str, place: Array, sight: Array, pushed: bool) -> Posture:
    start = dict(zip(body.skeleton.point_names, body.points(body.pose(posture)), strict=True))
    if point in HIPS:
        shift = np.zeros(body.skeleton.dof_count)
        shift[:3] = place - start[point]
        return posture.plus(shift)
    # Under the mouse it is less than a pixel of any footage off; depth gives way where not both is possible.
    pulls = [Pull(point, place, 0.01) if pushed else Pull(point, place, 0.001, sight, 0.03)]
    part = limb_of(point)
    if part != TRUNK:
        limb = LimbChain.of(body, part)
        root, middle, end = limb.points
        if point != end:
            pulls.append(Pull(end, start[end], HELD_M))
        # A straight limb would not know which way to bend.
        begin = {middle: 0.15} if abs(float(posture.angles[limb.hinge])) < 0.15 else {}
        return pulled(body, posture, pulls, {root: 1.0, middle: 1.0}, begin)
    if point == "head":
        return pulled(body, posture, pulls, {"neck": 1.0, "waist": 0.1})
    _, _, side = point.partition(".")
    legs = {f"{joint}.{each}": 1.0 for joint in ("hip", "knee") for each in ("L", "R")}
    pulls += [Pull(other_side(point), start[other_side(point)], HELD_M), *planted(start)]
    # Most of a bend is above the waist.
    free = {"pelvis": 0.3, "waist": 0.5, **legs, f"girdle.{side}": 0.1}
    return pulled(body, posture, pulls, free)


def paths_through(
    body: Body,
    keyframes: Sequence[Keyframe],
    index: int,
    posture: Posture,
    point: str,
    frames: IndexArray,
) -> Array:
    """(2, I, 3) path of a point [m] at `frames` (I,) between keyframes, and with a posture at `index`."""
    rest = [each for each in keyframes if each.index != index]
    changed = sorted([*rest, Keyframe(index, posture)], key=lambda each: each.index)
    row = body.skeleton.point_names.index(point)
    between = [interpolate(tuple(each), int(frames[-1]) + 1)[frames] for each in (keyframes, changed)]
    return np.stack([body.points(body.pose(each))[:, row] for each in between])


def planted(start: Mapping[str, Array]) -> list[Pull]:
    """What holds the legs where they are, by the places (3,) of all points."""
    held = [("ankle", 0.005), ("knee", HELD_M)]
    return [
        Pull(f"{stem}.{side}", start[f"{stem}.{side}"], std_m) for stem, std_m in held for side in ("L", "R")
    ]
