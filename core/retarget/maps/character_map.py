"""A character map: which bones and controls of a character play which role, as its file holds it.

`docs/character_map_format.md` describes the fields. Conventions in `presets/characters` have a few more.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from math import hypot
from pathlib import Path
from types import MappingProxyType
from typing import Annotated, Any, ClassVar

from ...errors import shown
from ...files.fields import is_number, listed
from ...files.json_file import read_json, write_readable_json
from ...files.kinds import ByName, Choice, Items, Kind, Never, Number, Text, first_twice, refuse
from ...files.records import Object, Record
from ...prior.texts import LONGEST_LINE, LONGEST_NAME, LONGEST_TEXT, SPDX, Tags, line
from ..character import CHAINS, LIMBS, ROLES, SOURCES, TRUNK_CHAINS

MOST_BONES, MOST_SETTINGS, MOST_SOLE_POINTS = 100, 1000, 1000  # of a role; of a map; of a sole
LARGEST_BYTES = 2**20
LONGEST_BONE = 255  # characters of a bone's or a property's name; Blender's own have up to 63 bytes
FARTHEST = 1e6  # largest coordinate of a sole, in the armature's units, and largest value of a property
DECIMALS = 9
ROUGH_LENGTH, EXACT_LENGTH = 1e-3, 1e-8
"""How far a rest correction's length may be from 1; one that is farther than the second is made 1."""
SOLE_ROLES = tuple(role for role in ROLES if role.partition(".")[0] in ("foot", "toe"))


class Turn(Kind):
    """A quaternion, which is made to have the length 1."""

    valid = "a turn as a quaternion [w, x, y, z] of length 1"
    like = Items(
        "numbers", 4, 4, valid, item=Number(-1.0 - ROUGH_LENGTH, 1.0 + ROUGH_LENGTH, decimals=DECIMALS)
    )

    def read(self, value: Any, where: str, name: str) -> tuple[float, ...]:
        """See `Kind`."""
        turn = self.like.read(value, where, name)
        length = hypot(*turn)
        if abs(length - 1.0) > ROUGH_LENGTH:
            refuse(where, name, value, self.valid)
        return turn if abs(length - 1.0) <= EXACT_LENGTH else tuple(part / length for part in turn)

    def write(self, value: Any) -> list[float]:
        """See `Kind`."""
        return self.like.write(value)


class PropertyValue(Kind):
    """A number or a truth value, which stays of its kind: a property of Blender has a type."""

    farthest = FARTHEST
    valid = f"a number from {-FARTHEST:g} to {FARTHEST:g}, true or false"

    def read(self, value: Any, where: str, name: str) -> float | int | bool:
        """See `Kind`."""
        if not isinstance(value, bool) and not (is_number(value) and abs(value) <= FARTHEST):
            refuse(where, name, value, self.valid)
        return value

    def write(self, value: float | int | bool) -> float | int | bool:
        """See `Kind`."""
        return round(value, DECIMALS) + 0.0 if isinstance(value, float) else value


Share = Annotated[float, Number(0.0, 1.0, decimals=DECIMALS)]
BoneName = Annotated[
    str, Text(LONGEST_BONE, f"a bone's name, of at most {LONGEST_BONE} characters", one_line=True)
]
PropertyName = Annotated[
    str, Text(LONGEST_BONE, f"a custom property's name, of at most {LONGEST_BONE} characters", one_line=True)
]
BONES = Items("bones", 1, MOST_BONES, unique="bone")
Bones = Annotated[tuple[BoneName, ...], BONES]
Figure = Annotated[float, Number(-FARTHEST, FARTHEST, decimals=DECIMALS)]
Point = tuple[float, float, float]
SolePoint = Annotated[
    tuple[Figure, Figure, Figure],
    Items("numbers", 3, 3, f"a point [x, y, z] within {FARTHEST:g} of the armature's origin"),
]


