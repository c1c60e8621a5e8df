"""The panels of step 4, the keyframes."""

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
from ..shell.panel import TakePanel, draw_contradictions, draw_progress, draw_sentence, is_roomy, side_by_side
from ..shell.step_panel import StepPanel
from ..shell.takes import active_take
from .candidate_buttons import draw_candidates, draw_candidates_head
from .corrections import DRAGGING
from .flip_ways import TITLES, selected_limbs


class KEYMARK_PT_keyframes_correct(TakePanel, bpy.types.Panel):
    """Dragging joints, flipping depth, turning the performer, and copying a neighbor."""

    bl_label = "Correct"
    bl_parent_id = "KEYMARK_PT_keyframes"

    def draw(self, context: bpy.types.Context) -> None:
        take, column = active_take(context.scene), self.column()
        running = job_is_running(context, DRAGGING)
        column.operator(DRAGGING, icon="EMPTY_ARROWS", depress=running)
        row = side_by_side(column)
        row.operator("keymark.flip_depth", text=_flipped(take), translate=False, icon="MOD_MIRROR")
        row.operator_menu_enum("keymark.turn_performer", "facing", icon="FILE_REFRESH")
        row = column.row(align=True)
        row.label(text="Copy from Neighbor")
        for direction, icon in (("PREVIOUS", "PREV_KEYFRAME"), ("NEXT", "NEXT_KEYFRAME")):
            row.operator("keymark.copy_neighbor", text="", icon=icon).direction = direction


def _flipped(take: bpy.types.PropertyGroup) -> str:
    """What the button says that flips depth: the part of the body, where one alone is selected."""
    if take.armature is not None and take.armature.mode == "POSE":
        limbs = selected_limbs(take)
        if len(limbs) == 1:
            return f"Flip {TITLES[limbs[0]]}"
    return "Flip Depth"


class KEYMARK_PT_keyframes(StepPanel, bpy.types.Panel):
    """Jumping to a proposed frame, fitting a pose there, and storing it."""

    bl_label = "Keyframes"
    step = "keyframes"

    @classmethod
    def summary(cls, take: bpy.types.PropertyGroup) -> str:
        return f"{len(keyframes_of(take))} keyed" if take.keyframe_action else ""

    def draw_step(self, context: bpy.types.Context) -> None:
        take, column = active_take(context.scene), self.column()
        everything = column.column()
        everything.scale_y = 1.6
        if not draw_progress(everything, context, "keymark.pose_all"):
            everything.operator("keymark.pose_all", icon="OUTLINER_OB_ARMATURE")
        if not len(take.proposals):
            _draw_propose(column, context)
        _draw_posed(column, context, take)
        row = column.row(align=True)
        row.operator("keymark.jump_to_proposal", text="", icon="PREV_KEYFRAME").direction = "PREVIOUS"
        going = row.operator("keymark.jump_to_proposal", text="Next to Pose")
        going.direction, going.skip_posed = "NEXT", True
        row.operator("keymark.jump_to_proposal", text="", icon="NEXT_KEYFRAME").direction = "NEXT"
        _draw_here(column, round(steady_frame(context)), take)
        draw_contradictions(column, context, take)
        posing = column.column(align=True)
        posing.scale_y = 1.2
        if not draw_progress(posing, context, "keymark.fit_pose"):
            posing.operator("keymark.fit_pose", icon="ARMATURE_DATA").start = "KEYFRAMES"
        posing.operator("keymark.fit_pose", text="Fit from Current Pose", icon="POSE_HLT").start = "POSE"
        _draw_offered(column, context, take)
        column.operator("keymark.store_keyframe", icon="KEY_HLT")


def _draw_offered(
    layout: bpy.types.UILayout, context: bpy.types.Context, take: bpy.types.PropertyGroup
) -> None:
    """Draw the poses that the frame may show, if it was fitted and is not keyed."""
    offered = offered_at(take, context.scene.frame_current_final)
    if offered is None:
        return
    box = layout.column(align=True)
    draw_candidates_head(box, context, offered)
    draw_candidates(box, offered, "keymark.show_offered")


def _draw_propose(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw the button that proposes frames, or the progress of its job."""
    if not draw_progress(layout, context, "keymark.propose_keyframes"):
        layout.operator("keymark.propose_keyframes", icon="MARKER_HLT")


def _draw_posed(
    layout: bpy.types.UILayout, context: bpy.types.Context, take: bpy.types.PropertyGroup
) -> None:
    """Draw the numbers of proposed frames that are posed, of other posed frames, and of found ones."""
    proposed, left, posed = len(proposed_frames(take)), len(unposed_proposals(take)), len(posed_frames(take))
    found = len(matched_frames(take))
    done = proposed - left
    if found:
        text = f"{posed} posed, {found} found"
    elif proposed:
        text = f"{done} of {proposed} posed" + (f", {posed - done} elsewhere" if posed > done else "")
    else:
        text = f"{posed} posed; none proposed yet"
    ready = not left and (found or proposed)
    draw_sentence(layout, context, text, "CHECKMARK" if ready else "INFO")


def _draw_here(layout: bpy.types.UILayout, frame: int, take: bpy.types.PropertyGroup) -> None:
    """Draw whether this frame is posed, found or proposed, or that the motion is shown instead."""
    data = take.armature.animation_data if take.armature is not None else None
    shown = data.action if data is not None else None
    if shown is not None and shown in (take.motion_action, take.finish.action):
        row = layout.row(align=True)
        if is_roomy(bpy.context):
            row.label(text="Motion shown", icon="ERROR")
        row.operator("keymark.show_action", text="Show Keyframes").which = "KEYFRAMES"
    elif any(round(posed) == frame for posed in posed_frames(take)):
        layout.label(text=f"Frame {frame} is posed", icon="KEYFRAME_HLT", translate=False)
    elif has_frame(matched_frames(take), frame):
        layout.label(text=f"Frame {frame} is found, not posed", icon="KEYTYPE_GENERATED_VEC", translate=False)
    elif frame in proposed_frames(take):
        layout.label(text=f"Frame {frame} is proposed, not posed yet", icon="KEYFRAME", translate=False)
    else:
        layout.label(text=f"Frame {frame} is not posed", icon="DOT", translate=False)


class KEYMARK_PT_keyframes_proposals(TakePanel, bpy.types.Panel):
    """The proposed frames, and the Action with the keyframes."""

    bl_label = "Proposals"
    bl_parent_id = "KEYMARK_PT_keyframes"
    bl_options = {"DEFAULT_CLOSED"}
    bl_order = 1

    def draw(self, context: bpy.types.Context) -> None:
        take, column = active_take(context.scene), self.column()
        column.prop(take, "keyframe_count")
        _draw_propose(column, context)
        column.separator()
        column.prop(take, "keyframe_action", text="Action")


register, unregister = bpy.utils.register_classes_factory(
    (KEYMARK_PT_keyframes, KEYMARK_PT_keyframes_proposals, KEYMARK_PT_keyframes_correct)
)
