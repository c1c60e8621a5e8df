"""The panel of the third step: poses found or posed, the choice for a frame, and corrections."""

import bpy
from bpy.types import Context, PropertyGroup, UILayout

from ...core.prior.texts import COMPOSED
from ..overlays.drawing import candidate_icon
from ..shell import panel
from ..shell.job_progress import job_is_running, steady_frame
from ..shell.keyed_frames import has_frame
from ..shell.panel import Popover, RowList, StepPanel, draw_progress, draw_sentence, right_end
from ..shell.take_state import DOUBTFUL, TakeState
from ..shell.takes import active_take
from .change_match import candidate_title
from .corrections import DRAGGING, LIMBS, selected_limbs

MOST_SHOWN = 4  # candidates, the likeliest; with more the step would not fit the sidebar of a small screen
STATES = {"POSED": ("KEYFRAME_HLT", "posed"), "GONE": ("X", "no key")}
"""Icon and words of what is no found keyframe any more."""


class KEYMARK_UL_matches(RowList, bpy.types.UIList):
    """Found keyframes: frame, posture and confidence."""

    def draw_row(self, context: Context, layout: UILayout, item: PropertyGroup) -> None:
        takes_state = TakeState(active_take(context.scene))
        state, shown = takes_state.of_match(item), item.candidate
        row = layout.row(align=True)
        row.active = state != "GONE"
        number = row.row()
        number.ui_units_x = 1.6
        number.label(text=f"{item.frame:g}", translate=False)
        is_found = state == "FOUND"
        if not is_found:
            icon, words = STATES[state]
        elif item.by_hand:
            icon, words = "VIEW_PAN", "chosen"
        elif takes_state.contradictions_at(item.frame):
            icon, words = "ERROR", "contradicted"
        elif item.confidence < DOUBTFUL:
            icon, words = "QUESTION", "doubtful"
        else:
            icon, words = ("CHECKMARK", "sure") if item.confidence >= 0.8 else ("DOT", "likely")
        named = is_found and item.library != COMPOSED  # a composed one has the name of any that it resembles
        row.label(text=shown.name if named else words, icon=icon, translate=False)
        if named and shown.mirrored:
            row.label(text="", icon="MOD_MIRROR")
        if is_found:
            _draw_percent(row, item.confidence)


def _draw_percent(row: UILayout, share: float) -> None:
    end = right_end(row)
    end.ui_units_x = 2.1
    end.label(text=f"{100.0 * share:.0f} %", translate=False)


class KEYMARK_PT_keyframes(StepPanel, bpy.types.Panel):
    """Posing all frames, or one, and correcting what is wrong."""

    bl_label = "Poses"
    step = "keyframes"
    options = "KEYMARK_PT_keyframes_options"
    summary = staticmethod(lambda s: f"{len(s.keyed.all)} keyed" if s.take.keyframe_action else "")
    action = staticmethod(lambda s: ("", "") if s.take.keyframe_action else ("keymark.pose_all", "Pose All"))

    def draw_step(self, context: Context, body: UILayout, state: TakeState) -> None:
        take = state.take
        column = body.column()
        everything = column.row(align=True)
        everything.scale_y = 1.4
        if not draw_progress(everything, context, "keymark.pose_all"):
            everything.operator("keymark.pose_all", icon="OUTLINER_OB_ARMATURE")
            everything.popover("KEYMARK_PT_libraries", text="", icon="ASSET_MANAGER")
        if len(take.matching.matches):
            _draw_found(column, context, state)
        else:
            _draw_proposed(column, context, state)
        _draw_here(column, context, state)
        correcting = column.column(align=True)
        correcting.operator(DRAGGING, icon="EMPTY_ARROWS", depress=job_is_running(context, DRAGGING))
        row = panel.side_by_side(correcting)
        posing = take.armature is not None and take.armature.mode == "POSE"
        limbs = selected_limbs(take) if posing else []
        flip = f"Flip {LIMBS[limbs[0]].title()}" if len(limbs) == 1 else "Flip Depth"
        row.operator("keymark.flip_depth", text=flip, translate=False, icon="MOD_MIRROR")
        row.operator_menu_enum("keymark.turn_performer", "facing", icon="FILE_REFRESH")
        correcting.operator_menu_enum("keymark.copy_neighbor", "direction", icon="COPYDOWN")


