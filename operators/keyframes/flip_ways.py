"""Parts of the body by the bones that are selected of an actor."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import bpy
import numpy as np

from ...core.body.human import TRUNK, limb_of
from ..shell.takes import find_take

if TYPE_CHECKING:
    from ...core.body.kinematics import Body
    from ...core.body.posture import Posture
    from ...core.camera.camera import Camera


TITLES = {
    "arm.L": "Left Arm",
    "arm.R": "Right Arm",
    "leg.L": "Left Leg",
    "leg.R": "Right Leg",
    TRUNK: "Trunk",
}
"""Names of the parts of the body, the performer's own left and right."""


def selected_limbs(take: bpy.types.PropertyGroup) -> list[str]:
    """The parts of the body of which a bone is selected, in the order of `TITLES`; the active one alone.

    With all bones of the actor selected, as by A, nothing is meant in particular but the active bone.
    """
    bones = take.armature.pose.bones
    chosen = {limb_of(bone.name) for bone in bones if _is_selected(bone)}
    active = take.armature.data.bones.active
    if len(chosen) == len(TITLES):
        return [limb_of(active.name)] if active is not None else []
    return [name for name in TITLES if name in chosen]


def limb_selected(context: bpy.types.Context) -> str | None:
    """A bone of the actor is selected in Pose Mode."""
    take = find_take(context.scene)
    if take is None or take.armature is None:
        return None  # another requirement's
    if take.armature.mode != "POSE" or not selected_limbs(take):
        return "Select a bone of an arm, a leg or the trunk in Pose Mode first"
    return None


def _is_selected(bone: bpy.types.PoseBone) -> bool:
    # Blender 5.0 moved the selection from bones to pose bones.
    return bool(bone.select if hasattr(bone, "select") else bone.bone.select)


SAME = 1e-3  # Difference of postures that comes from the precision of bones alone [m, rad]


@dataclass(frozen=True, eq=False)
class Ways:
    """A posture and the ways to flip it, the most plausible first."""

    key: tuple[int, float, str]  # Number of the armature in this session, scene frame, part of the body
    postures: "tuple[Posture, ...]"  # The first is the one that was flipped


_last: dict[str, Ways] = {}  # The last ways by part of the body


def next_way(
    armature_object: bpy.types.Object,
    frame: float,
    limb: str,
    body: "Body",
    posture: "Posture",
    camera: "Camera",
) -> "tuple[Posture, int, int] | None":
    """The way after the one that is shown, from the last back to the first; None where there is no other.

    Returns:
        The posture, its number among the others from 1 (0 for the posture at first), and how many others
        there are.
    """
    from ...core.posing.depth_flip import flipped

    key = armature_object.session_uid, frame, limb
    ways = _last.get(limb)
    shown = None if ways is None or ways.key != key else _shown(ways, posture)
    if ways is None or shown is None:
        ways, shown = Ways(key, (posture, *flipped(body, posture, camera, limb))), 0
        _last[limb] = ways
    count = len(ways.postures)
    if count == 1:
        return None
    following = (shown + 1) % count
    return ways.postures[following], following, count - 1


def _shown(ways: Ways, posture: "Posture") -> int | None:
    """Which of the ways a posture is; None where it is none of them."""
    apart = [float(np.abs(posture.minus(way)).max()) for way in ways.postures]
    nearest = int(np.argmin(apart))
    return nearest if apart[nearest] < SAME else None
