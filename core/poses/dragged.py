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
from .inverse_kinematics import Pull, SightLine, pulled
from .limb_chain import LimbChain, swing

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

    Args:
        body: The actor's body.
        posture: A single posture.
        point: Name of the principal point that is dragged; KeyError for another.
        place: (3,) where to [m].
        sight: (3,) unit direction in which the view looks there. Seen along it the joint comes to lie on
            `place`; in depth it comes as near as lengths allow.
        pushed: Whether it is dragged along the line of sight: then depth counts as much as the image.
        floor_m: Height of the floor [m], through which no ankle is dragged: it stops there on its line of
            sight, or above where the view looks level. None where it is not known.
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
    part = limb_of(point)
    if part != TRUNK:
        return _limb_dragged(posture, LimbChain.of(body, part), point, place, sight, pushed)
    pulls = [_pull(point, place, sight, pushed)]
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


def _pull(point: str, place: Array, sight: Array, pushed: bool) -> Pull:
    if pushed:  # along the line of sight it comes as near as it can, off it or on it
        return Pull(point, place, 0.01)
    # Under the mouse it is less than a pixel of any footage off; depth gives way where not both is possible.
    return Pull(point, place, 0.001, sight, 0.03)


def _limb_dragged(
    posture: Posture, limb: LimbChain, point: str, place: Array, sight: Array, pushed: bool
) -> Posture:
    """The posture with a limb whose middle or end was dragged."""
    body, places, (upper, lower) = limb.body, limb.places(posture), limb.lengths_m
    root, before, held = places
    line = SightLine(place, sight)
    if point == limb.points[2]:
        most_bent = float(limb.limits[3, 1])
        reach = float(np.sqrt(upper**2 + lower**2 + 2.0 * upper * lower * np.cos(most_bent))), upper + lower
        end = line.within(place, root, reach)
        if pushed:
            end = _on_sphere(place, root, float(np.clip(np.linalg.norm(place - root), *reach)))
        # Direction in the world to which the limb's middle comes out when it bends.
        out = -(body.pose(posture).rotation[limb.above] @ posture.rotations[limb.ball] @ limb.rest[:, 1])
        middle = _bent(places, limb.lengths_m, end, out)
        pulls = [_pull(point, end, sight, pushed)]
    else:
        middle = _on_sphere(place, root, upper) if pushed else _swung_about(places, limb.lengths_m, line)
        end = middle + lower * (held - middle) / max(float(np.linalg.norm(held - middle)), 1e-9)
        pulls = [_pull(point, middle, sight, pushed), Pull(limb.points[2], held, HELD_M)]
    moved = limb.aimed(posture, middle, end)
    if (np.abs(limb.excess_rad(moved)) <= np.abs(limb.excess_rad(posture)) + 1e-9).all():
        return moved
    free = {limb.points[0]: 1.0, limb.points[1]: 1.0}
    return pulled(body, moved, pulls, free, allowed=posture)


def _on_sphere(place: Array, center: Array, radius_m: float) -> Array:
    """The place nearest to one at a distance from a center."""
    return np.asarray(center + radius_m * (place - center) / max(float(np.linalg.norm(place - center)), 1e-9))


def _swung_about(places: Array, lengths: tuple[float, float], line: SightLine) -> Array:
    """Where a limb's middle lies on a line of sight: on the side of its root where it was.

    Where it was on neither, on the side where its end can stay more nearly where it is.
    """
    root, before, end = places
    near, far = line.at_distance(root, lengths[0])
    depth = float((before - root) @ line.direction)
    if abs(depth) > 0.01:
        return np.asarray(far if depth > 0.0 else near)
    choices = sorted((near, far), key=lambda each: abs(float(np.linalg.norm(end - each)) - lengths[1]))
    return np.asarray(choices[0])


def _bent(places: Array, lengths: tuple[float, float], end: Array, out: Array) -> Array:
    """Where the middle of a limb lies with its end elsewhere: on the side where it was, swung along."""
    root, middle, before = places
    upper, lower = lengths
    reach = float(np.linalg.norm(end - root))
    axis = (end - root) / max(reach, 1e-9)
    turn = swing(before - root, end - root)
    along = (reach**2 + upper**2 - lower**2) / (2.0 * max(reach, 1e-9))
    aside = turn @ (middle - root)
    aside = aside - (aside @ axis) * axis
    if np.linalg.norm(aside) < 1e-3 * upper:  # sine of a bend below which a limb's middle lies on no side
        aside = turn @ out
        aside = aside - (aside @ axis) * axis
    off = np.sqrt(max(upper**2 - along**2, 0.0))
    return np.asarray(root + along * axis + off * aside / max(float(np.linalg.norm(aside)), 1e-9))
