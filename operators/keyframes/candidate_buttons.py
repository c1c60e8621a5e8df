"""Titles of candidates: in what each differs from the first one."""

from math import degrees

import bpy

from ...core.prior.texts import COMPOSED
from ..overlays.drawing import candidate_icon

NOTICEABLE_TURN_DEG = 15.0
LIMBS = {"arm.L": "left arm", "arm.R": "right arm", "leg.L": "left leg", "leg.R": "right leg"}
"""As a candidate's property names them, and in words; pairs are named together."""
PAIRS = {("arm.L", "arm.R"): "arms", ("leg.L", "leg.R"): "legs"}


def candidate_title(match: bpy.types.PropertyGroup, candidate: bpy.types.PropertyGroup) -> str:
    """What tells a candidate from the first one: its turn, then the name of its posture.

    Postures that were composed have the name of one that they resemble, which often is the same for all and
    tells a person little: instead the limbs are named that are elsewhere.
    """
    turn = _turn(degrees(candidate.turned))
    if match.library != COMPOSED:
        named = str(candidate.name)
        return f"{turn}: {named}" if turn else named[:1].upper() + named[1:]
    limbs = ", ".join(_limbs(candidate.limbs.split()))
    if turn:
        return f"{turn}: {limbs}" if limbs else turn
    if limbs:
        return f"Other {limbs}"
    return "As found" if candidate == match.candidates[0] else "Nearly as found"


def _turn(angle_deg: float) -> str:
    """Words for a turn to the left; none where it is hardly seen."""
    if abs(angle_deg) < NOTICEABLE_TURN_DEG:
        return ""
    if abs(angle_deg) > 180.0 - NOTICEABLE_TURN_DEG:
        return "Turned round"
    if angle_deg > 0.0:
        return f"{angle_deg:.0f}° left"
    return f"{-angle_deg:.0f}° right"


def _limbs(names: list[str]) -> list[str]:
    """Words for limbs, both of a pair together."""
    words = []
    for pair, both in PAIRS.items():
        there = [name for name in pair if name in names]
        words += [both] if len(there) == len(pair) else [LIMBS[name] for name in there]
    return words


PERCENT_UNITS = 2.1
MOST_SHOWN = 4  # candidates, the likeliest; with more the step would not fit the sidebar of a small screen


def percent(share: float) -> str:
    """A probability in percent."""
    return f"{100.0 * share:.0f} %"


def draw_candidates_head(
    layout: bpy.types.UILayout, context: bpy.types.Context, match: bpy.types.PropertyGroup
) -> None:
    """Draw which frame they are of, and how they are looked at."""
    head = layout.row(align=True)
    head.label(text=f"Frame {match.frame:g} may show", translate=False)
    draw_side_view(head, context)


def draw_side_view(row: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw the button that looks at candidates from the side."""
    aside = context.space_data.region_3d.view_perspective != "CAMERA"
    row.operator("keymark.look_from_side", text="", icon="AXIS_SIDE", depress=aside)


def draw_candidates(
    layout: bpy.types.UILayout, match: bpy.types.PropertyGroup, operator: str, is_shown: bool = True
) -> None:
    """Draw a row for each of a frame's likeliest candidates; its button calls an operator with its index.

    None is marked where the frame was posed in another way.
    """
    for index, candidate in enumerate(match.candidates[:MOST_SHOWN]):
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
