"""The sidebar's main panel: the takes, the running job, or the next step of the work on a take."""

import bpy

from ..follow.evidence import has_contours, has_keypoints
from ..footage.camera_view import keep_beside_sidebar
from ..library import registry
from ..overlays.timeline import DOUBTED
from ..shell.keyed_frames import doubtful_matches, is_posed, keyframes_of, matched_frames, unposed_proposals
from ..shell.panel import Popover, RowList, SidebarPanel, draw_progress, draw_sentence, sentence_height
from ..shell.takes import find_take, has_lost_actor, placement_is_guess, present_actor
from .upgrade import is_newer


def next_step(take: bpy.types.PropertyGroup) -> str:
    """The next step, from properties alone, in a label short enough for a narrow sidebar."""
    if take.clip is None:
        return "Next: load the footage"
    if take.clip_state.missing:
        return "Next: find the clip's file"
    if placement_is_guess(take):
        return "Next: say where the camera stood"
    follow = take.follow
    if follow.use_markers and any(not marker.is_picked for marker in take.markers):
        return "Next: pick the markers' colors"
    if has_lost_actor(take):
        return "Next: bring the actor back"
    has_actor = present_actor(take) is not None
    followed = (follow.use_markers and len(take.markers)) or has_keypoints(take)
    # Contours need nothing to be done: whoever goes on to the actor follows these alone.
    if not followed and not (has_actor and has_contours(take)):
        return "Next: choose what to follow"
    if not has_actor:
        return "Next: build the actor"
    if not len(take.proposals) and not keyframes_of(take):
        return "Next: pose all keyframes" if followed else "Next: propose keyframes"
    if take.motion_action is None:
        if unposed_proposals(take) and not matched_frames(take):
            return "Next: pose all keyframes" if followed else "Next: pose the proposed frames"
        if len(keyframes_of(take)) < 2:
            return "Next: pose and store keyframes"
        if doubtful_matches(take):
            return "Next: check the doubtful poses"
        return "Next: reconstruct the motion"
    if (take.finish.action is None or take.finish.outdated) and is_doubtful(take):
        return _how_to_better(take)
    if take.finish.outdated:
        return "Next: review, then bake again"
    if any(result.outdated for character in take.characters for result in character.results):
        return "Next: retarget again"
    if not any(result.action for character in take.characters for result in character.results):
        finished = take.finish.action is not None
        return "Next: a character, or export" if finished else "Next: review, then a character"
    return "Next: export, or another take"


def is_doubtful(take: bpy.types.PropertyGroup) -> bool:
    """Whether a take's motion is to be corrected and not finished: no better than chance."""
    return 0.0 <= take.review.confidence < DOUBTED


def _how_to_better(take: bpy.types.PropertyGroup) -> str:
    """What makes a doubtful motion better: the keyframes are what it lacks."""
    weak = [each.frame for each in take.review.weak_frames]
    if doubtful_matches(take):
        return "Next: check the doubtful poses"
    if any(not is_posed(take, frame) for frame in weak):
        return "Next: pose the weak frames"
    return "Next: reconstruct again" if weak else "Next: pose more keyframes"


STEPS = (
    ("FILE_MOVIE", "Clip: load it, say where the camera stood"),
    ("OUTLINER_OB_ARMATURE", "Performer: height, and what is followed"),
    ("KEY_HLT", "Poses: pose all, then correct the doubtful ones"),
    ("ARMATURE_DATA", "Motion: every frame in between, and its review"),
    ("COMMUNITY", "Character: the motion on your own rig"),
    ("EXPORT", "Export: final Action, asset, files"),
)
"""Icon and label of each step."""


class KEYMARK_UL_takes(RowList, bpy.types.UIList):
    """Takes by name; the icon tells whether a take has a motion."""

    def draw_row(
        self, context: bpy.types.Context, layout: bpy.types.UILayout, item: bpy.types.PropertyGroup
    ) -> None:
        row = layout.row(align=True)
        done = item.motion_action is not None
        row.prop(item, "name", text="", emboss=False, icon="ACTION" if done else "FILE_MOVIE")
        if item.clip_state.missing:
            row.label(text="", icon="ERROR")


