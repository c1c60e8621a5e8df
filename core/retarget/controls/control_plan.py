"""Which bones of a character are keyed, and what each of them is for."""

from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum

from ...take.character_settings import LimbKeys, RetargetOptions, RootMotion
from ..character import LIMBS, ROLES, Character, joint_roles
from ..maps.character_map import CharacterMap


class ControlKind(Enum):
    """What a control does."""

    FK = "fk"  # it turns a bone, and places it where it can and must
    HIPS = "hips"  # it turns and places the hips
    GOAL = "goal"  # hand or foot follow it by inverse kinematics
    TOE = "toe"  # it turns the toes while the leg is in IK
    POLE = "pole"  # elbow or knee point to it
    ROOT = "root"  # it carries the whole character
    CARRIER = "carrier"  # it places hips that are connected to it, whose own location Blender ignores


IN_FK = (ControlKind.FK, ControlKind.HIPS)


@dataclass(frozen=True)
class PlannedControl:
    """A bone that is to be keyed."""

    name: str
    kind: ControlKind
    bone: str  # the bone with a role that it moves; for a pole the one that begins at elbow or knee
    limb: str | None = None  # the limb of `roles.LIMBS` whose inverse kinematics it belongs to


def planned_controls(
    character_map: CharacterMap, options: RetargetOptions, character: Character | None = None
) -> tuple[PlannedControl, ...]:
    """The controls that are keyed, each once; of a character also the one that carries connected hips."""
    found: dict[str, PlannedControl] = {}
    if options.root_motion is RootMotion.ROOT_BONE and character_map.root is not None:
        root = character_map.root
        found[root] = PlannedControl(root, ControlKind.ROOT, root)
    for control in (*_ik_controls(character_map, options), *_fk_controls(character_map, options)):
        found.setdefault(control.name, control)
    carrier = None if character is None else _hips_carrier(character, character_map)
    if carrier is not None and "hips" not in character_map.left_alone:
        found.setdefault(carrier, PlannedControl(carrier, ControlKind.CARRIER, carrier))
    return tuple(found.values())


def _hips_carrier(character: Character, character_map: CharacterMap) -> str | None:
    """The bone from which the hips hang by connected bones alone; None where they place themselves."""
    hips = next((name for name in character_map.keyed_bones("hips") if name in character.index), None)
    bone = None if hips is None else character.bone(hips)
    while bone is not None and bone.connected and bone.parent >= 0:
        bone = character.bones[bone.parent]
    return None if bone is None or bone.name == hips else bone.name


def limb_keys(character_map: CharacterMap, options: RetargetOptions, limb: str) -> LimbKeys:
    """How a limb is keyed: as chosen, where the rig and the parts that may be moved allow it."""
    missing = set(joint_roles(limb)) - set(character_map.roles) | set(character_map.left_alone)
    if limb not in character_map.ik or missing & set(joint_roles(limb)):
        return LimbKeys.FK
    if all(control is None for role in joint_roles(limb)[:2] for control in character_map.keyed_bones(role)):
        return LimbKeys.IK
    return options.arms if limb.startswith("arm") else options.legs


def limb_bones(character_map: CharacterMap, limb: str) -> tuple[str, str, str]:
    """The bones that begin at a limb's three joints."""
    first, second, third = (str(character_map.bone(role)) for role in joint_roles(limb))
    return first, second, third


def _ik_controls(character_map: CharacterMap, options: RetargetOptions) -> Iterator[PlannedControl]:
    for limb, ik in character_map.ik.items():
        if limb_keys(character_map, options, limb) is LimbKeys.FK:
            continue
        _, middle, end = limb_bones(character_map, limb)
        yield PlannedControl(ik.goal, ControlKind.GOAL, end, limb)
        last = LIMBS[limb][-1]
        toe = None if last in character_map.left_alone else character_map.bone(last)
        if ik.toe is not None and toe is not None:
            yield PlannedControl(ik.toe, ControlKind.TOE, toe, limb)
        if ik.pole is not None:
            yield PlannedControl(ik.pole, ControlKind.POLE, middle, limb)


def _fk_controls(character_map: CharacterMap, options: RetargetOptions) -> Iterator[PlannedControl]:
    in_ik: set[str] = set()  # not the shoulder; the toes where they have a control
    for limb, ik in character_map.ik.items():
        if limb_keys(character_map, options, limb) is LimbKeys.IK:
            in_ik.update(joint_roles(limb) if ik.toe is None else (*joint_roles(limb), LIMBS[limb][-1]))
    for role in ROLES:
        if role not in character_map.roles or role in character_map.left_alone or role in in_ik:
            continue
        kind = ControlKind.HIPS if role == "hips" else ControlKind.FK
        pairs = zip(character_map.keyed_bones(role), character_map.bones(role), strict=True)
        for control, bone in pairs:
            if control is not None:
                yield PlannedControl(control, kind, bone)
