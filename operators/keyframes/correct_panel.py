"""The panel that corrects a pose by choosing and dragging."""

import bpy

from ..shell.job_progress import job_is_running
from ..shell.panel import TakePanel, side_by_side
from ..shell.takes import active_take
from .corrections import DRAGGING
from .limb_selection import TITLES, selected_limbs


class KEYMARK_PT_keyframes_correct(TakePanel, bpy.types.Panel):
    """Dragging joints, flipping depth, turning the performer, and copying a neighbor."""

    bl_label = "Correct"
    bl_parent_id = "KEYMARK_PT_keyframes"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the operators; the button that flips names what is selected."""
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


register, unregister = bpy.utils.register_classes_factory((KEYMARK_PT_keyframes_correct,))
