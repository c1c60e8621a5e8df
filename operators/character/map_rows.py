"""Rows of the panel that shows which bones play which role."""

import bpy

from ..shell.panel import draw_sentence
from .characters import full_title, missing_roles
from .map_properties import PART_TITLES, PARTS, SOURCE_WORDS, is_chain, role_title

LABEL_SHARE = 0.29
"""Share of the width that a role's name takes."""
MOST_LINES = 5


def draw_map(
    layout: bpy.types.UILayout, context: bpy.types.Context, character: bpy.types.PropertyGroup
) -> None:
    """Draw recognition, the map's file, what is doubtful, and the roles of each part of the body."""
    character_map = character.character_map
    column = layout.column()
    column.operator("keymark.recognize_character", icon="VIEWZOOM")
    if character.suggested:
        text = f"Use '{character.suggested}'"
        use = column.operator("keymark.load_map", text=text, icon="FILE_TICK", translate=False)
        use.title = character.suggested
    row = column.row(align=True)
    row.operator("keymark.load_map", icon="IMPORT")
    row.operator("keymark.save_map", icon="EXPORT")
    for doubt in character.doubts:
        draw_sentence(column, context, doubt.text, "ERROR", MOST_LINES)
    missing = [full_title(role) for role in missing_roles(character)]
    if len(character_map.roles) and missing:
        draw_sentence(column, context, f"Without a bone: {', '.join(missing)}", "ERROR")
    if not len(character_map.roles):
        return
    _draw_parts(layout, context, character)
    layout.operator("keymark.mirror_roles", text="Mirror Left to Right", icon="MOD_MIRROR").side = "L"


def _draw_parts(
    layout: bpy.types.UILayout, context: bpy.types.Context, character: bpy.types.PropertyGroup
) -> None:
    """Draw the roles of each part of the body in a panel of its own, which opens where there is a doubt."""
    for part, roles in PARTS.items():
        shown = [
            character.character_map.roles[role] for role in roles if role in character.character_map.roles
        ]
        marked = any(is_marked(character, role) for role in shown)
        header, body = layout.panel(f"KEYMARK_PT_part_{part.replace('.', '_')}", default_closed=not marked)
        header.label(text=PART_TITLES[part], icon="ERROR" if marked else "NONE")
        _draw_confidence(header, shown)
        if body is None:
            continue
        column = body.column(align=True)
        for role in shown:
            _draw_role(column, context, character, role)
        _draw_controls(body, character, part, shown)


def _draw_confidence(header: bpy.types.UILayout, shown: list[bpy.types.PropertyGroup]) -> None:
    """Draw where the bones of a part come from, and how sure the least certain is."""
    found = [role for role in shown if any(entry.bone for entry in role.bones)]
    if not found:
        return
    least = min(found, key=lambda role: role.confidence)
    facts = header.row()
    facts.alignment = "RIGHT"
    facts.active = False
    source = SOURCE_WORDS[least.source]
    if least.source != "you":
        source = f"{source} {100.0 * least.confidence:.0f} %"
    facts.label(text=source, translate=False)


def is_marked(character: bpy.types.PropertyGroup, role: bpy.types.PropertyGroup) -> bool:
    """Whether a role is doubtful, or one of its bones is not there any more."""
    bones = character.armature.data.bones
    return bool(role.doubt) or any(entry.bone and entry.bone not in bones for entry in role.bones)


def _draw_role(
    column: bpy.types.UILayout,
    context: bpy.types.Context,
    character: bpy.types.PropertyGroup,
    role: bpy.types.PropertyGroup,
) -> None:
    """Draw a role: a row for each of its bones, and why it is doubtful."""
    bones = character.armature.data.bones
    for index, entry in enumerate(role.bones):
        split = column.split(factor=LABEL_SHARE, align=True)
        name = split.row()
        name.alignment = "RIGHT"
        name.label(text=role_title(role.name) if index == 0 else "")
        if is_chain(role.name) and index == len(role.bones) - 1:
            name.operator("keymark.add_chain_bone", text="", icon="ADD", emboss=False).role = role.name
        row = split.row(align=True)
        field = row.row(align=True)
        field.alert = bool(entry.bone) and entry.bone not in bones
        icon = "ERROR" if role.doubt or field.alert else "NONE"
        field.prop_search(entry, "bone", character.armature.data, "bones", text="", icon=icon)
        _draw_buttons(row, role, index)
    if role.doubt:
        why = role.doubt.partition(": ")[2] or role.doubt
        draw_sentence(column, context, why[:1].upper() + why[1:], "BLANK1", MOST_LINES)


def _draw_buttons(row: bpy.types.UILayout, role: bpy.types.PropertyGroup, index: int) -> None:
    """Draw the eyedropper, and what takes an empty field out of a chain."""
    pick = row.operator("keymark.pick_bone", text="", icon="EYEDROPPER")
    pick.role, pick.index = role.name, index
    if is_chain(role.name) and not role.bones[index].bone and len(role.bones) > 1:
        remove = row.operator("keymark.remove_chain_bone", text="", icon="REMOVE")
        remove.role, remove.index = role.name, index


def _draw_controls(
    layout: bpy.types.UILayout,
    character: bpy.types.PropertyGroup,
    part: str,
    shown: list[bpy.types.PropertyGroup],
) -> None:
    """Draw the controls that are keyed for a part, where the map has any."""
    keyed = [(role, entry) for role in shown for entry in role.bones if entry.control]
    limb = character.character_map.limbs.get(part)
    controls = [name for name in ("goal", "pole", "toe") if limb is not None and getattr(limb, name)]
    if not keyed and not controls:
        return
    closed = f"KEYMARK_PT_controls_{part.replace('.', '_')}"
    header, body = layout.panel(closed, default_closed=True)
    header.label(text="Controls")
    if body is None:
        return
    column, armature = body.column(align=True), character.armature.data
    for role, entry in keyed:
        _draw_control(column, armature, entry, "control", role_title(role.name))
    for name in controls:
        _draw_control(column, armature, limb, name, limb.bl_rna.properties[name].name)
    if limb is not None and limb.switch_bone:
        _draw_control(column, armature, limb, "switch_bone", "Switch")
        split = column.split(factor=LABEL_SHARE)
        split.label(text="")
        values = f"{limb.switch_property}: IK {limb.switch_ik:g}, FK {limb.switch_fk:g}"
        split.label(text=values, translate=False)


def _draw_control(
    column: bpy.types.UILayout,
    armature: bpy.types.Armature,
    owner: bpy.types.PropertyGroup,
    name: str,
    text: str,
) -> None:
    split = column.split(factor=LABEL_SHARE, align=True)
    left = split.row()
    left.alignment = "RIGHT"
    left.label(text=text, translate=False)
    field = split.row()
    field.alert = bool(getattr(owner, name)) and getattr(owner, name) not in armature.bones
    field.prop_search(owner, name, armature, "bones", text="", icon="BONE_DATA")
