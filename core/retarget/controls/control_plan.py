"""Which bones of a character are keyed, and what each of them is for."""

from dataclasses import dataclass
from enum import Enum

from ...take.conversion_settings import LimbKeys, RetargetOptions, RootMotion
from ..character import FINGER_ROLES, JOINTS, LIMBS, ROLES, Character
from ..maps.character_map import CharacterMap


class ControlKind(Enum):
    """What a control does."""

    FK = "fk"  # it turns a bone, and places it where it can and must
    HIPS = "hips"  # it turns and places the hips
    GOAL = "goal"  # hand or foot follow it by inverse kinematics
    FINGER = "finger"  # it bends a bone of a finger
    TOE = "toe"  # it turns the toes while the leg is in IK
    POLE = "pole"  # elbow or knee point to it
    ROOT = "root"  # it carries the whole character
    CARRIER = "carrier"  # it places hips that are connected to it, whose own location Blender ignores


IN_FK = (ControlKind.FK, ControlKind.HIPS, ControlKind.FINGER)


@dataclass(frozen=True)
class PlannedControl:
    """A bone that is to be keyed."""

    name: str
    kind: ControlKind
    bone: str  # the bone with a role that it moves; for a pole the one that begins at elbow or knee
    limb: str | None = None  # the limb of `LIMBS` whose inverse kinematics it belongs to, or is carried by


def planned_controls(
    character_map: CharacterMap, options: RetargetOptions, character: Character | None = None
) -> tuple[PlannedControl, ...]:
    """The controls that are keyed, each once; of a character also the one that carries connected hips."""
    wanted: list[tuple[str | None, ControlKind, str | None, str | None]] = []
    if options.root_motion is RootMotion.ROOT_BONE:
        wanted.append((character_map.root, ControlKind.ROOT, character_map.root, None))
    not_in_fk = set(character_map.left_alone)
    for limb, ik in character_map.ik.items():
        keys, last = limb_keys(character_map, options, limb), LIMBS[limb][-1]
        if keys is LimbKeys.FK:
            continue
        _, middle, end = limb_bones(character_map, limb)
        toe = None if last in character_map.left_alone else character_map.bone(last)
        wanted.append((ik.goal, ControlKind.GOAL, end, limb))
        wanted += [(ik.toe, ControlKind.TOE, toe, limb), (ik.pole, ControlKind.POLE, middle, limb)]
        if keys is LimbKeys.IK:  # not the shoulder; the toes where they have a control
            not_in_fk.update(JOINTS[limb] if ik.toe is None else (*JOINTS[limb], last))
    for role in ROLES:
        if role in character_map.roles and role not in not_in_fk:
            kind, arm = ControlKind.HIPS if role == "hips" else ControlKind.FK, None
            if role in FINGER_ROLES:
                kind, arm = ControlKind.FINGER, f"arm.{role[-1]}"
            pairs = zip(character_map.keyed_bones(role), character_map.bones(role), strict=True)
            wanted += [(control, kind, bone, arm) for control, bone in pairs]
    if character is not None and "hips" not in character_map.left_alone:
        hips = next((name for name in character_map.keyed_bones("hips") if name in character.index), None)
        bone = None if hips is None else character.bone(hips)
        while bone is not None and bone.connected and bone.parent >= 0:
            bone = character.bones[bone.parent]
        if bone is not None and bone.name != hips:
            wanted.append((bone.name, ControlKind.CARRIER, bone.name, None))
    found: dict[str, PlannedControl] = {}
    for name, kind, moved, belongs in wanted:
        if name is not None and moved is not None:
            found.setdefault(name, PlannedControl(name, kind, moved, belongs))
    return tuple(found.values())


def limb_keys(character_map: CharacterMap, options: RetargetOptions, limb: str) -> LimbKeys:
    """How a limb is keyed: as chosen, where the rig and the parts that may be moved allow it."""
    moved = set(character_map.roles) - set(character_map.left_alone)
    if limb not in character_map.ik or not set(JOINTS[limb]) <= moved:
        return LimbKeys.FK
    if all(control is None for role in JOINTS[limb][:2] for control in character_map.keyed_bones(role)):
        return LimbKeys.IK
    return options.arms if limb.startswith("arm") else options.legs


def limb_bones(character_map: CharacterMap, limb: str) -> tuple[str, str, str]:
    """The bones that begin at a limb's three joints."""
    first, second, third = (str(character_map.bone(role)) for role in JOINTS[limb])
    return first, second, third
