"""Giving a bone to a role, as operators and their tooltips share it."""

import bpy

from ...core.errors import InputError
from ...core.retarget.roles import ROLES
from .characters import find_character, full_title
from .map_conversion import role_named
from .map_properties import SOURCE_WORDS, is_chain


class RoleBoneOperator:
    """Mixin of an operator that gives a role a bone."""

    role: bpy.props.StringProperty(
        name="Role", description="The role, as in upper_arm.L", options={"SKIP_SAVE"}
    )
    index: bpy.props.IntProperty(
        name="Index", description="Number of the bone in a chain, from 0", min=0, options={"SKIP_SAVE"}
    )


def give_bone(character: bpy.types.PropertyGroup, role: str, index: int, bone: str) -> None:
    """Give a role a bone, which makes the role the person's.

    Raises:
        InputError: There is no such role or place in it, or no such bone.
    """
    if role not in ROLES:
        raise InputError(f"there is no role '{role}'; roles are {', '.join(ROLES)}")
    if bone not in character.armature.data.bones:
        raise InputError(
            f"'{character.armature.name}' has no bone '{bone}'; give the name of one of its bones"
        )
    shown = role_named(character.character_map, role)
    if index >= len(shown.bones):
        raise InputError(
            f"the role {role} has {len(shown.bones)} bones, so there is no number {index}; add a bone first"
        )
    shown.bones[index].bone = bone


def active_bone_of(character: bpy.types.PropertyGroup) -> str | None:
    """Name of the active bone of a character's armature; None where there is none."""
    active = character.armature.data.bones.active if character.armature is not None else None
    return active.name if active is not None else None


def told(context: bpy.types.Context, role: str) -> str:
    """Where a role's bones come from and why they are doubtful, for a tooltip; empty where unknown."""
    character = find_character(context.scene)
    if character is None or role not in character.character_map.roles:
        return ""
    shown = character.character_map.roles[role]
    if shown.doubt:
        return shown.doubt[:1].upper() + shown.doubt[1:]
    if not any(entry.bone for entry in shown.bones):
        return f"{full_title(role).capitalize()}: no bone"
    if shown.source == "you":
        return f"{full_title(role).capitalize()}: chosen by you"
    return (
        f"{full_title(role).capitalize()}: found by {SOURCE_WORDS[shown.source].lower()}, "
        f"{100.0 * shown.confidence:.0f} % sure"
    )


def chain_role(role: str) -> str:
    """The role, if several bones may share it.

    Raises:
        InputError: It is one bone's.
    """
    if role not in ROLES or not is_chain(role):
        raise InputError(f"'{role}' is no chain of bones; spine and neck are")
    return role
