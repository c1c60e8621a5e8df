"""The limbs that show inverse kinematics, with the paths of their joints."""

from collections.abc import Mapping, Sequence

import numpy as np

from ..arrays import Array
from .character import Character
from .character_map import CharacterMap
from .character_motion import CharacterMotion
from .control_channels import Control
from .control_motion import LimbPaths
from .control_plan import ControlKind, limb_bones, limb_keys
from .control_targets import PoleSetting
from .options import LimbKeys, RetargetOptions
from .roles import LIMBS

IN_FK = (ControlKind.FK, ControlKind.HIPS)


def limb_paths(
    character: Character,
    character_map: CharacterMap,
    motion: CharacterMotion,
    options: RetargetOptions,
    controls: Sequence[Control],
    offsets: Mapping[str, Array],
    poles: Mapping[str, PoleSetting],
) -> dict[str, LimbPaths]:
    """Limbs that have a goal among the controls, by name."""
    found = {}
    for goal in controls:
        if goal.plan.kind is not ControlKind.GOAL:
            continue
        limb = str(goal.plan.limb)
        root, middle, end = (motion.poses[bone][:, :3, 3] for bone in limb_bones(character_map, limb))
        pole = character_map.ik[limb].pole
        control, place = _carrier(character, character_map, controls, offsets, limb)
        found[limb] = LimbPaths(
            (root, middle, end),
            control,
            place,
            limb_keys(character_map, options, limb) is LimbKeys.BOTH,
            poles[pole].distance if pole in poles else 0.0,
        )
    return found


def _carrier(
    character: Character,
    character_map: CharacterMap,
    controls: Sequence[Control],
    offsets: Mapping[str, Array],
    limb: str,
) -> tuple[int, Array]:
    """Index of the control that carries a limb's root, and the root's place in its axes; -1 for none."""
    root = character.bone(limb_bones(character_map, limb)[0]).head
    above = (LIMBS[limb][0], "spine", "hips") if limb.startswith("arm") else ("hips",)
    bones = [name for role in above for name in reversed(character_map.bones(role))]
    for bone in bones:
        for index, control in enumerate(controls):
            if control.plan.bone == bone and control.plan.kind in IN_FK:
                rest, offset = character.bone(bone).rest, offsets[control.name]
                place = (root - rest[:3, 3]) @ rest[:3, :3]
                return index, np.asarray(offset[:3, :3] @ place + offset[:3, 3])
    return -1, np.zeros(3)
