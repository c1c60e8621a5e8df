"""Properties of a character map: what `core/retarget/character_map` holds, as the panel edits it.

Bones are kept by name, so that a bone that was renamed or removed is said and not lost.
"""

import bpy

from ...core.retarget.character import CHAINS, LIMBS, MIDDLE, SOURCES

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


def is_chain(role: str) -> bool:
    """Whether several bones may share a role."""
    return role in CHAINS


def _bone_chosen(entry: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    """Make the role the person's, and drop what belonged to the bone before.

    A control that was found for another bone would move the wrong part of the rig without a word.
    """
    entry.control, entry.keyed = "", True
    role = _role_of(entry)
    if role is not None:
        role.source, role.confidence, role.doubt = "you", 1.0, ""
        role.uneven = role.corrected = False
        role.sole.clear()


def _role_of(entry: bpy.types.PropertyGroup) -> bpy.types.PropertyGroup | None:
    """The role that a bone's entry belongs to, found by where both lie in the scene's properties."""
    path = entry.path_from_id().rpartition(".bones[")[0]
    return entry.id_data.path_resolve(path) if path else None


class KEYMARK_PG_role_bone(bpy.types.PropertyGroup):
    """A bone that plays a role, and the control that is keyed to move it."""

    bone: bpy.props.StringProperty(
        name="Bone", description="The bone that plays this role; its head is the joint", update=_bone_chosen
    )
    control: bpy.props.StringProperty(
        name="FK Control", description="The bone that is keyed to turn this one; empty for the bone itself"
    )
    keyed: bpy.props.BoolProperty(
        name="Keyed", description="Whether a control is keyed for this bone at all", default=True
    )
    share: bpy.props.FloatProperty(
        name="Share",
        description="Share of the whole chain's turn that has been made up to and with this bone",
        min=0.0,
        max=1.0,
    )


class KEYMARK_PG_sole_point(bpy.types.PropertyGroup):
    """A point of a sole."""

    place: bpy.props.FloatVectorProperty(
        name="Place", description="In the armature's space, at rest", size=3, precision=4
    )


class KEYMARK_PG_role(bpy.types.PropertyGroup):
    """A role; `name` is one of `roles.ROLES`."""

    bones: bpy.props.CollectionProperty(type=KEYMARK_PG_role_bone)
    confidence: bpy.props.FloatProperty(
        name="Confidence",
        description="Probability that these are the right bones",
        default=1.0,
        min=0.0,
        max=1.0,
    )
    source: bpy.props.EnumProperty(
        name="Found By",
        description="Where the bones of this role come from",
        items=[(source, SOURCE_WORDS[source], "") for source in SOURCES],
        default="you",
    )
    doubt: bpy.props.StringProperty(name="Doubt", description="Why these may be the wrong bones")
    uneven: bpy.props.BoolProperty(
        name="Uneven", description="Whether the bones of a chain turn by their own shares, not in equal steps"
    )
    left_alone: bpy.props.BoolProperty(
        name="Leave Alone", description="Do not move the bones of this role", default=False
    )
    sole: bpy.props.CollectionProperty(type=KEYMARK_PG_sole_point)
    corrected: bpy.props.BoolProperty(
        name="Corrected", description="Whether the rest pose of this role is turned before it is aligned"
    )
    correction: bpy.props.FloatVectorProperty(
        name="Rest Correction",
        description="Turn of the rest pose (W, X, Y, Z) in the armature's space",
        size=4,
        default=(1.0, 0.0, 0.0, 0.0),
        precision=4,
    )


class KEYMARK_PG_limb_controls(bpy.types.PropertyGroup):
    """The controls of a limb's inverse kinematics; `name` is one of `roles.LIMBS`."""

    goal: bpy.props.StringProperty(
        name="IK", description="The control that the hand or foot follows; empty where the rig has none"
    )
    pole: bpy.props.StringProperty(
        name="Pole", description="The control that the elbow or knee points to; empty for none"
    )
    toe: bpy.props.StringProperty(
        name="IK Toes", description="The control that turns the toes while the leg is in IK; empty for none"
    )
    switch_bone: bpy.props.StringProperty(
        name="Switch", description="The bone whose property chooses between IK and FK; empty for none"
    )
    switch_property: bpy.props.StringProperty(
        name="Property", description="Name of the custom property that chooses between IK and FK"
    )
    switch_ik: bpy.props.FloatProperty(name="IK Value", description="Value of the switch in IK")
    switch_fk: bpy.props.FloatProperty(name="FK Value", description="Value of the switch in FK", default=1.0)


class KEYMARK_PG_map_setting(bpy.types.PropertyGroup):
    """A custom property that is keyed with the motion, so that the controls behave as solved."""

    bone: bpy.props.StringProperty(name="Bone", description="The bone that has the property")
    property: bpy.props.StringProperty(name="Property", description="Name of the custom property")
    kind: bpy.props.EnumProperty(name="Kind", description="Kind of its value", items=KINDS)
    value: bpy.props.FloatProperty(name="Value", description="The value that is keyed")


class KEYMARK_PG_character_map(bpy.types.PropertyGroup):
    """Which bones and controls of a character play which role; empty until bones are recognized."""

    title: bpy.props.StringProperty(
        name="Title", description="Name of the map for people: the character's, or its convention's"
    )
    author: bpy.props.StringProperty(name="Author", description="Who made the map")
    license: bpy.props.StringProperty(
        name="License", description="Terms under which others may use the map, as in CC0-1.0"
    )
    description: bpy.props.StringProperty(
        name="Description", description="What others should know of the map"
    )
    tags: bpy.props.StringProperty(
        name="Tags", description="Words to find the map by, with commas between them"
    )
    roles: bpy.props.CollectionProperty(type=KEYMARK_PG_role)
    limbs: bpy.props.CollectionProperty(type=KEYMARK_PG_limb_controls)
    settings: bpy.props.CollectionProperty(type=KEYMARK_PG_map_setting)
    root: bpy.props.StringProperty(
        name="Root Bone", description="The bone that carries the whole character over the ground"
    )
    preset: bpy.props.StringProperty(name="Preset", description="The convention that the bones follow")


register, unregister = bpy.utils.register_classes_factory(
    (
        KEYMARK_PG_role_bone,
        KEYMARK_PG_sole_point,
        KEYMARK_PG_role,
        KEYMARK_PG_limb_controls,
        KEYMARK_PG_map_setting,
        KEYMARK_PG_character_map,
    )
)
