"""The sidebar's main panel: the takes, the running job, or the next step of the work on a take."""

import bpy
from bpy.types import Context, PropertyGroup, UILayout

from ...core.errors import pluralize
from ..footage.camera_view import keep_beside_sidebar
from ..library import registry
from ..shell.panel import Popover, RowList, SidebarPanel, draw_progress, draw_sentence, sentence_height
from ..shell.take_state import DOUBTFUL, TakeState
from ..shell.takes import find_take
from .upgrade import is_newer

BUTTON_PX, BUTTON_UNITS = 70.0, 3.5
"""Width of the button beside the headline, at a UI scale of 1 and in Blender's units."""
GOOD = 0.8
"""Share of joints near their true places beyond which a motion is good as it is."""
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

    def draw_row(self, context: Context, layout: UILayout, item: PropertyGroup) -> None:
        row = layout.row(align=True)
        done = item.motion_action is not None
        row.prop(item, "name", text="", emboss=False, icon="ACTION" if done else "FILE_MOVIE")
        if item.clip_state.missing:
            row.label(text="", icon="ERROR")


class KEYMARK_MT_take(bpy.types.Menu):
    """Ways to add a take, and to remove one."""

    bl_label = "Takes"

    def draw(self, context: Context) -> None:
        layout = self.layout
        layout.operator("keymark.add_performer", icon="USER")
        another = layout.operator("keymark.load_footage", text="Load Another Clip", icon="FILE_MOVIE")
        another.as_new_take = True
        layout.menu("KEYMARK_MT_clips", icon="TRACKER")
        layout.operator("keymark.open_take", icon="FILE_FOLDER")
        layout.operator("keymark.open_example", icon="PLAY")
        layout.operator("keymark.load_motion", icon="IMPORT")
        layout.operator("keymark.mend_motion", icon="MOD_SMOOTH")
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

    def draw(self, context: Context) -> None:
        column = self.layout.column(align=True)
        for icon, text in STEPS:
            column.label(text=text, icon=icon, translate=False)


class KEYMARK_PT_main(SidebarPanel, bpy.types.Panel):
    """The takes, and the running job or the next step."""

    bl_label = "Keymark"

    def draw_header_preset(self, context: Context) -> None:
        if find_take(context.scene) is not None:
            row = self.layout.row(align=True)
            row.prop(context.scene.keymark.overlays, "only_character", text="", icon="COMMUNITY")
            row.popover("KEYMARK_PT_overlays", text="", icon="OVERLAY")

    def draw(self, context: Context) -> None:
        registry.refresh_if_empty()
        keep_beside_sidebar(context)
        layout, take = self.layout, find_take(context.scene)
        if is_newer(context.scene):
            box = layout.box().column(align=True)
            box.label(text="A newer Keymark wrote this file", icon="ERROR")
            box.label(text="Update Keymark before editing", icon="BLANK1")
        if take is None:
            if not draw_progress(layout, context):
                _draw_beginning(layout, context)
            return
        settings = context.scene.keymark
        row = layout.row(align=len(settings.takes) == 1)
        if len(settings.takes) == 1:
            row.prop(take, "name", text="", icon="FILE_MOVIE")
        else:
            row.template_list(
                "KEYMARK_UL_takes", "", settings, "takes", settings, "active_take", rows=3, maxrows=4
            )
        row.menu("KEYMARK_MT_take", text="", icon="DOWNARROW_HLT")
        # As high as the sentence, so that nothing moves when a job begins or ends.
        sentence, action, text = _headline(TakeState(take))
        beside_px = BUTTON_PX if action else 0.0
        row = layout.row(align=True)
        row.scale_y = sentence_height(context, sentence, beside_px)
        if not draw_progress(row, context):
            row.scale_y = 1.0
            draw_sentence(row, context, sentence, "FORWARD", beside_px=beside_px)
            if action:
                button = row.row()
                button.ui_units_x = BUTTON_UNITS  # else it takes half of the row
                drawn = button.operator(action, text=text)
                if action == "keymark.pose_from_motion":
                    drawn.where = "WEAK"


def _headline(state: TakeState) -> tuple[str, str, str]:
    """What is next, or how good the motion is; and the operator and the text of a button for it, if any."""
    step, words = state.next
    if state.is_outdated:
        return f"Next: {words}", "keymark.update", "Update"
    sure, count = state.confidence, len(state.open_weak)
    if (
        state.take.motion_action is None
        or sure < 0.0
        or not count
        or (sure < DOUBTFUL and step == "reconstruct")
    ):
        return f"Next: {words}", "", ""
    good = "Good" if sure >= GOOD else "Good for blocking" if sure >= DOUBTFUL else "Doubtful"
    frames = pluralize(count, "frame is", "frames are")
    return f"{good}; {frames} worth correcting", "keymark.pose_from_motion", "Start"


def _draw_beginning(layout: UILayout, context: Context) -> None:
    draw_sentence(layout, context, "A video of a person becomes animation on your character", "INFO")
    row = layout.row()
    row.scale_y = 2.4
    row.operator("keymark.animate", icon="RENDER_ANIMATION")
    draw_sentence(layout, context, "Or step by step, or mend a motion of another program:", "BLANK1")
    column = layout.column()
    column.scale_y = 1.4
    column.operator("keymark.load_footage", icon="FILE_MOVIE")
    column.operator("keymark.open_take", icon="FILE_FOLDER")
    column.operator("keymark.open_example", icon="PLAY")
    elsewhere = column.row(align=True)
    elsewhere.operator("keymark.load_motion", icon="IMPORT")
    elsewhere.operator("keymark.mend_motion", icon="MOD_SMOOTH")
    column.popover("KEYMARK_PT_guide", icon="HELP")
    if bpy.data.movieclips:
        layout.menu("KEYMARK_MT_clips", icon="TRACKER")
