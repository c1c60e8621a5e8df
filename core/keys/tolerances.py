"""How far few keys may move what is on the ground: resting feet do not slide, soles do not pass it."""

from collections.abc import Sequence

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..body.skeleton import SIDES
from ..feet.contacts import Contact
from .rig import Rig

# In meters for a body of a performer's size; smaller and larger ones have them in proportion.
FLOOR_M = 0.0015  # largest error of a sole near the floor
RESTING_M = 0.00008  # largest error of a resting foot: it must not slide
NEAR_FLOOR_M = 0.03  # height up to which a sole is near the floor


def point_tolerances(
    rig: Rig,
    frame_count: int,
    tolerance_m: float,
    contacts: Sequence[Contact],
    near_ground: BoolArray | None = None,
) -> Array:
    """(F, P) tolerance of each point of an actor's rig [m], less for resting ankles and soles.

    `near_ground` (F, 2) says where a sole that moves is near the ground.
    """
    allowed = np.full((frame_count, rig.point_slices[-1].stop), tolerance_m)
    if near_ground is not None:
        for side, near in zip(SIDES, near_ground.T, strict=True):
            allowed[np.ix_(near, foot_rows(rig, side)[1:])] = min(FLOOR_M, tolerance_m)
    names = [bone.name for bone in rig.bones]
    for contact in contacts:
        side = SIDES[contact.point]
        ankle = rig.point_slices[names.index(f"shin.{side}")].start + 1
        allowed[contact.frames, [ankle, *foot_rows(rig, side)]] = min(RESTING_M, tolerance_m)
    return allowed


def foot_rows(rig: Rig, side: str) -> IndexArray:
    """Which of a rig's points are those of a foot, joint, heel and tip; none without a bone of its own."""
    for bone, rows in zip(rig.bones, rig.point_slices, strict=True):
        if bone.name == f"foot.{side}":
            return np.arange(rows.start, rows.stop)
    return np.zeros(0, dtype=np.intp)
