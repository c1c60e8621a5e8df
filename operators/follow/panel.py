"""What is followed in the clip: a switch for each kind of evidence, what it sees in this frame, its settings.

The viewport's sidebar shows them in the step Performer, and the Movie Clip editor in a panel of their own.
"""

import bpy

from ..shell.panel import draw_readout, draw_sentence
from ..shell.steps import KINDS
from ..shell.takes import active_take, find_take
from . import keypoint_panel, marker_panel
from .frame_keypoints import contours_label, keypoints_label, tracks_label
from .marker_styles import markers_label

DRAWN = {
    "markers": (markers_label, marker_panel.draw_markers),
    "keypoints": (keypoints_label, keypoint_panel.draw_keypoints),
    "tracks": (tracks_label, keypoint_panel.draw_tracks),
    "contours": (contours_label, keypoint_panel.draw_contours),
}
"""What each kind sees in this frame, and its settings."""


def draw_evidence(
    layout: bpy.types.UILayout, context: bpy.types.Context, take: bpy.types.PropertyGroup
) -> None:
    """Draw the kinds of evidence; one at most is unfolded."""
    if not followed(take):
        hint = "Any clothes will do: detect or load keypoints. Five strong colors tell most"
        draw_sentence(layout, context, hint, "INFO")
    layout.use_property_split = False  # a list's rows would be split too
    for kind in KINDS:
        readout, draw_settings = DRAWN[kind]
        header, body = layout.panel_prop(context.window_manager.keymark_steps, kind)
        header.prop(take.follow, f"use_{kind}", text=kind.title())
        draw_readout(header, readout(take))
        if body is not None:
            body.active = getattr(take.follow, f"use_{kind}")
            draw_settings(body, context, take)


def followed(take: bpy.types.PropertyGroup) -> str:
    """Names of the kinds that something was picked, loaded or clicked for."""
    follow = take.follow
    used = (
        ("Markers", follow.use_markers and len(take.markers)),
        ("Keypoints", follow.use_keypoints and (len(follow.files) or len(follow.clicks))),
    )
    return ", ".join(name for name, is_used in used if is_used)


class KEYMARK_PT_clip_follow(bpy.types.Panel):
    """The same in the Movie Clip editor."""

    bl_label = "Performer"
    bl_space_type = "CLIP_EDITOR"
    bl_region_type = "UI"
    bl_category = "Keymark"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return find_take(context.scene) is not None

    def draw_header_preset(self, context: bpy.types.Context) -> None:
        self.layout.popover("KEYMARK_PT_overlays", text="", icon="OVERLAY")

    def draw(self, context: bpy.types.Context) -> None:
        if context.space_data.clip != active_take(context.scene).clip:
            self.layout.label(text="The editor shows another clip", icon="INFO")
        draw_evidence(self.layout, context, active_take(context.scene))