@dataclass(frozen=True)
class RoleBones(Record):
    """The bones that play a role."""

    STRICT = True

    bones: Bones
    """One bone; for spine and neck one or several, from the hips upward, for a finger up to three, from the
    knuckle. They say where the joints are."""
    confidence: Share = 1.0
    """Probability that these are the right bones, 0 to 1."""
    source: Annotated[str, Choice(SOURCES)] = "you"
    """Where they come from; by default the person."""
    shares: Annotated[tuple[Share, ...], Items("numbers from 0 to 1", 0, MOST_BONES)] = ()
    """For spine and neck: how much of the turn from the bone below the chain (hips; last of the spine) to its
    upper end (chest; head) each bone takes, not falling; empty for equal steps."""

    def mistake(self) -> str:
        """See `Record`."""
        count, shares = len(self.bones), list(self.shares)
        if not shares or (len(shares) == count and shares == sorted(shares)):
            return ""
        valid = f"{count} numbers from 0 to 1, one a bone, none below the one before"
        return f"shares is {shown(shares)}; it must be {valid}"


UNSHARED = Never(f"shares is for {listed(TRUNK_CHAINS)} alone; leave it out")


@dataclass(frozen=True)
class OneBone(RoleBones):
    """The bone of a role that is no chain."""

    bones: Annotated[tuple[BoneName], replace(BONES, most=1)]
    """The role's bone."""
    shares: Annotated[tuple[()], UNSHARED] = ()
    """Of spine and neck alone."""


@dataclass(frozen=True)
class FingerBones(RoleBones):
    """The bones of a finger."""

    bones: Annotated[tuple[BoneName, ...], replace(BONES, most=3)]
    """From the knuckle to the tip, the thumb's from the wrist."""
    shares: Annotated[tuple[()], UNSHARED] = ()
    """Of spine and neck alone."""


@dataclass(frozen=True)
class Switch(Record):
    """A custom property of a pose bone that chooses between IK and FK."""

    STRICT = True

    bone: BoneName
    """Pose bone with the property."""
    property: PropertyName
    """Name of the property."""
    ik: Figure
    """Value for IK."""
    fk: Figure
    """Value for FK."""

    def mistake(self) -> str:
        """See `Record`."""
        return f"ik and fk are both {self.ik:g}; a switch has two values" if self.ik == self.fk else ""


@dataclass(frozen=True)
class IkControls(Record):
    """The controls of a limb's inverse kinematics."""

    STRICT = True

    goal: BoneName
    """The control that the hand or foot follows, in place and turn."""
    pole: BoneName | None = None
    """The control that elbow or knee points to."""
    toe: BoneName | None = None
    """The control that turns the toes while the leg is in IK."""
    switch: Switch | None = None
    """The custom property that chooses between IK and FK."""

    def renamed(self, name_of: Callable[[str], str | None]) -> "IkControls | None":
        """The controls of other names, without those that have none; None without a goal."""
        goal, switch = name_of(self.goal), self.switch
        if goal is None:
            return None
        holder = name_of(switch.bone) if switch is not None else None
        switch = replace(switch, bone=holder) if switch is not None and holder is not None else None
        pole, toe = (None if name is None else name_of(name) for name in (self.pole, self.toe))
        return IkControls(goal, pole, toe, switch)


@dataclass(frozen=True)
class ArmControls(IkControls):
    """The controls of an arm's inverse kinematics."""

    toe: Annotated[None, Never("toe is a control of legs alone; leave it out")] = None
    """Of legs alone."""


@dataclass(frozen=True)
class Setting(Record):
    """A custom property of a pose bone that is keyed with the motion, so that controls behave as solved."""

    STRICT = True

    bone: BoneName
    """Pose bone with the property."""
    property: PropertyName
    """Name of the property."""
    value: Annotated[float | int | bool, PropertyValue()]
    """Number or truth value, of the property's own type."""


