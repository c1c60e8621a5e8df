"""What people do without Keymark: Copy Rotation constraints from the actor to the character, then a bake.

Each role's first bone copies the local rotation of the actor's bone, turned into its own axes (*Local Space
(Owner Orientation)*), and the hips copy the actor's place. Nothing else is known: no rest pose, no floor, no
reach.
"""

from contextlib import AbstractContextManager

import bpy
from keymark.core.body.kinematics import SegmentMotion
from keymark.core.body.skeleton import SIDES
from keymark.core.retarget.character import LIMBS
from keymark.core.retarget.maps.character_map import CharacterMap
from mathutils import Matrix, Vector

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
        character: The armature object; its controls are switched to FK.
        character_map: Which bones play which role.
        frames: First and last scene frame.
    """
    keyed = {role: [bone for bone in character_map.keyed_bones(role) if bone] for role in character_map.roles}
    bones = {source: keyed[role][0] for role, source in ACTORS_BONES.items() if keyed.get(role)}
    if keyed.get("spine"):
        bones["chest"] = keyed["spine"][-1]
    _set_fk(character, character_map)
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


def _set_fk(character: bpy.types.Object, character_map: CharacterMap) -> None:
    """Switch a control rig to FK, as its settings want it."""
    for setting in character_map.settings:
        character.pose.bones[setting.bone][setting.property] = setting.value
    for controls in character_map.ik.values():
        if controls.switch is not None:
            character.pose.bones[controls.switch.bone][controls.switch.property] = controls.switch.fk
    character.update_tag()
    bpy.context.view_layer.update()


def sized_actor(actor: bpy.types.Object, source: SegmentMotion, size: float) -> None:
    """Scale the actor about the ground under its first frame, so that it is as large as the character."""
    hips = source.start["pelvis"][0]
    floor = min(float(source.end[f"foot.{side}"][:, 2].min()) for side in SIDES)
    pivot = Vector((hips[0], hips[1], floor))
    actor.matrix_world = (
        Matrix.Translation(pivot) @ Matrix.Scale(size, 4) @ Matrix.Translation(-pivot) @ actor.matrix_world
    )
    bpy.context.view_layer.update()


def _only(character: bpy.types.Object) -> AbstractContextManager[None]:
    for other in bpy.context.view_layer.objects:
        other.select_set(other == character)
    bpy.context.view_layer.objects.active = character
    return bpy.context.temp_override(
        object=character, active_object=character, selected_objects=[character], mode="OBJECT"
    )
