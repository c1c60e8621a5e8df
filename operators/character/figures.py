"""What was measured of a retargeted motion, in a few plain lines."""

from typing import TYPE_CHECKING

import bpy

from ...core.retarget.options import LimbKeys, Placement, RetargetOptions, RootMotion
from .properties import MM

if TYPE_CHECKING:
    from ...core.retarget.quality import Quality


def figures(quality: "Quality") -> list[str]:
    """Lines on feet, floor, hands (or limbs, where the hands reach nothing) and keys."""
    lines = []
    if quality.skate_mm is not None:
        lines.append(f"Feet slide {quality.skate_mm:.2f} mm a frame")
    if quality.penetration_mm is not None:
        lines.append(f"Soles at most {quality.penetration_mm:.1f} mm below floor")
    if quality.hands_mm is not None:
        lines.append(f"Hands {quality.hands_mm:.0f} mm from what they reach")
    elif quality.arms_deg is not None and quality.legs_deg is not None:
        lines.append(f"Arms {quality.arms_deg:.1f}°, legs {quality.legs_deg:.1f}° off")
    if quality.keys is not None and quality.dense_keys is not None:
        lines.append(f"{quality.keys} keys instead of {quality.dense_keys}")
    return lines


# --- Core's options of retargeting from properties


def options_of(group: bpy.types.PropertyGroup) -> RetargetOptions:
    """The options that properties hold."""
    return RetargetOptions(
        root_motion=RootMotion[group.root_motion],
        placement=Placement[group.placement],
        arms=LimbKeys[group.arms],
        legs=LimbKeys[group.legs],
        plant_feet=group.plant_feet,
        reach_hands=group.reach_hands,
        tolerance_m=group.tolerance_mm / MM if group.keys == "TOLERANCE" else None,
    )
