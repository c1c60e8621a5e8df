"""Found keyframes in the panel of poses: the list, and the candidates of a frame."""

import bpy

from ...core.prior.texts import COMPOSED
from ..shell.contradictions import contradictions_at
from ..shell.keyed_frames import DOUBTFUL, count_found, state_of
from ..shell.panel import RowList
from ..shell.takes import active_take
from .candidate_buttons import PERCENT_UNITS, draw_candidates, draw_side_view, percent

STATES = {"POSED": ("KEYFRAME_HLT", "posed"), "GONE": ("X", "no key")}
"""Icon and words of what is no found keyframe any more."""


class KEYMARK_UL_matches(RowList, bpy.types.UIList):
    """Found keyframes: frame, posture and confidence."""

    def draw_row(
        self, context: bpy.types.Context, layout: bpy.types.UILayout, item: bpy.types.PropertyGroup
    ) -> None:
        take = active_take(context.scene)
        state = state_of(take, item)
        row = layout.row(align=True)
        row.active = state != "GONE"
        number = row.row()
        number.ui_units_x = 1.6
        number.label(text=f"{item.frame:g}", translate=False)
        is_found = state == "FOUND"
        icon, words = how_sure(take, item) if is_found else STATES[state]
        shown = item.candidate
        named = is_found and item.library != COMPOSED  # a composed one has the name of any that it resembles
        row.label(text=shown.name if named else words, icon=icon, translate=False)
        if named and shown.mirrored:
            row.label(text="", icon="MOD_MIRROR")
        if is_found:
            said = row.row()
            said.ui_units_x = PERCENT_UNITS
            said.alignment = "RIGHT"
            said.label(text=percent(item.confidence), translate=False)


def how_sure(take: bpy.types.PropertyGroup, match: bpy.types.PropertyGroup) -> tuple[str, str]:
    """Icon and words of a found keyframe: chosen by hand, contradicted, sure, fair or doubtful."""
    if match.by_hand:
        return "VIEW_PAN", "chosen"
    if contradictions_at(take, match.frame):
        return "ERROR", "contradicted"
    if match.confidence < DOUBTFUL:
        return "QUESTION", "doubtful"
    return ("CHECKMARK", "sure") if match.confidence >= 0.8 else ("DOT", "likely")


def draw_found(column: bpy.types.UILayout, context: bpy.types.Context, take: bpy.types.PropertyGroup) -> None:
    """Draw found keyframes, the way to the next doubtful one, and the choice among a frame's candidates."""
    matching = take.matching
    column.template_list(
        "KEYMARK_UL_matches", "", matching, "matches", matching, "shown_match", rows=3, maxrows=3
    )
    count, doubtful = count_found(take)
    row = column.row(align=True)
    going = row.row(align=True)
    going.enabled = doubtful > 0
    words = f"Next Doubtful ({doubtful} of {count})" if doubtful else f"None of {count} Doubtful"
    jump = going.operator("keymark.jump_to_match", text=words, translate=False, icon="NEXT_KEYFRAME")
    jump.direction, jump.only_doubtful = "NEXT", True
    draw_side_view(row, context)
    _draw_candidates(column, take)


def _draw_candidates(layout: bpy.types.UILayout, take: bpy.types.PropertyGroup) -> None:
    """Draw the candidates of the chosen frame as buttons in their figures' colors, and what can be done."""
    matching = take.matching
    if matching.shown_match >= len(matching.matches):
        return
    match = matching.matches[matching.shown_match]
    box = layout.column(align=True)
    is_found = state_of(take, match) == "FOUND"
    draw_candidates(box, match, "keymark.replace_match", is_found)
    row = layout.row(align=True)
    accept = row.row(align=True)
    accept.enabled = is_found
    accept.operator("keymark.accept_match", icon="CHECKMARK")
    row.operator("keymark.remove_match", icon="X")
