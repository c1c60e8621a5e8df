"""Properties of the actor's lengths, as edited in the panel before they are applied to the armature."""

from typing import Any

import bpy
from bpy.types import Context, PropertyGroup

from ..shell.fields import Number, Switch

SIDED = ("upper_arm", "forearm", "hand", "thigh", "shin", "foot")
MIDDLE = ("trunk", "neck_head", "shoulder_width", "hip_width")
DESCRIPTIONS = {
    "upper_arm": ("Upper Arm", "From the shoulder joint to the elbow"),
    "forearm": ("Forearm", "From the elbow to the wrist"),
    "hand": ("Hand", "From the wrist to the tip of the fingers"),
    "thigh": ("Thigh", "From the hip joint to the knee"),
    "shin": ("Shin", "From the knee to the ankle"),
    "foot": ("Foot", "From the ankle to the toes"),
    "trunk": ("Trunk", "From the middle of the hip joints to the middle of the shoulder joints"),
    "neck_head": ("Neck and Head", "From the middle of the shoulder joints to the middle of the head"),
    "shoulder_width": ("Shoulder Width", "Between the shoulder joints"),
    "hip_width": ("Hip Width", "Between the hip joints"),
}
LENGTHS = {
    name: name.replace(".", "_") for name in (*MIDDLE, *(f"{part}.{side}" for part in SIDED for side in "LR"))
}
"""Core's lengths, and the names of their properties."""


def panel_lengths(lengths: PropertyGroup) -> dict[str, float]:
    """Return the lengths in the panel [m] by core's names."""
    return {name: getattr(lengths, own) for name, own in LENGTHS.items()}


def _length(name: str) -> Any:
    part, _, side = name.partition(".")
    label, description = DESCRIPTIONS[part]
    own, other = LENGTHS[name], LENGTHS.get(f"{part}.{'R' if side == 'L' else 'L'}", "")

    def mirror(lengths: PropertyGroup, context: Context) -> None:
        # Equal lengths are not written again, which ends the mutual updates of the two sides.
        if other and lengths.symmetric and getattr(lengths, other) != getattr(lengths, own):
            setattr(lengths, other, getattr(lengths, own))

    return Number(
        f"{label} {side}".rstrip(),
        description,
        subtype="DISTANCE",
        precision=3,
        step=0.5,
        default=0.3,
        min=0.02,
        max=2.0,
        update=mirror,
    )


def in_meters(owner: PropertyGroup, _context: Context | None = None) -> None:
    """Take a height that was typed in centimeters as meters."""
    if 50.0 <= owner.stature <= 300.0:  # which nobody has in meters
        owner.stature /= 100.0


class Stature:
    """Mixin of operators that make an actor: the performer's body height."""

    stature: Number(
        "Height",
        "The performer's body height",
        subtype="DISTANCE",
        precision=4,
        default=1.75,
        soft_min=0.5,
        soft_max=3.0,
        update=in_meters,
    )

    def given_stature(self) -> float:
        """The height [m]; refuses what nobody has, which Blender's limits would change without a word."""
        from ...core.take.take_file import check_height

        in_meters(self)
        check_height(round(self.stature, 4), "Height")
        return float(self.stature)


class KEYMARK_PG_lengths(bpy.types.PropertyGroup):
    """Lengths of the performer's segments."""

    symmetric: Switch("Symmetric", "Left and right limbs are equally long", default=True)


KEYMARK_PG_lengths.__annotations__.update({own: _length(name) for name, own in LENGTHS.items()})
