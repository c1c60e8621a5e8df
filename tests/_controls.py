"""Controls of plain characters as probing them would find them, without Blender."""

from collections.abc import Callable

import numpy as np
from keymark.core.body.rotations import continuous_quaternions, to_quaternions
from keymark.core.retarget.character import Character
from keymark.core.retarget.character_motion import CharacterMotion
from keymark.core.retarget.controls.control_channels import (
    NOTHING,
    Control,
    ControlKind,
    ControlSpace,
    PlannedControl,
    ordered_controls,
    planned_controls,
)
from keymark.core.retarget.controls.control_motion import ControlMotion, PoleSetting, on_controls
from keymark.core.retarget.maps.character_map import CharacterMap, IkControls
from keymark.core.take.conversion_settings import RetargetOptions

SIZE = 1.6
POLE = PoleSetting(0.5, 0.0)


def quaternion_values(rotation: np.ndarray, mode: str) -> np.ndarray:
    """Channels of turns (F, 3, 3): all controls here turn by quaternions."""
    assert mode == "QUATERNION"
    return continuous_quaternions(to_quaternions(rotation))


def with_ik(known: CharacterMap) -> CharacterMap:
    """The map of a plain character with goals and poles for all limbs."""
    ends = {"arm": "hand", "leg": "foot"}
    ik = {
        f"{limb}.{side}": IkControls(f"ik_{end}.{side}", f"pole_{limb}.{side}")
        for limb, end in ends.items()
        for side in "LR"
    }
    return CharacterMap(known.title, known.roles, known.fk, ik)


def control_motion(
    character: Character,
    known: CharacterMap,
    motion: CharacterMotion,
    options: RetargetOptions,
    change: Callable[[PlannedControl, ControlSpace], ControlSpace] = lambda plan, space: space,
) -> ControlMotion:
    """A solved motion on a character's own bones, and on free goals and poles where its map has some."""
    planned = planned_controls(known, options)
    index = {plan.name: number for number, plan in enumerate(planned)}
    controls = ordered_controls(
        [
            Control(
                plan,
                "QUATERNION",
                change(plan, _space(character, index, plan)),
                plan.kind is not ControlKind.POLE,
            )
            for plan in planned
        ]
    )
    offsets = {plan.name: np.eye(4) for plan in planned}
    poles = {plan.name: POLE for plan in planned if plan.kind is ControlKind.POLE}
    return on_controls(character, known, motion, controls, offsets, poles, SIZE / character.scale)


def _space(character: Character, index: dict[str, int], plan: PlannedControl) -> ControlSpace:
    """On the nearest control above in the armature; free for goals and poles."""
    rest, above = np.eye(4), NOTHING
    if plan.name in character.index:
        bone = character.bone(plan.name)
        rest, parent = bone.rest, bone.parent
        while parent >= 0 and character.bones[parent].name not in index:
            parent = character.bones[parent].parent
        above = index[character.bones[parent].name] if parent >= 0 else NOTHING
        if above != NOTHING:
            rest = np.linalg.inv(character.bones[parent].rest) @ rest
    return ControlSpace(above, rest[:3, :3], above, rest[:3, 3], rest[:3, :3], 0.0, 0.0)
