"""The limbs of a character with the paths of their joints."""

from collections.abc import Mapping, Sequence

import numpy as np

from ...arrays import Array
from ..character import Character
from ..character_motion import CharacterMotion
from ..maps.character_map import CharacterMap
from ..roles import LIMBS
from .control_channels import Control
from .control_motion import LimbPaths
from .control_plan import ControlKind, joint_roles, limb_bones
from .control_spaces import NOTHING
from .control_targets import PoleSetting

IN_FK = (ControlKind.FK, ControlKind.HIPS)


def limb_paths(
    character: Character,
    character_map: CharacterMap,
    motion: CharacterMotion,
    controls: Sequence[Control],
    offsets: Mapping[str, Array],
    poles: Mapping[str, PoleSetting],
) -> dict[str, LimbPaths]:
    """The limbs whose three joints are moved, by name.

    Args:
        character: The character.
        character_map: Its map.
        motion: Its motion.
        controls: Its controls.
        offsets: (4, 4) by control the pose of its bone in its own axes.
        poles: Where its poles belong.
    """
    found = {}
    in_ik = {control.plan.limb for control in controls if control.plan.kind is ControlKind.GOAL}
    in_fk = {control.plan.bone for control in controls if control.plan.kind in IN_FK}
    for limb in LIMBS:
        if not set(joint_roles(limb)) <= set(character_map.roles):
            continue
        bones = limb_bones(character_map, limb)
        if not set(bones) <= set(motion.poses):
            continue
        root, middle, end = (motion.poses[bone][:, :3, 3] for bone in bones)
        pole = character_map.ik[limb].pole if limb in in_ik else None
        carrier, place = _carrier(character, character_map, controls, offsets, limb)
        found[limb] = LimbPaths(
            bones,
            (root, middle, end),
            carrier,
            place,
            motion.bends[limb],
            set(bones) <= in_fk,
            limb in in_ik,
            poles[pole].distance if pole is not None else 0.0,
        )
    return found


def _carrier(
    character: Character,
    character_map: CharacterMap,
    controls: Sequence[Control],
    offsets: Mapping[str, Array],
    limb: str,
) -> tuple[int, Array]:
    """Index of the control that carries a limb's root, and the root's place in its axes; NOTHING for none."""
    root = character.bone(limb_bones(character_map, limb)[0]).head
    above = (LIMBS[limb][0], "spine", "hips") if limb.startswith("arm") else ("hips",)
    for bone in [name for role in above for name in reversed(character_map.bones(role))]:
        for index, control in enumerate(controls):
            if control.plan.bone == bone and control.plan.kind in IN_FK:
                rest, offset = character.bone(bone).rest, offsets[control.name]
                place = (root - rest[:3, 3]) @ rest[:3, :3]
                return index, np.asarray(offset[:3, :3] @ place + offset[:3, 3])
    return NOTHING, np.zeros(3)
