"""Properties of the actor's lengths, as edited in the panel before they are applied to the armature."""

import bpy

from ..shell.fields import Number, Switch

SIDED = ("upper_arm", "forearm", "hand", "thigh", "shin", "foot")
MIDDLE = ("trunk", "neck_head", "shoulder_width", "hip_width")
LEAST_CM, MOST_CM = 50.0, 300.0
"""Heights that somebody has in centimeters, and nobody in meters."""
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


def length_property(name: str) -> str:
    """Return the name of the property for one of core's lengths, without its dot."""
    return name.replace(".", "_")


def length_names() -> tuple[str, ...]:
    """Return the names of all of core's lengths."""
    return (*MIDDLE, *(f"{part}.{side}" for part in SIDED for side in ("L", "R")))


def panel_lengths(lengths: bpy.types.PropertyGroup) -> dict[str, float]:
    """Return the lengths in the panel [m] by core's names."""
    return {name: getattr(lengths, length_property(name)) for name in length_names()}


def _mirror(part: str, side: str) -> "bpy.types.AnyType":
    other = length_property(f"{part}.{'R' if side == 'L' else 'L'}")
    own = length_property(f"{part}.{side}")

    def update(lengths: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
        # Equal lengths are not written again, which ends the mutual updates of the two sides.
        if lengths.symmetric and getattr(lengths, other) != getattr(lengths, own):
            setattr(lengths, other, getattr(lengths, own))

    return update


def _length(name: str) -> "bpy.types.AnyType":
    part, _, side = name.partition(".")
    label, description = DESCRIPTIONS[part]
    options = {"update": _mirror(part, side)} if side else {}
    return Number(
        f"{label} {side}".rstrip(),
        description,
        subtype="DISTANCE",
        precision=3,
        step=0.5,
        default=0.3,
        min=0.02,
        max=2.0,
        **options,
    )


def in_meters(owner: bpy.types.PropertyGroup, _context: bpy.types.Context | None = None) -> None:
    """Take a height that was typed in centimeters as meters."""
    if LEAST_CM <= owner.stature <= MOST_CM:
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


KEYMARK_PG_lengths.__annotations__.update({length_property(name): _length(name) for name in length_names()})
