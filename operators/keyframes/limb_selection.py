"""Parts of the body by the bones that are selected of an actor."""

import bpy

from ...core.body.limbs import TRUNK, limb_of
from ..shell.takes import find_take

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
