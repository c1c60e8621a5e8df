"""Keyframes from a library: what to match, how sure it is, and choosing among what a frame may show."""

from math import degrees

import bpy

from ...running.say import label
from ...scene.matches import state_of
from ...scene.takes import active_take
from ..properties.match import DOUBTFUL, SURE
from .base import TakePanel, draw_progress, draw_sentence

CLEAR = 0.6
"""Probability of a kind of motion above which nothing needs to be thought over."""
FRAME_UNITS, PERCENT_UNITS = 2.0, 2.4
NOTICEABLE_TURN_DEG = 15.0
ICONS = {"POSED": "KEYFRAME_HLT", "GONE": "X"}


class KEYMARK_UL_matches(bpy.types.UIList):
    """Matches: frame, posture, and how probably it is right."""

    def draw_item(
        self,
        context: bpy.types.Context,
        layout: bpy.types.UILayout,
        data: bpy.types.AnyType,
        item: bpy.types.PropertyGroup,
        icon: int,
        active_data: bpy.types.AnyType,
        active_property: str,
    ) -> None:
        """Draw one match; of one that is posed or gone, say so."""
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
        if state == "MATCHED":
            words = label("by hand") if item.by_hand else percent(item.confidence)
        else:
            words = label("posed") if state == "POSED" else label("no key")
        said.label(text=words, translate=False)


def confidence_icon(match: bpy.types.PropertyGroup) -> str:
    """How sure a match is, as a shape: a tick, a dot, a question mark."""
    if match.by_hand or match.confidence >= SURE:
        return "CHECKMARK"
    return "QUESTION" if match.confidence < DOUBTFUL else "DOT"


def percent(share: float) -> str:
    """A probability as people read it."""
    return label("{percent:.0f} %", percent=100.0 * share)


class KEYMARK_PT_matches(TakePanel, bpy.types.Panel):
    """Matching, and what came of it."""

    bl_label = "Match a Library"
    bl_parent_id = "KEYMARK_PT_keyframes"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw what to look for, the button or the running job, and what was found."""
        matching, column = active_take(context.scene).matching, self.column()
        column.prop(matching, "library")
        column.prop(matching, "floor")
        if matching.floor == "HEIGHT":
            column.prop(matching, "floor_height")
        row = column.row()
        row.scale_y = 1.2
        if not draw_progress(row, context, "keymark.match_library"):
            row.operator("keymark.match_library", icon="VIEWZOOM")
        _draw_choice(column, context, matching)
        if len(matching.matches):
            _draw_matches(column, matching)
            _draw_candidates(column, matching)


def _draw_choice(
    layout: bpy.types.UILayout, context: bpy.types.Context, matching: bpy.types.PropertyGroup
) -> None:
    """Which library, how sure, and what comes next; why, where that is in doubt."""
    if not len(matching.ranking):
        return
    best, *others = matching.ranking
    sure = bool(len(matching.matches)) and best.probability >= CLEAR
    words = f"{best.name}, {percent(best.probability)}"
    if others:
        words = label(
            "{best}; next {other}, {percent:.0f} %",
            best=words,
            other=others[0].name,
            percent=100.0 * others[0].probability,
        )
    draw_sentence(layout, context, words, "CHECKMARK" if sure else "QUESTION")
    if matching.reason and not sure:
        draw_sentence(layout, context, matching.reason, "BLANK1")


def _draw_matches(layout: bpy.types.UILayout, matching: bpy.types.PropertyGroup) -> None:
    layout.template_list(
        "KEYMARK_UL_matches", "", matching, "matches", matching, "active_match", rows=4, maxrows=8
    )
    row = layout.row(align=True)
    row.operator("keymark.jump_to_match", text="", icon="PREV_KEYFRAME").direction = "PREVIOUS"
    doubtful = row.operator("keymark.jump_to_match", text="Next Doubtful")
    doubtful.direction, doubtful.only_doubtful = "NEXT", True
    row.operator("keymark.jump_to_match", text="", icon="NEXT_KEYFRAME").direction = "NEXT"


def _draw_candidates(layout: bpy.types.UILayout, matching: bpy.types.PropertyGroup) -> None:
    """What the chosen match's frame may show, each a button, and what else can be done with it."""
    if matching.active_match >= len(matching.matches):
        return
    match = matching.matches[matching.active_match]
    box = layout.column(align=True)
    box.label(text=label("Frame {frame:g} may show", frame=match.frame), translate=False)
    for place, candidate in enumerate(match.candidates):
        row = box.row(align=True)
        button = row.operator(
            "keymark.replace_match",
            text=_said_of(candidate),
            translate=False,
            icon="MOD_MIRROR" if candidate.mirrored else "ARMATURE_DATA",
            depress=place == match.chosen,
        )
        button.candidate = place
        said = row.row()
        said.ui_units_x = PERCENT_UNITS
        said.alignment = "RIGHT"
        said.label(text=percent(candidate.confidence), translate=False)
    row = layout.row(align=True)
    row.operator("keymark.accept_match", icon="CHECKMARK")
    row.operator("keymark.remove_match", icon="X")


def _said_of(candidate: bpy.types.PropertyGroup) -> str:
    """A candidate's name; the turn first, as several often differ by that alone and a sidebar is narrow."""
    angle = degrees(candidate.turned)
    if abs(angle) < NOTICEABLE_TURN_DEG:
        return str(candidate.name)
    if abs(angle) > 180.0 - NOTICEABLE_TURN_DEG:
        return label("Turned round: {posture}", posture=candidate.name)
    if angle > 0.0:
        return label("{angle:.0f}° left: {posture}", angle=angle, posture=candidate.name)
    return label("{angle:.0f}° right: {posture}", angle=-angle, posture=candidate.name)


register, unregister = bpy.utils.register_classes_factory((KEYMARK_UL_matches, KEYMARK_PT_matches))
