"""Core's options of retargeting from properties."""

import bpy

from ...core.retarget.options import LimbKeys, Placement, RetargetOptions, RootMotion
from .properties import MM


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
