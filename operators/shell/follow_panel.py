"""Bases of the panels inside What to Follow: a switch in the header, beside it a readout of this frame."""

import bpy

from .panel import TakePanel, is_roomy
from .takes import active_take

MOST_LETTERS = 7
"""Of what fits beside a name in the header of a narrow sidebar: `13 of 17`, and no more."""


class FollowPanel(TakePanel):
    """A panel inside What to Follow in the viewport's sidebar."""

    bl_parent_id = "KEYMARK_PT_follow"


class ClipFollowPanel:
    """The same in the Movie Clip editor."""

    bl_space_type = "CLIP_EDITOR"
    bl_region_type = "UI"
    bl_category = "Keymark"
    bl_parent_id = "KEYMARK_PT_clip_follow"


def draw_switch(layout: bpy.types.UILayout, context: bpy.types.Context, switch: str) -> None:
    """Draw the switch of a kind of evidence."""
    layout.prop(active_take(context.scene).follow, switch, text="")


def draw_readout(layout: bpy.types.UILayout, text: str) -> None:
    """Draw what is seen in this frame, at the right end of a header, if it does not lie on the name there."""
    if not is_roomy(bpy.context) and len(text) > MOST_LETTERS:
        return
    row = layout.row()
    row.active = False
    row.label(text=text, translate=False)
