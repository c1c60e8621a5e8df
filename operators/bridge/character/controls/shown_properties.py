"""Custom properties that a motion keys on a character: its map's settings, and the switches of its limbs."""

from collections.abc import Iterator

from .....core.retarget.controls.control_plan import limb_keys
from .....core.retarget.maps.character_map import CharacterMap, Switch
from .....core.retarget.options import LimbKeys, RetargetOptions
from .posing import Property, Value


def shown_properties(character_map: CharacterMap, options: RetargetOptions) -> dict[Property, Value]:
    """The settings, and the switches as the options want the limbs to be shown."""
    values = _settings(character_map)
    for limb, switch in _switches(character_map):
        in_fk = limb_keys(character_map, options, limb) is LimbKeys.FK
        values[switch.bone, switch.property] = switch.fk if in_fk else switch.ik
    return values


def fk_shown(character_map: CharacterMap) -> dict[Property, Value]:
    """The settings, and all switches to FK."""
    values = _settings(character_map)
    return values | {(switch.bone, switch.property): switch.fk for _, switch in _switches(character_map)}


def fk_properties(character_map: CharacterMap, options: RetargetOptions) -> dict[Property, Value]:
    """The switches that show FK of the limbs that are keyed in both."""
    return {
        (switch.bone, switch.property): switch.fk
        for limb, switch in _switches(character_map)
        if limb_keys(character_map, options, limb) is LimbKeys.BOTH
    }


def _settings(character_map: CharacterMap) -> dict[Property, Value]:
    return {(setting.bone, setting.property): setting.value for setting in character_map.settings}


def _switches(character_map: CharacterMap) -> Iterator[tuple[str, Switch]]:
    for limb, controls in character_map.ik.items():
        if controls.switch is not None:
            yield limb, controls.switch
