"""The panel of step 2, What to Follow, in the viewport and the Movie Clip editor, and the panels in it.

A take is held against markers, keypoints, tracks and contours; each has a switch in its header, and beside it
what it sees in this frame.
"""

from collections.abc import Callable

import bpy

from ..shell.panel import ClipFollowPanel, FollowPanel, draw_readout, draw_sentence, draw_switch
from ..shell.step_panel import StepPanel
from ..shell.takes import active_take, find_take

Readout = Callable[[bpy.types.PropertyGroup], str]
Draw = Callable[[bpy.types.UILayout, bpy.types.Context, bpy.types.PropertyGroup], None]


class KEYMARK_PT_follow(StepPanel, bpy.types.Panel):
    """What the motion is held against in the footage."""

    bl_label = "What to Follow"
    step = "follow"

    @classmethod
    def summary(cls, take: bpy.types.PropertyGroup) -> str:
        follow = take.follow
        used = (
            ("Markers", follow.use_markers and len(take.markers)),
            ("Keypoints", follow.use_keypoints and (len(follow.files) or len(follow.clicks))),
        )
        return ", ".join(name for name, is_used in used if is_used)

    def draw_step(self, context: bpy.types.Context) -> None:
        _draw_hint(self.body, context)


class KEYMARK_PT_clip_follow(bpy.types.Panel):
    """The same in the Movie Clip editor."""

    bl_label = "What to Follow"
    bl_space_type = "CLIP_EDITOR"
    bl_region_type = "UI"
    bl_category = "Keymark"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return find_take(context.scene) is not None

    def draw(self, context: bpy.types.Context) -> None:
        if context.space_data.clip != active_take(context.scene).clip:
            self.layout.label(text="The editor shows another clip", icon="INFO")
        _draw_hint(self.layout, context)


def _draw_hint(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    take = active_take(context.scene)
    if len(take.markers) or len(take.follow.files) or len(take.follow.clicks):
        return
    hint = "Any clothes will do: detect or load keypoints. Five strong colors tell most"
    draw_sentence(layout, context, hint, "INFO")


def evidence_panels(
    kind: str, readout: Readout, draw_kind: Draw, closed: tuple[bool, bool] = (False, False)
) -> list[type]:
    """The panels of a kind of evidence in the viewport and in the Movie Clip editor.

    Args:
        kind: Its plural, as in the name of its switch.
        readout: What is seen in this frame, for the header.
        draw_kind: Draws the panel's inside.
        closed: Whether each of the two is closed at first.
    """

    def draw_header(self: bpy.types.Panel, context: bpy.types.Context) -> None:
        draw_switch(self.layout, context, f"use_{kind}")

    def draw_header_preset(self: bpy.types.Panel, context: bpy.types.Context) -> None:
        draw_readout(self.layout, readout(active_take(context.scene)))

    def draw(self: bpy.types.Panel, context: bpy.types.Context) -> None:
        take = active_take(context.scene)
        self.layout.active = getattr(take.follow, f"use_{kind}")
        draw_kind(self.layout, context, take)

    drawing = {"draw_header": draw_header, "draw_header_preset": draw_header_preset, "draw": draw}
    panels = []
    bases = (("KEYMARK_PT_", FollowPanel), ("KEYMARK_PT_clip_", ClipFollowPanel))
    for (prefix, base), is_closed in zip(bases, closed, strict=True):
        options = {"bl_options": {"DEFAULT_CLOSED"}} if is_closed else {}
        fields = {"bl_label": kind.title(), "__module__": __name__, **options, **drawing}
        panels.append(type(prefix + kind, (base, bpy.types.Panel), fields))
    return panels


register, unregister = bpy.utils.register_classes_factory((KEYMARK_PT_follow, KEYMARK_PT_clip_follow))
