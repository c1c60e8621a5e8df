"""The review in the panel of the motion: confidence, and weak frames."""

import bpy

from ..follow.marker_properties import segment_title
from ..shell.keyed_frames import is_posed
from ..shell.panel import RowList, draw_sentence
from ..shell.takes import active_take


class KEYMARK_UL_weak_frames(RowList, bpy.types.UIList):
    """Weak frames, the one that needs a keyframe most first: frame, and reason."""

    def draw_row(
        self, context: bpy.types.Context, layout: bpy.types.UILayout, item: bpy.types.PropertyGroup
    ) -> None:
        row = layout.row(align=True)
        number = row.row()
        number.ui_units_x = 2.2
        number.label(text=f"{item.frame:g}")
        reason = item.bl_rna.properties["reason"].enum_items[item.reason]
        row.label(text=reason_words(item), icon=reason.icon, translate=False)
        if is_posed(active_take(context.scene), item.frame):
            row.label(text="", icon="KEYTYPE_KEYFRAME_VEC")


def reason_words(item: bpy.types.PropertyGroup) -> str:
    """The reason of a weak frame, with the marker or the body point that it lies with."""
    words = item.bl_rna.properties["reason"].enum_items[item.reason].name
    what = "" if item.reason == "FAR" else item.marker or (item.point and segment_title(item.point))
    return f"{words}: {what}" if what else words


def draw_review(
    column: bpy.types.UILayout, context: bpy.types.Context, take: bpy.types.PropertyGroup
) -> None:
    """Draw how sure the motion is, and the frames worth another keyframe."""
    from ...core.review.confidence import TOLERANCE_SHARE

    review = take.review
    if review.confidence >= 0.0:
        near_cm = 100.0 * TOLERANCE_SHARE * take.stature
        words = f"Joints Within {near_cm:.0f} cm: {100.0 * review.confidence:.0f} %"
        column.progress(factor=review.confidence, text=words, type="BAR")
    if not len(review.weak_frames):
        draw_sentence(column, context, "No frame needs another keyframe", "CHECKMARK")
        return
    column.label(text="Worth Another Keyframe")
    column.template_list(
        "KEYMARK_UL_weak_frames", "", review, "weak_frames", review, "active_weak_frame", rows=4
    )
    row = column.row(align=True)
    row.operator("keymark.jump_to_weak_frame", text="", icon="TRIA_UP").direction = "PREVIOUS"
    row.operator("keymark.pose_from_motion", icon="KEY_HLT").where = "WEAK"
    row.operator("keymark.jump_to_weak_frame", text="", icon="TRIA_DOWN").direction = "NEXT"