class KEYMARK_MT_take(bpy.types.Menu):
    """Ways to add a take, and to remove one."""

    bl_label = "Takes"

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.operator("keymark.add_performer", icon="USER")
        another = layout.operator("keymark.load_footage", text="Load Another Clip", icon="FILE_MOVIE")
        another.as_new_take = True
        layout.menu("KEYMARK_MT_clips", icon="TRACKER")
        layout.operator("keymark.open_take", icon="FILE_FOLDER")
        layout.operator("keymark.open_example", icon="PLAY")
        layout.separator()
        layout.operator("keymark.remove_take", icon="REMOVE")
        entry = layout.operator("keymark.remove_take", text="Remove Take and Its Data", icon="TRASH")
        entry.delete_data = True
        layout.separator()
        layout.popover("KEYMARK_PT_guide", icon="HELP")


class KEYMARK_PT_guide(Popover, bpy.types.Panel):
    """The steps from a video to a character, one line each."""

    bl_label = "How It Works"
    bl_ui_units_x = 16

    def draw(self, context: bpy.types.Context) -> None:
        column = self.layout.column(align=True)
        for icon, text in STEPS:
            column.label(text=text, icon=icon, translate=False)


class KEYMARK_PT_main(SidebarPanel, bpy.types.Panel):
    """The takes, and the running job or the next step."""

    bl_label = "Keymark"

    def draw_header_preset(self, context: bpy.types.Context) -> None:
        if find_take(context.scene) is not None:
            self.layout.popover("KEYMARK_PT_overlays", text="", icon="OVERLAY")

    def draw(self, context: bpy.types.Context) -> None:
        registry.refresh_if_empty()
        keep_beside_sidebar(context)
        layout, take = self.layout, find_take(context.scene)
        if is_newer(context.scene):
            box = layout.box().column(align=True)
            box.label(text="A newer Keymark wrote this file", icon="ERROR")
            box.label(text="Update Keymark before editing", icon="BLANK1")
        if take is None:
            if not draw_progress(layout, context):
                _draw_beginning(layout)
            return
        _draw_takes(layout, context.scene.keymark)
        # As high as the sentence, so that nothing moves when a job begins or ends.
        sentence = next_step(take)
        row = layout.row()
        row.scale_y = sentence_height(context, sentence)
        if not draw_progress(row, context):
            row.scale_y = 1.0
            draw_sentence(row, context, sentence, "FORWARD")


def _draw_beginning(layout: bpy.types.UILayout) -> None:
    """Draw what to begin with in an empty scene."""
    row = layout.row()
    row.scale_y = 2.4
    row.operator("keymark.animate", icon="PLAY")
    column = layout.column()
    column.scale_y = 1.6
    column.operator("keymark.load_footage", icon="FILE_MOVIE")
    column.operator("keymark.open_take", icon="FILE_FOLDER")
    column.operator("keymark.open_example", icon="PLAY")
    column.popover("KEYMARK_PT_guide", icon="HELP")
    elsewhere = layout.row(align=True)
    elsewhere.operator("keymark.load_motion", icon="IMPORT")
    elsewhere.operator("keymark.mend_motion", icon="MOD_SMOOTH")
    if bpy.data.movieclips:
        layout.menu("KEYMARK_MT_clips", icon="TRACKER")


def _draw_takes(layout: bpy.types.UILayout, settings: bpy.types.PropertyGroup) -> None:
    """Draw the list of takes; a single take is one row."""
    row = layout.row(align=len(settings.takes) == 1)
    if len(settings.takes) == 1:
        row.prop(settings.takes[0], "name", text="", icon="FILE_MOVIE")
    else:
        row.template_list(
            "KEYMARK_UL_takes", "", settings, "takes", settings, "active_take", rows=3, maxrows=4
        )
    row.menu("KEYMARK_MT_take", text="", icon="DOWNARROW_HLT")
