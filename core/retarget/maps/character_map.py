"""A character map: which bones and controls of a character play which role."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

from ..roles import CHAINS

Point = tuple[float, float, float]


@dataclass(frozen=True)
class RoleBones:
    """The bones that play a role."""

    bones: tuple[str, ...]
    """One bone; for spine and neck one or several, from the hips upward. They say where the joints are."""
    confidence: float = 1.0
    """Probability that these are the right bones, 0 to 1."""
    source: str = "you"
    """Where they come from: one of `roles.SOURCES`."""
    shares: tuple[float, ...] = ()
    """For spine and neck: how much of the turn from the bone below the chain (hips; last of the spine) to its
    upper end (chest; head) each bone takes, not falling; empty for equal steps."""


@dataclass(frozen=True)
class Switch:
    """A custom property of a pose bone that chooses between IK and FK."""

    bone: str
    property: str
    ik: float
    fk: float


@dataclass(frozen=True)
class IkControls:
    """The controls of a limb's inverse kinematics."""

    goal: str
    """The control that the hand or foot follows, in place and turn."""
    pole: str | None = None
    """The control that elbow or knee points to."""
    toe: str | None = None
    """The control that turns the toes while the leg is in IK."""
    switch: Switch | None = None


@dataclass(frozen=True)
class Setting:
    """A custom property of a pose bone that is keyed with the motion, so that controls behave as solved."""

    bone: str
    property: str
    value: float | int | bool


@dataclass(frozen=True)
class CharacterMap:
    """Which bones and controls of a character play which role."""

    title: str
    """Name for people, of the character or the convention."""
    roles: Mapping[str, RoleBones]
    """By role, of `roles.ROLES`; missing roles are not there."""
    fk: Mapping[str, tuple[str | None, ...]] = field(default_factory=lambda: MappingProxyType({}))
    """By role the bones that are keyed so that the role's bones turn as wanted, one for each of them; None
    where one is not keyed (its share lies on others). A role that is not listed is keyed on its own bones."""
    ik: Mapping[str, IkControls] = field(default_factory=lambda: MappingProxyType({}))
    """By limb of `roles.LIMBS`, where the rig has inverse kinematics of its own."""
    settings: tuple[Setting, ...] = ()
    root: str | None = None
    """The bone that carries the whole character over the ground, for root motion on a bone."""
    soles: Mapping[str, tuple[Point, ...]] = field(default_factory=lambda: MappingProxyType({}))
    """By role `foot.L`, `toe.L` ...: points of the sole fixed to its bone, at rest, in the armature's space
    and units; without them the sole is taken from the bones."""
    rest_corrections: Mapping[str, tuple[float, float, float, float]] = field(
        default_factory=lambda: MappingProxyType({})
    )
    """By role a turn (w, x, y, z) of the rest pose in the armature's space, for what alignment cannot see."""
    left_alone: tuple[str, ...] = ()
    """Roles that are not moved."""
    preset: str | None = None
    """Identifier of the preset that gave it."""
    author: str = ""
    license: str = ""
    """SPDX expression, as in a keyframe library."""
    description: str = ""
    tags: tuple[str, ...] = ()

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

    def shares(self, role: str) -> tuple[float, ...]:
        """Share of the turn that each of a chain's bones takes."""
        bones = self.bones(role)
        given = self.roles[role].shares if role in self.roles else ()
        if role not in CHAINS or given:
            return given or (1.0,) * len(bones)
        return tuple((number + 1) / len(bones) for number in range(len(bones)))
