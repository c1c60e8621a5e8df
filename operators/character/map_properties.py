"""Properties of a character map: what `core/retarget/maps/character_map` holds, as the panel edits it.

Bones are kept by name, so that a bone that was renamed or removed is said and not lost.
"""

from collections.abc import Mapping

import bpy
from bpy.types import Context, PropertyGroup

from ...core.retarget.character import HANDS, LIMBS, MIDDLE, ROLES, SOURCES, TRUNK_CHAINS
from ...core.retarget.maps.character_map import CharacterMap, IkControls, RoleBones, Setting
from ...core.retarget.maps.character_map import Switch as SwitchControl
from ..shell.fields import Choice, Entries, Number, Switch, Text, Vector, declared_property

KINDS = (
    ("FLOAT", "Decimal", "A decimal number"),
    ("INT", "Integer", "A whole number"),
    ("BOOL", "Switch", "On or off"),
)
PARTS = {
    "trunk": ("Trunk", MIDDLE),
    "arm.L": ("Left Arm", LIMBS["arm.L"]),
    "arm.R": ("Right Arm", LIMBS["arm.R"]),
    "leg.L": ("Left Leg", LIMBS["leg.L"]),
    "leg.R": ("Right Leg", LIMBS["leg.R"]),
    "fingers.L": ("Left Fingers", HANDS["L"]),
    "fingers.R": ("Right Fingers", HANDS["R"]),
}
"""Titles and roles of the parts of the body, as the panel shows them."""


def role_title(role: str) -> str:
    """A role's label without its side."""
    return role.partition(".")[0].replace("_", " ").title()


def _bone_chosen(entry: PropertyGroup, context: Context) -> None:
    """Make the role the person's, without what was found for the bone before: it would move others."""
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
    share: Number("Share", "Share of the chain's turn made up to and with this bone", min=0.0, max=1.0)


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
        items=[(source, source.title(), "") for source in SOURCES],
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


DIGITS = 7  # significant digits of values that Blender keeps as float32
WORDS = ("author", "license", "description")
TYPES = {"BOOL": bool, "INT": int, "FLOAT": float}  # the types of properties' values
NO_DOUBTS: Mapping[str, str] = {}


def map_of(group: PropertyGroup) -> CharacterMap:
    """The character map that properties hold; without roles where nothing was recognized yet."""
    roles: dict[str, RoleBones] = {}
    fk: dict[str, tuple[str | None, ...]] = {}
    for role in group.roles:
        chosen = [entry for entry in role.bones if entry.bone]
        if not chosen:
            continue
        shares = tuple(_rounded(entry.share) for entry in chosen) if role.uneven else ()
        bones = tuple(entry.bone for entry in chosen)
        roles[role.name] = RoleBones(bones, _rounded(role.confidence), role.source, shares)
        if any(entry.control or not entry.keyed for entry in chosen):
            fk[role.name] = tuple((entry.control or entry.bone) if entry.keyed else None for entry in chosen)
    return CharacterMap(
        title=group.title,
        roles=roles,
        fk=fk,
        ik={limb.name: _ik_of(limb) for limb in group.limbs if limb.goal},
        settings=tuple(
            Setting(each.bone, each.property, TYPES[each.kind](_rounded(each.value)))
            for each in group.settings
            if each.bone
        ),
        root=group.root or None,
        soles={
            role.name: tuple(tuple(map(_rounded, point.place)) for point in role.sole)
            for role in group.roles
            if len(role.sole)
        },
        rest_corrections={
            role.name: tuple(map(_rounded, role.correction)) for role in group.roles if role.corrected
        },
        left_alone=tuple(role.name for role in group.roles if role.left_alone),
        preset=group.preset or None,
        author=group.author,
        license=group.license,
        description=group.description,
        tags=tuple(tag.strip() for tag in group.tags.split(",") if tag.strip()),
    )


def show_map(
    group: PropertyGroup, character_map: CharacterMap, doubts: Mapping[str, str] = NO_DOUBTS
) -> None:
    """Set properties to a character map, with doubts by role; roles without bones have an empty entry."""
    clear_map(group)
    group.title, group.root = character_map.title, character_map.root or ""
    group.preset = character_map.preset or ""
    for name in WORDS:
        setattr(group, name, getattr(character_map, name))
    group.tags = ", ".join(character_map.tags)
    for name in ROLES:
        _show_role(group.roles.add(), name, character_map, doubts.get(name, ""))
    for name in LIMBS:
        limb, controls = group.limbs.add(), character_map.ik.get(name)
        limb.name = name
        if controls is not None:
            limb.goal, limb.pole, limb.toe = controls.goal, controls.pole or "", controls.toe or ""
            if (switch := controls.switch) is not None:
                limb.switch_bone, limb.switch_property = switch.bone, switch.property
                limb.switch_ik, limb.switch_fk = switch.ik, switch.fk
    for setting in character_map.settings:
        shown = group.settings.add()
        shown.bone, shown.property, shown.value = setting.bone, setting.property, float(setting.value)
        shown.kind = next(kind for kind, value in TYPES.items() if value is type(setting.value))


def clear_map(group: PropertyGroup) -> None:
    """Empty the properties of a map."""
    for name in ("title", *WORDS, "tags", "roles", "limbs", "settings", "root", "preset"):
        group.property_unset(name)


def role_named(group: PropertyGroup, role: str) -> PropertyGroup:
    """The properties of a role; those of all roles are added where there are none yet."""
    if not len(group.roles):
        show_map(group, CharacterMap(group.title, {}))
    return group.roles[role]


def _show_role(shown: PropertyGroup, name: str, character_map: CharacterMap, doubt: str) -> None:
    shown.name = name
    found = character_map.roles.get(name)
    keyed = character_map.keyed_bones(name)
    for number, bone in enumerate(character_map.bones(name) or ("",)):
        entry = shown.bones.add()
        entry.bone = bone  # its update makes the role the person's
        control = keyed[number] if number < len(keyed) else bone
        entry.keyed = control is not None
        entry.control = control if control not in (None, bone) else ""
        if found is not None and found.shares:
            entry.share = found.shares[number]
    shown.uneven = name in TRUNK_CHAINS and found is not None and bool(found.shares)
    shown.source = found.source if found is not None else "you"
    shown.confidence = found.confidence if found is not None else 1.0
    shown.doubt = doubt
    shown.left_alone = name in character_map.left_alone
    for point in character_map.soles.get(name, ()):
        shown.sole.add().place = point
    if name in character_map.rest_corrections:
        shown.corrected, shown.correction = True, character_map.rest_corrections[name]


def _ik_of(limb: PropertyGroup) -> IkControls:
    switch = None
    if limb.switch_bone and limb.switch_property:
        switch = SwitchControl(
            limb.switch_bone, limb.switch_property, _rounded(limb.switch_ik), _rounded(limb.switch_fk)
        )
    return IkControls(limb.goal, limb.pole or None, limb.toe or None, switch)


def _rounded(value: float) -> float:
    return float(f"{value:.{DIGITS}g}")
