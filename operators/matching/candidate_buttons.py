"""The candidates of a frame as buttons in their figures' colors, keyed already or offered."""

import bpy

from ...core.library.several_libraries import COMPOSED
from ..overlays.style import candidate_icon
from .candidate_titles import candidate_title

PERCENT_UNITS = 2.1


def percent(share: float) -> str:
    """A probability in percent."""
    return f"{100.0 * share:.0f} %"


def draw_candidates_head(
    layout: bpy.types.UILayout, context: bpy.types.Context, match: bpy.types.PropertyGroup
) -> None:
    """Draw which frame they are of, and how they are looked at."""
    head = layout.row(align=True)
    head.label(text=f"Frame {match.frame:g} may show", translate=False)
    head.prop(context.scene.keymark.overlays, "show_candidates", text="", icon="GHOST_ENABLED")
    aside = context.space_data.region_3d.view_perspective != "CAMERA"
    head.operator("keymark.look_from_side", text="", icon="AXIS_SIDE", depress=aside)


def draw_candidates(
    layout: bpy.types.UILayout, match: bpy.types.PropertyGroup, operator: str, is_shown: bool = True
) -> None:
    """Draw a row for each candidate, whose button calls an operator with its index.

    Args:
        layout: Where they are drawn.
        match: Their frame.
        operator: The operator.
        is_shown: Whether the frame has one of them; if not, it was posed in another way.
    """
    for index, candidate in enumerate(match.candidates):
        row = layout.row(align=True)
        button = row.operator(
            operator,
            text=f"{index + 1}  {candidate_title(match, candidate)}",
            translate=False,
            icon=candidate_icon(index),
            depress=is_shown and index == match.chosen,
        )
        button.candidate = index
        if candidate.mirrored and match.library != COMPOSED:
            row.label(text="", icon="MOD_MIRROR")
        said = row.row()
        said.ui_units_x = PERCENT_UNITS
        said.alignment = "RIGHT"
        said.label(text=percent(candidate.confidence), translate=False)