def _draw_found(column: UILayout, context: Context, state: TakeState) -> None:
    matching = state.take.matching
    source = (matching, "matches", matching, "shown_match")
    column.template_list("KEYMARK_UL_matches", "", *source, rows=3, maxrows=3)
    count, doubtful = state.found_count, len(state.doubtful)
    row = column.row(align=True)
    going = row.row(align=True)
    going.enabled = doubtful > 0
    words = f"Next Doubtful ({doubtful} of {count})" if doubtful else f"None of {count} Doubtful"
    jump = going.operator("keymark.jump_to_match", text=words, translate=False, icon="NEXT_KEYFRAME")
    jump.direction, jump.only_doubtful = "NEXT", True
    _draw_side_view(row, context)
    index = state.match_at(steady_frame(context))
    if index < 0:
        if state.sure_by_poses:
            draw_sentence(column, context, matching.reason, "INFO")
        return
    match = matching.matches[index]
    box = column.column(align=True)
    is_found = state.of_match(match) == "FOUND"
    _draw_candidates(box, match, "keymark.replace_match", is_found)
    row = column.row(align=True)
    accept = row.row(align=True)
    accept.enabled = is_found
    accept.operator("keymark.accept_match", icon="CHECKMARK")
    row.operator("keymark.remove_match", icon="X")


def _draw_side_view(row: UILayout, context: Context) -> None:
    aside = context.space_data.region_3d.view_perspective != "CAMERA"
    row.operator("keymark.look_from_side", text="", icon="AXIS_SIDE", depress=aside)


def _draw_candidates(layout: UILayout, match: PropertyGroup, operator: str, is_shown: bool = True) -> None:
    for index, candidate in enumerate(match.candidates[:MOST_SHOWN]):
        row = layout.row(align=True)
        button = row.operator(
            operator,
            text=f"{index + 1}  {candidate_title(match, candidate)}",
            translate=False,
            icon=candidate_icon(index),
            depress=is_shown and index == match.chosen,
        )
        button.candidate = index
        if candidate.mirrored and match.library != COMPOSED:
            row.label(text="", icon="MOD_MIRROR")
        _draw_percent(row, candidate.confidence)


def _draw_proposed(column: UILayout, context: Context, state: TakeState) -> None:
    proposed, left, posed = len(state.proposed), len(state.unposed), len(state.posed)
    if not proposed:
        _draw_propose(column, context)
        return
    done = proposed - left
    text = f"{done} of {proposed} posed" + (f", {posed - done} elsewhere" if posed > done else "")
    draw_sentence(column, context, text, "INFO" if left else "CHECKMARK")
    row = column.row(align=True)
    row.operator("keymark.jump_to_proposal", text="", icon="PREV_KEYFRAME").direction = "PREVIOUS"
    going = row.operator("keymark.jump_to_proposal", text="Next to Pose")
    going.direction, going.skip_posed = "NEXT", True
    row.operator("keymark.jump_to_proposal", text="", icon="NEXT_KEYFRAME").direction = "NEXT"


def _draw_propose(layout: UILayout, context: Context) -> None:
    if not draw_progress(layout, context, "keymark.propose_keyframes"):
        layout.operator("keymark.propose_keyframes", icon="MARKER_HLT")


def _draw_here(column: UILayout, context: Context, state: TakeState) -> None:
    frame = round(steady_frame(context))
    if state.shown_action in state.kept_actions and not state.shows_keyframes:
        column.operator("keymark.show_action", text="Show Keyframes", icon="ERROR").which = "KEYFRAMES"
        return
    if any(round(posed) == frame for posed in state.posed):
        column.label(text=f"Frame {frame} is posed", icon="KEYFRAME_HLT", translate=False)
    elif has_frame(state.matched, frame):
        pass  # the list of found ones shows it
    elif frame in state.proposed:
        column.label(text=f"Frame {frame} is proposed, not posed yet", icon="KEYFRAME", translate=False)
    else:
        column.label(text=f"Frame {frame} is not posed", icon="DOT", translate=False)
    panel.draw_contradictions(column, context, state)
    posing = column.column(align=True)
    if not draw_progress(posing, context, "keymark.fit_pose"):
        row = panel.side_by_side(posing)
        row.operator("keymark.fit_pose", text="Fit Pose", icon="ARMATURE_DATA").start = "KEYFRAMES"
        row.operator("keymark.store_keyframe", icon="KEY_HLT")
    offered = state.offered_at(context.scene.frame_current_final)
    if offered is not None:
        head = posing.row(align=True)
        head.label(text=f"Frame {offered.frame:g} may show", translate=False)
        _draw_side_view(head, context)
        _draw_candidates(posing, offered, "keymark.show_offered")


class KEYMARK_PT_keyframes_options(Popover, bpy.types.Panel):
    """The floor, proposed frames, and the Action with the keyframes."""

    bl_label = "Options of Poses"

    def draw(self, context: Context) -> None:
        take, column = active_take(context.scene), self.column()
        matching = take.matching
        column.prop(matching, "floor")
        if matching.floor == "HEIGHT":
            column.prop(matching, "floor_height")
        elif matching.is_property_set("floor_found"):
            found = column.row()
            found.enabled = False
            found.prop(matching, "floor_found")
        column.operator("keymark.fit_pose", text="Fit from Current Pose", icon="POSE_HLT").start = "POSE"
        column.separator()
        column.prop(take, "keyframe_count")
        _draw_propose(column, context)
        column.operator("keymark.remove_found", icon="TRASH")
        column.prop(take, "keyframe_action", text="Action")
