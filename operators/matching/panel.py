"""Panel of matching: settings, results, and the choice among a frame's candidates."""

from math import degrees

import bpy

from ..shell.messages import label
from ..shell.panel import RowList, TakePanel, draw_progress, draw_sentence
from ..shell.takes import active_take
from .matches import state_of
from .properties import DOUBTFUL, SURE

WELL = 0.85
"""Fit below which the footage probably shows something else."""
FRAME_UNITS, PERCENT_UNITS = 1.6, 2.1
NOTICEABLE_TURN_DEG = 15.0
ICONS = {"POSED": "KEYFRAME_HLT", "GONE": "X"}


class KEYMARK_UL_matches(RowList, bpy.types.UIList):
    """Matches: frame, posture and confidence."""

    def draw_row(
        self, context: bpy.types.Context, layout: bpy.types.UILayout, item: bpy.types.PropertyGroup
    ) -> None:
        """Draw one match, or that it is posed or has no key any more."""
        state = state_of(active_take(context.scene), item)
        row = layout.row(align=True)
        row.active = state != "GONE"
        number = row.row()
        number.ui_units_x = FRAME_UNITS
        number.label(text=f"{item.frame:g}", translate=False)
        shown = item.candidate
        row.label(text=shown.name, icon=ICONS.get(state, confidence_icon(item)), translate=False)
        if shown.mirrored:
            row.label(text="", icon="MOD_MIRROR")
        said = row.row()
        said.ui_units_x = PERCENT_UNITS
        said.alignment = "RIGHT"
        words = {"POSED": label("posed"), "GONE": label("no key")}.get(state, percent(item.confidence))
        said.label(text=words, translate=False)


def confidence_icon(match: bpy.types.PropertyGroup) -> str:
    """Icon of a match's confidence: chosen by hand, sure, fair or doubtful."""
    if match.by_hand:
        return "VIEW_PAN"
    if match.confidence < DOUBTFUL:
        return "QUESTION"
    return "CHECKMARK" if match.confidence >= SURE else "DOT"


def percent(share: float) -> str:
    """A probability in percent."""
    return label("{percent:.0f} %", percent=100.0 * share)


class KEYMARK_PT_matches(TakePanel, bpy.types.Panel):
    """Matching and its results."""

    bl_label = "Match a Library"
    bl_parent_id = "KEYMARK_PT_keyframes"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the settings, the button or the running job, and the results."""
        matching, column = active_take(context.scene).matching, self.column()
        column.prop(matching, "library")
        column.prop(matching, "floor")
        if matching.floor == "HEIGHT":
            column.prop(matching, "floor_height")
        elif matching.is_property_set("floor_found"):
            found = column.row()
            found.enabled = False
            found.prop(matching, "floor_found")
        row = column.row()
        row.scale_y = 1.2
        if not draw_progress(row, context, "keymark.match_library"):
            row.operator("keymark.match_library", icon="VIEWZOOM")
        _draw_reason(column, context, matching)
        if len(matching.matches):
            _draw_matches(column, active_take(context.scene))
            _draw_candidates(column, active_take(context.scene))


def _draw_reason(
    layout: bpy.types.UILayout, context: bpy.types.Context, matching: bpy.types.PropertyGroup
) -> None:
    """Draw how much of the footage is explained."""
    if not matching.reason:
        return
    draw_sentence(layout, context, matching.reason, "CHECKMARK" if matching.fit >= WELL else "QUESTION")
    if matching.fit < WELL:
        draw_sentence(layout, context, label("It probably shows something else"), "BLANK1")


def _draw_matches(layout: bpy.types.UILayout, take: bpy.types.PropertyGroup) -> None:
    matching = take.matching
    layout.template_list(
        "KEYMARK_UL_matches", "", matching, "matches", matching, "active_match", rows=3, maxrows=5
    )
    row = layout.row(align=True)
    row.operator("keymark.jump_to_match", text="", icon="PREV_KEYFRAME").direction = "PREVIOUS"
    left = sum(match.is_doubtful and state_of(take, match) == "MATCHED" for match in matching.matches)
    going = row.row(align=True)
    going.enabled = left > 0
    words = label("Next Doubtful ({count})", count=left) if left else label("None Doubtful")
    doubtful = going.operator("keymark.jump_to_match", text=words, translate=False)
    doubtful.direction, doubtful.only_doubtful = "NEXT", True
    row.operator("keymark.jump_to_match", text="", icon="NEXT_KEYFRAME").direction = "NEXT"


def _draw_candidates(layout: bpy.types.UILayout, take: bpy.types.PropertyGroup) -> None:
    """Draw the candidates of the chosen match as buttons, and its other operators."""
    matching = take.matching
    if matching.active_match >= len(matching.matches):
        return
    match = matching.matches[matching.active_match]
    box = layout.column(align=True)
    box.label(text=label("Frame {frame:g} may show", frame=match.frame), translate=False)
    for index, candidate in enumerate(match.candidates):
        row = box.row(align=True)
        button = row.operator(
            "keymark.replace_match",
            text=_candidate_label(candidate),
            translate=False,
            icon="MOD_MIRROR" if candidate.mirrored else "ARMATURE_DATA",
            depress=index == match.chosen,
        )
        button.candidate = index
        said = row.row()
        said.ui_units_x = PERCENT_UNITS
        said.alignment = "RIGHT"
        said.label(text=percent(candidate.confidence), translate=False)
    row = layout.row(align=True)
    accept = row.row(align=True)
    accept.enabled = state_of(take, match) == "MATCHED"
    accept.operator("keymark.accept_match", icon="CHECKMARK")
    row.operator("keymark.remove_match", icon="X")


def _candidate_label(candidate: bpy.types.PropertyGroup) -> str:
    """A candidate's name, after its turn: several often differ by that alone, and a sidebar is narrow."""
    angle = degrees(candidate.turned)
    if abs(angle) < NOTICEABLE_TURN_DEG:
        return str(candidate.name)
    if abs(angle) > 180.0 - NOTICEABLE_TURN_DEG:
        return label("Turned round: {posture}", posture=candidate.name)
    if angle > 0.0:
        return label("{angle:.0f}° left: {posture}", angle=angle, posture=candidate.name)
    return label("{angle:.0f}° right: {posture}", angle=-angle, posture=candidate.name)


register, unregister = bpy.utils.register_classes_factory((KEYMARK_UL_matches, KEYMARK_PT_matches))
