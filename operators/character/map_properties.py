"""Properties of a character map: what `core/retarget/maps/character_map` holds, as the panel edits it.

Bones are kept by name, so that a bone that was renamed or removed is said and not lost.
"""

import bpy

from ...core.retarget.character import LIMBS, MIDDLE, SOURCES
from ...core.retarget.maps.character_map import CharacterMap, IkControls, RoleBones, Setting
from ...core.retarget.maps.character_map import Switch as SwitchControl
from ..shell.declared_properties import declared_property
from ..shell.fields import Choice, Entries, Number, Switch, Text, Vector

SOURCE_WORDS = {"preset": "Preset", "names": "Names", "shape": "Shape", "you": "You"}
"""Labels of where a role's bones come from."""
KINDS = (
    ("FLOAT", "Decimal", "A decimal number"),
    ("INT", "Integer", "A whole number"),
    ("BOOL", "Switch", "On or off"),
)
PARTS = {"trunk": MIDDLE, **{limb: LIMBS[limb] for limb in ("arm.L", "arm.R", "leg.L", "leg.R")}}
"""Roles of the parts of the body, as the panel shows them."""
PART_TITLES = {
    "trunk": "Trunk",
    "arm.L": "Left Arm",
    "arm.R": "Right Arm",
    "leg.L": "Left Leg",
    "leg.R": "Right Leg",
}


def role_title(role: str) -> str:
    """A role's label without its side."""
    return role.partition(".")[0].replace("_", " ").title()


def _bone_chosen(entry: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    """Make the role the person's, and drop what belonged to the bone before.

    A control that was found for another bone would move the wrong part of the rig without a word.
    """
    entry.control, entry.keyed = "", True
    path = entry.path_from_id().rpartition(".bones[")[0]
    role = entry.id_data.path_resolve(path) if path else None
    if role is not None:
        role.source, role.confidence, role.doubt = "you", 1.0, ""
        role.uneven = role.corrected = False
        role.sole.clear()


class KEYMARK_PG_role_bone(bpy.types.PropertyGroup):
    """A bone that plays a role, and the control that is keyed to move it."""

    bone: Text("Bone", "The bone that plays this role; its head is the joint", update=_bone_chosen)
    control: Text("FK Control", "The bone that is keyed to turn this one; empty for the bone itself")
    keyed: Switch("Keyed", "Whether a control is keyed for this bone at all", default=True)
    share: Number(
        "Share",
        "Share of the whole chain's turn that has been made up to and with this bone",
        min=0.0,
        max=1.0,
    )


class KEYMARK_PG_sole_point(bpy.types.PropertyGroup):
    """A point of a sole."""

    place: Vector("Place", "In the armature's space, at rest", size=3, precision=4)


class KEYMARK_PG_role(bpy.types.PropertyGroup):
    """A role; `name` is one of `roles.ROLES`."""

    bones: Entries(type=KEYMARK_PG_role_bone)
    confidence: declared_property(RoleBones, "confidence", min=0.0, max=1.0)
    source: Choice(
        "Found By",
        "Where the bones of this role come from",
        items=[(source, SOURCE_WORDS[source], "") for source in SOURCES],
        default="you",
    )
    doubt: Text("Doubt", "Why these may be the wrong bones")
    uneven: Switch("Uneven", "Whether the bones of a chain turn by their own shares, not in equal steps")
    left_alone: Switch("Leave Alone", "Do not move the bones of this role")
    sole: Entries(type=KEYMARK_PG_sole_point)
    corrected: Switch("Corrected", "Whether the rest pose of this role is turned before it is aligned")
    correction: Vector(
        "Rest Correction",
        "Turn of the rest pose (W, X, Y, Z) in the armature's space",
        size=4,
        default=(1.0, 0.0, 0.0, 0.0),
        precision=4,
    )


class KEYMARK_PG_limb_controls(bpy.types.PropertyGroup):
    """The controls of a limb's inverse kinematics; `name` is one of `roles.LIMBS`."""

    goal: declared_property(IkControls, "goal", name="IK")
    pole: declared_property(IkControls, "pole")
    toe: declared_property(IkControls, "toe", name="IK Toes")
    switch_bone: Text("Switch", "The bone whose property chooses between IK and FK; empty for none")
    switch_property: Text("Property", "Name of the custom property that chooses between IK and FK")
    switch_ik: declared_property(SwitchControl, "ik", name="IK Value")
    switch_fk: declared_property(SwitchControl, "fk", name="FK Value", default=1.0)


class KEYMARK_PG_map_setting(bpy.types.PropertyGroup):
    """A custom property that is keyed with the motion, so that the controls behave as solved."""

    bone: declared_property(Setting, "bone")
    property: declared_property(Setting, "property")
    kind: Choice("Kind", "Kind of its value", items=KINDS)
    value: Number("Value", "The value that is keyed")


class KEYMARK_PG_character_map(bpy.types.PropertyGroup):
    """Which bones and controls of a character play which role; empty until bones are recognized."""

    title: declared_property(CharacterMap, "title")
    author: declared_property(CharacterMap, "author")
    license: declared_property(CharacterMap, "license")
    description: declared_property(CharacterMap, "description")
    tags: Text("Tags", "Words to find the map by, with commas between them")
    roles: Entries(type=KEYMARK_PG_role)
    limbs: Entries(type=KEYMARK_PG_limb_controls)
    settings: Entries(type=KEYMARK_PG_map_setting)
    root: declared_property(CharacterMap, "root", name="Root Bone")
    preset: declared_property(CharacterMap, "preset")
