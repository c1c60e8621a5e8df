"""The panel of step 2, What to Follow, in the viewport and the Movie Clip editor.

A take is held against markers, keypoints, tracks and contours; each has a switch in its header, and beside it
what it sees in this frame.
"""

import bpy

from ..shell.panel import draw_sentence
from ..shell.step_panel import StepPanel
from ..shell.takes import active_take, find_take


class KEYMARK_PT_follow(StepPanel, bpy.types.Panel):
    """What the motion is held against in the footage."""

    bl_label = "What to Follow"
    step = "follow"

    @classmethod
    def summary(cls, take: bpy.types.PropertyGroup) -> str:
        """What is followed, beside the contours."""
        follow = take.follow
        used = (
            ("Markers", follow.use_markers and len(take.markers)),
            ("Keypoints", follow.use_keypoints and (len(follow.files) or len(follow.clicks))),
        )
        return ", ".join(name for name, is_used in used if is_used)

    def draw_step(self, context: bpy.types.Context) -> None:
        """Draw what to begin with, until there is something."""
        _draw_hint(self.body, context)


class KEYMARK_PT_clip_follow(bpy.types.Panel):
    """The same in the Movie Clip editor."""

    bl_label = "What to Follow"
    bl_space_type = "CLIP_EDITOR"
    bl_region_type = "UI"
    bl_category = "Keymark"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether there is a take."""
        return find_take(context.scene) is not None

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the same, or that the editor shows something else."""
        if context.space_data.clip != active_take(context.scene).clip:
            self.layout.label(text="The editor shows another clip", icon="INFO")
        _draw_hint(self.layout, context)


def _draw_hint(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    take = active_take(context.scene)
    if len(take.markers) or len(take.follow.files) or len(take.follow.clicks):
        return
    hint = "Any clothes will do: detect or load keypoints. Five strong colors tell most"
    draw_sentence(layout, context, hint, "INFO")


register, unregister = bpy.utils.register_classes_factory((KEYMARK_PT_follow, KEYMARK_PT_clip_follow))
