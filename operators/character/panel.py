"""The panel of step 8: the characters of a take, their options and their results."""

import bpy

from ..bridge.character.read_character import needs_override
from ..shell.panel import RowList, TakePanel, draw_progress, draw_sentence
from ..shell.step_panel import StepPanel
from ..shell.takes import active_take
from .characters import active_character, find_character, missing_roles, shown_result
from .map_rows import draw_map
from .requirements import recognized
from .results import is_shown

MOST_LINES = 6
"""Lines of a sentence."""


class KEYMARK_UL_characters(RowList, bpy.types.UIList):
    """Characters by their armatures; the icon tells whether one has the motion."""

    def draw_row(
        self, context: bpy.types.Context, layout: bpy.types.UILayout, item: bpy.types.PropertyGroup
    ) -> None:
        """Draw one character."""
        row = layout.row(align=True)
        done = any(result.action is not None for result in item.results)
        name = item.armature.name if item.armature is not None else "No Armature"
        row.label(text=name, icon="ACTION" if done else "ARMATURE_DATA", translate=False)
        if item.problem or item.armature is None or any(result.outdated for result in item.results):
            row.label(text="", icon="ERROR")


class KEYMARK_PT_character(StepPanel, bpy.types.Panel):
    """The characters, and the button that gives the chosen one the motion."""

    bl_label = "Character"
    step = "character"

    def draw_step(self, context: bpy.types.Context) -> None:
        """Draw the list, the chosen character, and its result."""
        take, character = active_take(context.scene), find_character(context.scene)
        if character is None:
            buttons = self.body.column()
            buttons.scale_y = 1.2
            buttons.operator("keymark.add_character", icon="COMMUNITY")
            buttons.operator("keymark.add_rigify_human", icon="ARMATURE_DATA")
            return
        column = _draw_choice(self, take, character)
        if character.armature is None:
            draw_sentence(column, context, "Choose the armature that is to move", "FORWARD")
            column.operator("keymark.add_rigify_human", icon="ARMATURE_DATA")
            return
        if needs_override(character.armature):
            draw_sentence(column, context, "It is linked; an override can be animated here", "LINKED")
            column.operator("keymark.make_override", icon="LIBRARY_DATA_OVERRIDE")
        elif character.problem:
            draw_sentence(column, context, character.problem, "ERROR", MOST_LINES)
        elif (unmet := recognized(context)) is not None:
            draw_sentence(column, context, unmet, "ERROR", MOST_LINES)
        _draw_source(column, take, character)
        row = column.row()
        row.scale_y = 1.4
        if not draw_progress(row, context, "keymark.retarget"):
            row.operator("keymark.retarget", icon="COMMUNITY")
        if len(character.results):
            column.prop(character, "keep_earlier")
            _draw_results(column, context, character)


def _draw_choice(
    panel: KEYMARK_PT_character, take: bpy.types.PropertyGroup, character: bpy.types.PropertyGroup
) -> bpy.types.UILayout:
    """Draw the list of characters and the chosen one's armature; a single character is one row."""
    row = panel.body.row()
    single = len(take.characters) == 1
    if single:
        buttons = row.row(align=True)
        buttons.prop(character, "armature", text="")
    else:
        row.template_list(
            "KEYMARK_UL_characters", "", take, "characters", take, "active_character", rows=2, maxrows=4
        )
        buttons = row.column(align=True)
    buttons.operator("keymark.add_character", text="", icon="ADD")
    buttons.operator("keymark.remove_character", text="", icon="REMOVE")
    column = panel.column()
    if not single:
        column.prop(character, "armature")
    return column


def _draw_source(
    column: bpy.types.UILayout, take: bpy.types.PropertyGroup, character: bpy.types.PropertyGroup
) -> None:
    """Draw which motion is performed."""
    column.prop(character, "source")
    if character.source == "ACTION":
        column.prop(character, "source_action")
        column.prop(character, "source_actor")


def _draw_results(
    column: bpy.types.UILayout, context: bpy.types.Context, character: bpy.types.PropertyGroup
) -> None:
    """Draw the switch between the results, and what is known of the chosen one."""
    column.separator()
    rows = column.column(align=True)
    for index, result in enumerate(character.results):
        row = rows.row(align=True)
        if result.action is None:
            row.label(text="Deleted", icon="ACTION")
        else:
            icon = "ERROR" if result.outdated else "ACTION"
            shown = is_shown(character, result)
            text = result.action.name
            row.operator(
                "keymark.show_result", text=text, icon=icon, depress=shown, translate=False
            ).index = index
        row.operator("keymark.remove_result", text="", icon="X").index = index
    chosen = shown_result(character)
    if chosen is None or chosen.action is None:
        return
    lines = column.column(align=True)
    if chosen.outdated:
        draw_sentence(lines, context, "Motion is newer: retarget again", "ERROR")
    for line in chosen.lines:
        draw_sentence(lines, context, line.text, "ERROR" if line.level == "ERROR" else "DOT")
    column.operator("keymark.mark_result_asset", icon="ASSET_MANAGER")


class CharacterPart(TakePanel):
    """Base of the sub-panels; hidden without an armature."""

    bl_parent_id = "KEYMARK_PT_character"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether the chosen character has an armature."""
        character = find_character(context.scene)
        return super().poll(context) and character is not None and character.armature is not None


class KEYMARK_PT_retarget_options(CharacterPart, bpy.types.Panel):
    """Options of retargeting."""

    bl_label = "Options"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw them."""
        column, options = self.column(), active_character(context.scene).options
        column.prop(options, "arms")
        column.prop(options, "legs")
        column.prop(options, "root_motion")
        column.prop(options, "placement")
        column.prop(options, "plant_feet")
        column.prop(options, "reach_hands")
        column.prop(options, "keys")
        few = column.column()
        few.active = options.keys == "TOLERANCE"
        few.prop(options, "tolerance_mm")


class KEYMARK_PT_character_map(CharacterPart, bpy.types.Panel):
    """The bones that play a role."""

    bl_label = "Bones"

    def draw_header(self, context: bpy.types.Context) -> None:
        """Draw a mark, so that doubts are noticed while the panel is closed."""
        character = active_character(context.scene)
        doubtful = any(role.doubt for role in character.character_map.roles)
        if doubtful or len(character.doubts) or missing_roles(character):
            self.layout.label(text="", icon="ERROR")

    def draw(self, context: bpy.types.Context) -> None:
        """Draw recognition, the map's file, and the roles by limb."""
        draw_map(self.layout, context, active_character(context.scene))


register, unregister = bpy.utils.register_classes_factory(
    (KEYMARK_UL_characters, KEYMARK_PT_character, KEYMARK_PT_character_map, KEYMARK_PT_retarget_options)
)
