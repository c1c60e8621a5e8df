"""Fingers: their names, how far they are bent, and how a curl bends their joints.

The *curl* of a finger is the mean flexion of its three joints: each the angle of a bone with the one before,
of the first with the line from the wrist, positive toward the palm. They bend together, as those of relaxed
and of grasping hands do. Fingers are not spread.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..numerics.vectors import unit
from .rotations import cross, hinge, logarithm
from .skeleton import FINGERS

SHARES = np.array([1.08, 1.11, 0.81])
"""Flexions of a finger's joints by its curl, from the knuckle on: of a fist 97, 100 and 73 degrees."""
RELAXED_RAD = np.radians([25.0, 25.0, 28.0, 30.0, 32.0])  # curls of a hand that hangs
THUMB_PAD = (0.5, -0.87)  # where its pad faces, out of the palm and across it toward the thumb
RESTING = {  # axes of a hand at rest, as `palm_axes` has them
    "L": np.diag([1.0, -1.0, -1.0]),
    "R": np.diag([-1.0, -1.0, -1.0]),
}
SHAPES = {
    "thumb": ((0.14, 0.11), (0.86, 0.51), (0.2, 0.15, 0.12)),
    "index": ((0.47, 0.155), (1.0, 0.085), (0.2, 0.13, 0.1)),
    "middle": ((0.48, 0.08), (1.0, -0.03), (0.22, 0.14, 0.12)),
    "ring": ((0.46, -0.055), (1.0, -0.02), (0.21, 0.14, 0.11)),
    "pinky": ((0.41, -0.15), (1.0, -0.06), (0.17, 0.11, 0.09)),
}
"""Of a performer's fingers, as the shipped skin has them, in lengths of the hand: their first joints along
and across it, where they point at rest, and the lengths of their bones (Buryanov & Kotiuk 2010)."""
JOINT = 0.06  # length of skin that bends at a joint
SURE = 0.7  # how far a hand is to be believed that is surely seen: it is taken as it is
WRIST, INDEX, MIDDLE, LITTLE = 0, 5, 9, 17  # and knuckles among the 21 points, four of each finger


@dataclass(frozen=True, eq=False)
class Hands:
    """Left and right hand in F frames, as they are seen."""

    curls: Array  # (F, 2, 5) [rad], relaxed where nothing is seen
    bend: Array  # (F, 2, 3) turn of the hand in the forearm's frame as a rotation vector [rad]
    sure: Array  # (F, 2) how far both are to be believed, 0 to 1

    def __getitem__(self, frames: slice | IndexArray | BoolArray) -> "Hands":
        """Those of some frames."""
        return Hands(self.curls[frames], self.bend[frames], self.sure[frames])


def palm_axes(along: Array, toward_thumb: Array, side: str) -> Array:
    """(..., 3, 3) axes of a hand as columns: along it, across it toward the thumb, out of its palm."""
    along = unit(along)
    across = unit(toward_thumb - (toward_thumb * along).sum(axis=-1, keepdims=True) * along)
    out = cross(along, across) if side == "L" else cross(across, along)
    return np.stack([along, across, out], axis=-1)


def palm_of(points: Array, side: str) -> Array:
    """(..., 3, 3) axes of a hand by its 21 points (..., 21, 3)."""
    along, across = (
        points[..., MIDDLE, :] - points[..., WRIST, :],
        points[..., INDEX, :] - points[..., LITTLE, :],
    )
    return palm_axes(along, across, side)


def flexion_axis(finger: str, along: Array, palm: Array) -> Array:
    """(..., 3) the axis about which a finger (..., 3) bends in a hand of axes (..., 3, 3)."""
    across, out = palm[..., 1], palm[..., 2]
    pad = THUMB_PAD[0] * out + THUMB_PAD[1] * across if finger == "thumb" else out
    return unit(cross(unit(along), pad))


def flexions(bones: Array, axis: Array) -> Array:
    """(..., N - 1) how far each of a finger's bones (..., N, 3) is bent against the one before [rad]."""
    before, after = bones[..., :-1, :], bones[..., 1:, :]
    sine = (cross(before, after) * axis[..., None, :]).sum(axis=-1)
    return np.asarray(np.arctan2(sine, (before * after).sum(axis=-1)))


def curls_of(points: Array) -> Array:
    """(..., 5) curls of a hand's fingers by its 21 points (..., 21, 3) [rad], each in its own plane.

    Networks see that plane better than how it stands on the palm.
    """
    found = []
    for number in range(len(FINGERS)):
        chain = points[..., [WRIST, *range(4 * number + 1, 4 * number + 5)], :]
        bones = unit(np.diff(chain, axis=-2))
        axis = unit(cross(bones[..., :-1, :], bones[..., 1:, :]).sum(axis=-2))
        found.append(flexions(bones, axis).mean(axis=-1))
    return np.stack(found, axis=-1)


# --- A performer's fingers


def finger_bones(side: str) -> Iterator[tuple[str, Array, Array, Array]]:
    """Each bone's name, ends (3,) at rest from the wrist in lengths of the hand, and axis of flexion."""
    palm = RESTING[side]
    for finger, (place, direction, lengths) in SHAPES.items():
        along = palm[:, :2] @ direction / np.hypot(*direction)
        start, axis = palm[:, :2] @ place, flexion_axis(finger, along, palm)
        for number, length in enumerate(lengths, 1):
            yield f"{finger}.{number}.{side}", start, start + length * along, axis
            start = start + length * along


def finger_weights(places: Array, side: str) -> dict[str, Array]:
    """(N,) how far bones move a hand's skin at places (N, 3), from the wrist in lengths of the hand."""
    bones = list(finger_bones(side))
    starts = np.array([start for _, start, *_ in bones[::3]])
    along = unit(np.array([end - start for _, start, end, _ in bones[::3]]))
    flat = (places * [1.0, 1.0, 0.0])[:, None] - starts
    ahead = (flat * along).sum(axis=-1)
    beside = flat - np.clip(ahead, 0.0, None)[..., None] * along
    nearest = np.linalg.norm(beside, axis=-1).argmin(axis=1)
    found: dict[str, Array] = {}
    for number, (name, start, _, _) in enumerate(bones):
        finger = number // 3
        reach = float(np.linalg.norm(start - starts[finger]))
        moved = np.clip((ahead[:, finger] - reach) / JOINT + 0.5, 0.0, 1.0) * (nearest == finger)
        if number % 3:
            found[bones[number - 1][0]] -= moved
        found[name] = moved
    return found


def finger_turns(hands: Hands) -> dict[str, Array]:
    """(F, 3, 3) turn of each bone of the fingers in the frame of the bone before, by name."""
    return {
        name: hinge(axis, SHARES[number % 3] * hands.curls[:, row, number // 3])
        for row, side in enumerate(RESTING)
        for number, (name, _, _, axis) in enumerate(finger_bones(side))
    }


def finger_flexions(turns: Mapping[str, Array]) -> dict[str, Array]:
    """(F, 3) flexions of fingers [rad], by name as `index.L`, of those all of whose bones are turned."""
    found = {}
    for side in RESTING:
        bent = {
            name: logarithm(turns[name]) @ axis for name, _, _, axis in finger_bones(side) if name in turns
        }
        for finger in FINGERS:
            own = [bent[name] for number in (1, 2, 3) if (name := f"{finger}.{number}.{side}") in bent]
            if len(own) == len(SHARES):
                found[f"{finger}.{side}"] = np.stack(own, axis=-1)
    return found


FINGER_BONES = tuple(name for side in RESTING for name, *_ in finger_bones(side))
