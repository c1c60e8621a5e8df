"""Rows of the panel that shows which bones play which role."""

import bpy
from bpy.types import Armature, Context, PropertyGroup, UILayout

from ...core.retarget.character import CHAINS
from ..bridge.character.read_character import needs_override
from ..shell.panel import Popover, RowList, StepPanel, TakePanel, draw_progress, draw_sentence, right_end
from ..shell.take_state import TakeState
from ..shell.takes import active_take
from . import characters
from .map_properties import PARTS, role_title


def _draw_parts(layout: UILayout, context: Context, character: PropertyGroup) -> None:
    known, armature_data = character.character_map.roles, character.armature.data
    for part, (title, roles) in PARTS.items():
        shown = [known[role] for role in roles if role in known]
        entries = [entry for role in shown for entry in role.bones if entry.bone]
        # Where a role is doubtful, or one of its bones is not there any more.
        lost = any(entry.bone not in armature_data.bones for entry in entries)
        marked = lost or any(role.doubt for role in shown)
        header, body = layout.panel(f"KEYMARK_PT_part_{part.replace('.', '_')}", default_closed=not marked)
        header.label(text=title, icon="ERROR" if marked else "NONE")
        found = [role for role in shown if any(entry.bone for entry in role.bones)]
        if found:
            least = min(found, key=lambda role: role.confidence)
            sure = "" if least.source == "you" else f" {100.0 * least.confidence:.0f} %"
            facts = right_end(header)
            facts.active = False
            facts.label(text=least.source.title() + sure, translate=False)
        if body is not None:
            column = body.column(align=True)
            for role in shown:
                _draw_role(column, context, armature_data, role)
            _draw_controls(body, character, part, shown)


def _labeled(column: UILayout, text: str) -> tuple[UILayout, UILayout]:
    split = column.split(factor=0.29, align=True)
    name = right_end(split)
    name.label(text=text, translate=False)
    return name, split.row(align=True)


def _draw_role(column: UILayout, context: Context, armature_data: Armature, role: PropertyGroup) -> None:
    is_chain = role.name in CHAINS
    for index, entry in enumerate(role.bones):
        name, row = _labeled(column, role_title(role.name) if index == 0 else "")
        if is_chain and index == len(role.bones) - 1:
            name.operator("keymark.add_chain_bone", text="", icon="ADD", emboss=False).role = role.name
        field = row.row(align=True)
        field.alert = bool(entry.bone) and entry.bone not in armature_data.bones
        icon = "ERROR" if role.doubt or field.alert else "NONE"
        field.prop_search(entry, "bone", armature_data, "bones", text="", icon=icon)
        buttons = [("keymark.pick_bone", "EYEDROPPER")]
        if is_chain and not entry.bone and len(role.bones) > 1:
            buttons.append(("keymark.remove_chain_bone", "REMOVE"))
        for operator, icon in buttons:
            button = row.operator(operator, text="", icon=icon)
            button.role, button.index = role.name, index
    if role.doubt:
        why = role.doubt.partition(": ")[2] or role.doubt
        draw_sentence(column, context, why[:1].upper() + why[1:], "BLANK1", 5)


def _draw_controls(layout: UILayout, character: PropertyGroup, part: str, shown: list[PropertyGroup]) -> None:
    limb = character.character_map.limbs.get(part)
    entries = [(role, entry) for role in shown for entry in role.bones if entry.control]
    fields = [(entry, "control", role_title(role.name)) for role, entry in entries]
    for name in ("goal", "pole", "toe", "switch_bone") if limb is not None else ():
        if getattr(limb, name):
            fields.append((limb, name, limb.bl_rna.properties[name].name))
    if not fields:
        return
    header, body = layout.panel(f"KEYMARK_PT_controls_{part.replace('.', '_')}", default_closed=True)
    header.label(text="Controls")
    if body is None:
        return
    column, armature_data = body.column(align=True), character.armature.data
    for owner, name, text in fields:
        _, field = _labeled(column, text)
        field.alert = bool(getattr(owner, name)) and getattr(owner, name) not in armature_data.bones
        field.prop_search(owner, name, armature_data, "bones", text="", icon="BONE_DATA")
    if limb is not None and limb.switch_bone:
        values = f"{limb.switch_property}: IK {limb.switch_ik:g}, FK {limb.switch_fk:g}"
        _labeled(column, "")[1].label(text=values, translate=False)


class KEYMARK_UL_characters(RowList, bpy.types.UIList):
    """Characters by their armatures; the icon tells whether one has the motion."""

    def draw_row(self, context: Context, layout: UILayout, item: PropertyGroup) -> None:
        row = layout.row(align=True)
        done = any(result.action is not None for result in item.results)
        name = item.armature.name if item.armature is not None else "No Armature"
        row.label(text=name, icon="ACTION" if done else "ARMATURE_DATA", translate=False)
        state = TakeState(active_take(context.scene))
        if item.problem or item.armature is None or any(map(state.of_earlier, item.results)):
            row.label(text="", icon="ERROR")