Roles = Annotated[
    Mapping[str, RoleBones],
    ByName(
        "bones by role",
        names=ROLES,
        empty="a character map has roles, hips first",
        exceptions={
            role: Object(FingerBones if role in CHAINS else OneBone, makes=RoleBones)
            for role in ROLES
            if role not in TRUNK_CHAINS
        },
    ),
]
Ik = Annotated[
    Mapping[str, IkControls],
    ByName(
        "controls by limb",
        names=tuple(LIMBS),
        exceptions={limb: Object(ArmControls, makes=IkControls) for limb in LIMBS if limb.startswith("arm")},
    ),
]


def roles_mistake(roles: Mapping[str, RoleBones]) -> str:
    """What is wrong with roles together: a bone that plays two."""
    seen: dict[str, str] = {}
    for role, bones in roles.items():
        for bone in bones.bones:
            other = seen.setdefault(bone, role)
            if other != role:
                return f"roles: {shown(bone)} plays {other} and {role}; each role needs bones of its own"
    return ""


@dataclass(frozen=True)
class CharacterMap(Record):
    """Which bones and controls of a character play which role."""

    STRICT = True
    SCHEMA, VERSION, TITLE = "keymark-character", 1, "character map"
    ORDER: ClassVar[tuple[str, ...]] = (
        *("title", "preset", "author", "license", "description", "tags"),
        *("roles", "fk", "ik", "settings", "root", "soles", "rest_corrections", "left_alone"),
    )

    title: Annotated[str, line(LONGEST_NAME)]
    """Name for people, of the character or the convention."""
    roles: Roles
    """Bones by role; roles that the character lacks are left out."""
    fk: Annotated[
        Mapping[str, Annotated[tuple[BoneName | None, ...], Items("bones or null", 1, MOST_BONES)]],
        ByName("keyed bones by role", names=ROLES),
    ] = field(default_factory=lambda: MappingProxyType({}))
    """By role the bones that are keyed so that the role's bones turn as wanted, one for each of them; null
    where one is not keyed (its share lies on others). A role that is not listed is keyed on its own bones."""
    ik: Ik = field(default_factory=lambda: MappingProxyType({}))
    """Controls by limb, where the rig has inverse kinematics of its own."""
    settings: Annotated[tuple[Setting, ...], Items("settings", 0, MOST_SETTINGS)] = ()
    """Custom properties that are keyed with the motion."""
    root: BoneName | None = None
    """The bone that carries the whole character over the ground, for root motion on a bone."""
    soles: Annotated[
        Mapping[str, Annotated[tuple[SolePoint, ...], Items("points [x, y, z]", 1, MOST_SOLE_POINTS)]],
        ByName("lists of points by role", names=SOLE_ROLES),
    ] = field(default_factory=lambda: MappingProxyType({}))
    """By role `foot.L`, `toe.L` ...: points of the sole fixed to its bone, at rest, in the armature's space
    and units; without them the sole is taken from the bones."""
    rest_corrections: Annotated[
        Mapping[str, Annotated[tuple[float, float, float, float], Turn()]],
        ByName("quaternions by role", names=ROLES),
    ] = field(default_factory=lambda: MappingProxyType({}))
    """By role a turn (w, x, y, z) of the rest pose in the armature's space, for what alignment cannot see."""
    left_alone: Annotated[
        tuple[Annotated[str, Choice(ROLES)], ...], Items("roles", 0, len(ROLES), unique="role")
    ] = ()
    """Roles that are not moved."""
    preset: Annotated[str, line(LONGEST_NAME)] | None = None
    """Identifier of the preset that gave it."""
    author: Annotated[str, line(LONGEST_LINE, empty=True)] = ""
    """Who made it."""
    license: Annotated[str, SPDX] = ""
    """SPDX expression, as in a keyframe library."""
    description: Annotated[str, line(LONGEST_TEXT, empty=True)] = ""
    """What it is for."""
    tags: Tags = ()
    """Words to find it by."""

    def mistake(self) -> str:
        """See `Record`."""
        for role, keyed in self.fk.items():
            if role not in self.roles:
                return f"fk: {role} is keyed, but roles says no bone for it"
            count = len(self.roles[role].bones)
            if len(keyed) != count:
                return (
                    f"fk: {role} has {len(keyed)} of them; it must be a list of {count} bones or null, as "
                    f"many as the bones of {role}"
                )
        keyed_bones = [bone for bones in self.fk.values() for bone in bones if bone is not None]
        keyed_properties = [f"{one.bone} {one.property}" for one in self.settings]
        return (
            roles_mistake(self.roles)
            or first_twice(keyed_bones, "fk", "bone")
            or first_twice(keyed_properties, "settings", "property")
        )

    def bones(self, role: str) -> tuple[str, ...]:
        """The role's bones; () where it is missing."""
        return self.roles[role].bones if role in self.roles else ()

    @property
    def named_bones(self) -> tuple[str, ...]:
        """All bones that it names, each once, those of roles first."""
        named = [bone for role in self.roles.values() for bone in role.bones]
        named += [bone for bones in self.fk.values() for bone in bones if bone is not None]
        for controls in self.ik.values():
            switch = None if controls.switch is None else controls.switch.bone
            named += [
                name for name in (controls.goal, controls.pole, controls.toe, switch) if name is not None
            ]
        named += [setting.bone for setting in self.settings]
        return tuple(dict.fromkeys([*named, *([] if self.root is None else [self.root])]))

    def bone(self, role: str) -> str | None:
        """The role's first bone, whose head is its joint; None where it is missing."""
        return next(iter(self.bones(role)), None)

    def keyed_bones(self, role: str) -> tuple[str | None, ...]:
        """The bones to key for each of the role's bones."""
        return self.fk.get(role, self.bones(role))

    def renamed(self, name_of: Callable[[str], str | None]) -> "CharacterMap":
        """The map with other names, without what has none; a chain that lacks a bone turns in equal steps."""
        roles: dict[str, RoleBones] = {}
        for role, given in self.roles.items():
            bones = tuple(name for bone in given.bones if (name := name_of(bone)) is not None)
            if bones:
                whole = len(bones) == len(given.bones)
                roles[role] = replace(given, bones=bones, shares=given.shares if whole else ())
        fk: dict[str, tuple[str | None, ...]] = {}
        for role, keyed in self.fk.items():
            controls = tuple(None if name is None else name_of(name) for name in keyed)
            same = [name is None for name in controls] == [name is None for name in keyed]
            if same and role in roles and len(controls) == len(roles[role].bones):
                fk[role] = controls
        found = {limb: own.renamed(name_of) for limb, own in self.ik.items()}
        settings = ((setting, name_of(setting.bone)) for setting in self.settings)
        return replace(
            self,
            roles=roles,
            fk=fk,
            ik={limb: other for limb, other in found.items() if other is not None},
            settings=tuple(replace(setting, bone=bone) for setting, bone in settings if bone is not None),
            root=None if self.root is None else name_of(self.root),
        )

    def shares(self, role: str) -> tuple[float, ...]:
        """Share of the turn that each of a chain's bones takes."""
        bones = self.bones(role)
        given = self.roles[role].shares if role in self.roles else ()
        if role not in TRUNK_CHAINS or given:
            return given or (1.0,) * len(bones)
        return tuple((number + 1) / len(bones) for number in range(len(bones)))


def read_character_map(path: Path) -> CharacterMap:
    """Read a character map file.

    Raises:
        InputError: The file is missing, no character map, or invalid.
    """
    return CharacterMap.from_json(read_json(path, LARGEST_BYTES), str(path))


def write_character_map(path: Path, character_map: CharacterMap) -> None:
    """Write a map's file, whole or not at all.

    Raises:
        InputError: It is invalid.
        ConversionError: It cannot be written.
    """
    value = character_map.to_json()
    CharacterMap.from_json(value, f"character map {shown(character_map.title)}")
    write_readable_json(path, value)
