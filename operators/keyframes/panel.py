"""The panel of the third step: poses found or posed, the choice for a frame, and corrections."""

import bpy

from ..shell.job_progress import job_is_running, steady_frame
from ..shell.keyed_frames import (
    has_frame,
    keyframes_of,
    matched_frames,
    offered_at,
    posed_frames,
    proposed_frames,
    unposed_proposals,
)
from ..shell.panel import Popover, draw_contradictions, draw_progress, draw_sentence, side_by_side
from ..shell.step_panel import StepPanel
from ..shell.takes import active_take
from .candidate_buttons import draw_candidates, draw_candidates_head
from .corrections import DRAGGING
from .flip_ways import TITLES, selected_limbs
from .found_panel import draw_found


class KEYMARK_PT_keyframes(StepPanel, bpy.types.Panel):
    """Posing all frames, or one, and correcting what is wrong."""

    bl_label = "Poses"
    step = "keyframes"
    options = "KEYMARK_PT_keyframes_options"

    @classmethod
    def summary(cls, take: bpy.types.PropertyGroup) -> str:
        return f"{len(keyframes_of(take))} keyed" if take.keyframe_action else ""

    @classmethod
    def action(cls, take: bpy.types.PropertyGroup) -> tuple[str, str]:
        return ("keymark.pose_all", "Pose All") if take.keyframe_action is None else ("", "")

    def draw_step(
        self, context: bpy.types.Context, body: bpy.types.UILayout, take: bpy.types.PropertyGroup
    ) -> None:
        column = body.column()
        everything = column.row(align=True)
        everything.scale_y = 1.4
        if not draw_progress(everything, context, "keymark.pose_all"):
            everything.operator("keymark.pose_all", icon="OUTLINER_OB_ARMATURE")
            everything.popover("KEYMARK_PT_libraries", text="", icon="ASSET_MANAGER")
        if len(take.matching.matches):
            draw_found(column, context, take)
        else:
            _draw_proposed(column, context, take)
        _draw_here(column, context, take)
        _draw_corrections(column, context, take)


def _draw_proposed(
    column: bpy.types.UILayout, context: bpy.types.Context, take: bpy.types.PropertyGroup
) -> None:
    """Draw how many of the proposed frames are posed and the way to the next, or the button that proposes."""
    proposed, left, posed = len(proposed_frames(take)), len(unposed_proposals(take)), len(posed_frames(take))
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


def _draw_propose(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw the button that proposes frames, or the progress of its job."""
    if not draw_progress(layout, context, "keymark.propose_keyframes"):
        layout.operator("keymark.propose_keyframes", icon="MARKER_HLT")


def _draw_here(column: bpy.types.UILayout, context: bpy.types.Context, take: bpy.types.PropertyGroup) -> None:
    """Draw what this frame holds, what contradicts in it, and how its pose is fitted and stored."""
    frame = round(steady_frame(context))
    data = take.armature.animation_data if take.armature is not None else None
    shown = data.action if data is not None else None
    if shown is not None and shown in (take.motion_action, take.finish.action):
        column.operator("keymark.show_action", text="Show Keyframes", icon="ERROR").which = "KEYFRAMES"
        return
    if any(round(posed) == frame for posed in posed_frames(take)):
        column.label(text=f"Frame {frame} is posed", icon="KEYFRAME_HLT", translate=False)
    elif has_frame(matched_frames(take), frame):
        pass  # the list of found ones shows it
    elif frame in proposed_frames(take):
        column.label(text=f"Frame {frame} is proposed, not posed yet", icon="KEYFRAME", translate=False)
    else:
        column.label(text=f"Frame {frame} is not posed", icon="DOT", translate=False)
    draw_contradictions(column, context, take)
    posing = column.column(align=True)
    if not draw_progress(posing, context, "keymark.fit_pose"):
        row = side_by_side(posing)
        row.operator("keymark.fit_pose", text="Fit Pose", icon="ARMATURE_DATA").start = "KEYFRAMES"
        row.operator("keymark.store_keyframe", icon="KEY_HLT")
    offered = offered_at(take, context.scene.frame_current_final)
    if offered is not None:
        draw_candidates_head(posing, context, offered)
        draw_candidates(posing, offered, "keymark.show_offered")


def _draw_corrections(
    column: bpy.types.UILayout, context: bpy.types.Context, take: bpy.types.PropertyGroup
) -> None:
    """Draw dragging joints, flipping depth, turning the performer, and copying a neighbor."""
    correcting = column.column(align=True)
    running = job_is_running(context, DRAGGING)
    correcting.operator(DRAGGING, icon="EMPTY_ARROWS", depress=running)
    row = side_by_side(correcting)
    row.operator("keymark.flip_depth", text=_flipped(take), translate=False, icon="MOD_MIRROR")
    row.operator_menu_enum("keymark.turn_performer", "facing", icon="FILE_REFRESH")
    correcting.operator_menu_enum("keymark.copy_neighbor", "direction", icon="COPYDOWN")


def _flipped(take: bpy.types.PropertyGroup) -> str:
    """What the button says that flips depth: the part of the body, where one alone is selected."""
    if take.armature is not None and take.armature.mode == "POSE":
        limbs = selected_limbs(take)
        if len(limbs) == 1:
            return f"Flip {TITLES[limbs[0]]}"
    return "Flip Depth"


class KEYMARK_PT_keyframes_options(Popover, bpy.types.Panel):
    """What was found of the footage, the floor, proposed frames, and the Action with the keyframes."""

    bl_label = "Options of Poses"

    def draw(self, context: bpy.types.Context) -> None:
        take, column = active_take(context.scene), self.column()
        matching = take.matching
        if matching.reason:
            draw_sentence(column, context, matching.reason, "INFO")
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