class KEYMARK_PT_character(StepPanel, bpy.types.Panel):
    """The characters, and the button that gives the chosen one the motion."""

    bl_label = "Character"
    step = "character"
    options = "KEYMARK_PT_retarget_options"
    is_wrong = staticmethod(lambda s: s.has_outdated_result or any(one.problem for one in s.take.characters))

    @classmethod
    def summary(cls, state: TakeState) -> str:
        all_ = state.take.characters
        performing = sum(any(result.action for result in each.results) for each in all_)
        return f"{performing} of {len(all_)}" if len(all_) else ""

    @classmethod
    def action(cls, state: TakeState) -> tuple[str, str]:
        if len(state.take.characters) or state.take.motion_action is None:
            return "keymark.retarget", "Retarget"
        free = any(characters.may_be_character(each) for each in bpy.context.view_layer.objects)
        return ("keymark.add_character", "Add") if free else ("keymark.add_rigify_human", "Add Rigify Human")

    def draw_step(self, context: Context, body: UILayout, state: TakeState) -> None:
        take = state.take
        character = characters.find_character(context.scene)
        if character is None:
            buttons = body.column()
            buttons.scale_y = 1.2
            buttons.operator("keymark.add_character", icon="COMMUNITY")
            buttons.operator("keymark.add_rigify_human", icon="ARMATURE_DATA")
            return
        row = body.row()
        if len(take.characters) == 1:
            buttons = row.row(align=True)
            buttons.prop(character, "armature", text="")
        else:
            row.template_list(
                "KEYMARK_UL_characters", "", take, "characters", take, "active_character", rows=2, maxrows=4
            )
            buttons = row.column(align=True)
        buttons.operator("keymark.add_character", text="", icon="ADD")
        buttons.operator("keymark.remove_character", text="", icon="REMOVE")
        column = body.column()
        if character.armature is None:
            draw_sentence(column, context, "Choose the armature that is to move", "FORWARD")
            if len(take.characters) > 1:
                column.prop(character, "armature")
            column.operator("keymark.add_rigify_human", icon="ARMATURE_DATA")
            return
        if needs_override(character.armature):
            draw_sentence(column, context, "It is linked; an override can be animated here", "LINKED")
            column.operator("keymark.make_override", icon="LIBRARY_DATA_OVERRIDE")
        elif (
            unmet := character.problem
            or characters.armature(context, state)
            or characters.recognized(context, state)
        ):
            draw_sentence(column, context, unmet, "ERROR", 6)
        row = column.row()
        row.scale_y = 1.4
        if not draw_progress(row, context, "keymark.retarget"):
            row.operator("keymark.retarget", icon="COMMUNITY")
        if len(character.results):
            _draw_results(column, context, state, character)


def _draw_results(column: UILayout, context: Context, state: TakeState, character: PropertyGroup) -> None:
    column.separator()
    rows = column.column(align=True)
    data = character.armature.animation_data
    performed = None if data is None else data.action
    for index, result in enumerate(character.results):
        row = rows.row(align=True)
        if result.action is None:
            row.label(text="Deleted", icon="ACTION")
        else:
            icon = "ERROR" if state.of_earlier(result) else "ACTION"
            words = {"text": result.action.name, "icon": icon, "translate": False}
            show = row.operator("keymark.show_result", depress=result.action == performed, **words)
            show.index = index
        row.operator("keymark.remove_result", text="", icon="X").index = index
    chosen = characters.shown_result(character)
    if chosen is None or chosen.action is None:
        return
    lines = column.column(align=True)
    if state.of_earlier(chosen):
        draw_sentence(lines, context, "Motion is newer: retarget again", "ERROR")
    for line in chosen.lines:
        draw_sentence(lines, context, line.text, "ERROR" if line.level == "ERROR" else "DOT")


class KEYMARK_PT_retarget_options(Popover, bpy.types.Panel):
    """Which motion is performed, and how."""

    bl_label = "Options of the Character"

    def draw(self, context: Context) -> None:
        column, character = self.column(), characters.find_character(context.scene)
        if character is None:
            column.label(text="Add a character first", icon="INFO")
            return
        column.prop(character, "source")
        if character.source == "ACTION":
            column.prop(character, "source_action")
            column.prop(character, "source_actor")
        column.prop(character, "keep_earlier")
        options = character.options
        for name in ("arms", "legs", "root_motion", "placement", "plant_feet", "reach_hands", "keys"):
            column.prop(options, name)
        few = column.column()
        few.active = options.keys == "TOLERANCE"
        few.prop(options, "tolerance_mm")
        column.prop(character, "armature")
        column.operator("keymark.mark_result_asset", icon="ASSET_MANAGER")


class KEYMARK_PT_character_map(TakePanel, bpy.types.Panel):
    """The bones that play a role."""

    bl_label = "Bones"
    bl_parent_id = "KEYMARK_PT_character"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: Context) -> bool:
        character = characters.find_character(context.scene)
        return super().poll(context) and character is not None and character.armature is not None

    def draw_header(self, context: Context) -> None:
        character = characters.active_character(context.scene)
        doubtful = any(role.doubt for role in character.character_map.roles)
        if doubtful or len(character.doubts) or characters.missing_roles(character):
            self.layout.label(text="", icon="ERROR")

    def draw(self, context: Context) -> None:
        layout, character = self.layout, characters.active_character(context.scene)
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
            draw_sentence(column, context, doubt.text, "ERROR", 5)
        if not len(character.character_map.roles):
            return
        missing = [characters.full_title(role) for role in characters.missing_roles(character)]
        if missing:
            draw_sentence(column, context, f"Without a bone: {', '.join(missing)}", "ERROR")
        _draw_parts(layout, context, character)
        layout.operator("keymark.mirror_roles", text="Mirror Left to Right", icon="MOD_MIRROR").side = "L"
