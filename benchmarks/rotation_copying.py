"""What people do without Keymark: Copy Rotation constraints from the actor to the character, then a bake.

Each role's first bone copies the local rotation of the actor's bone, turned into its own axes (*Local Space
(Owner Orientation)*), and the hips copy the actor's place. Nothing else is known: no rest pose, no floor, no
reach.
"""

from contextlib import AbstractContextManager

import bpy
from keymark.core.retarget.character_map import CharacterMap
from keymark.core.retarget.roles import LIMBS

ACTORS_BONES = {
    "hips": "pelvis",
    "head": "head",
    **{
        role: role.replace("shoulder", "girdle")
        for roles in LIMBS.values()
        for role in roles
        if not role.startswith("toe")
    },
}
"""The actor's bone for each role; the chest is the last of the spine."""


def copy_rotations(
    actor: bpy.types.Object, character: bpy.types.Object, character_map: CharacterMap, frames: tuple[int, int]
) -> bpy.types.Action:
    """Bake a character's motion by constraints alone; returns its Action, a key on every frame and channel.

    Args:
        actor: The actor, which shows its motion.
        character: The armature object; its controls in FK.
        character_map: Which bones play which role.
        frames: First and last scene frame.
    """
    pairs = {role: character_map.bone(role) for role in ACTORS_BONES}
    bones = {ACTORS_BONES[role]: bone for role, bone in pairs.items() if bone is not None}
    spine = character_map.bones("spine")
    if spine:
        bones["chest"] = spine[-1]
    for source, bone in bones.items():
        constraint = character.pose.bones[bone].constraints.new("COPY_ROTATION")
        constraint.target, constraint.subtarget = actor, source
        constraint.owner_space, constraint.target_space = "LOCAL", "LOCAL_OWNER_ORIENT"
    hips = character.pose.bones[bones["pelvis"]].constraints.new("COPY_LOCATION")
    hips.target, hips.subtarget = actor, "pelvis"
    with _only(character):
        bpy.ops.nla.bake(
            frame_start=frames[0],
            frame_end=frames[1],
            only_selected=False,
            visual_keying=True,
            clear_constraints=True,
            use_current_action=False,
            bake_types={"POSE"},
        )
    return character.animation_data.action


def _only(character: bpy.types.Object) -> AbstractContextManager[None]:
    for other in bpy.context.view_layer.objects:
        other.select_set(other == character)
    bpy.context.view_layer.objects.active = character
    return bpy.context.temp_override(
        object=character, active_object=character, selected_objects=[character], mode="OBJECT"
    )
