"""A character map made ready for its character: soles of the mesh, controls found, properties checked."""

from collections.abc import Callable, Mapping
from dataclasses import replace

import bpy

from ....core.retarget.character import Character
from ....core.retarget.maps.character_map import CharacterMap, IkControls, Switch
from ....core.retarget.recognition.root_bone import find_root
from ....core.retarget.stance import find_stance
from .mesh_soles import mesh_soles


def complete_map(
    armature_object: bpy.types.Object, character: Character, character_map: CharacterMap
) -> tuple[CharacterMap, tuple[str, ...]]:
    """Add to a map what only Blender knows; what it says stays. Notes say what of it the rig lacks."""
    completed, notes = _with_properties(armature_object, character_map)
    if completed.root is None:
        up = find_stance(character, completed)[2]
        completed = replace(completed, root=find_root(character, completed, up))
    if not completed.soles:
        completed = replace(completed, soles=mesh_soles(armature_object, character, completed))
    return completed, notes


def _switched(controls: IkControls, there: Callable[[str, str], bool]) -> IkControls:
    """Controls of a limb without a switch that is not there."""
    switch = controls.switch
    return (
        controls if switch is None or there(switch.bone, switch.property) else replace(controls, switch=None)
    )


def _lost_switches(before: Mapping[str, IkControls], after: Mapping[str, IkControls]) -> list[Switch]:
    switches = ((before[limb].switch, after[limb].switch) for limb in before)
    return [first for first, second in switches if first is not None and second is None]


def _with_properties(
    armature_object: bpy.types.Object, character_map: CharacterMap
) -> tuple[CharacterMap, tuple[str, ...]]:
    """The map without settings and switches that the armature lacks, and sentences on them."""
    bones = armature_object.pose.bones

    def there(bone: str, name: str) -> bool:
        return isinstance(bones[bone].get(name), int | float)

    settings = tuple(one for one in character_map.settings if there(one.bone, one.property))
    ik = {limb: _switched(controls, there) for limb, controls in character_map.ik.items()}
    lost = [(one.bone, one.property) for one in character_map.settings if one not in settings]
    lost += [(one.bone, one.property) for one in _lost_switches(character_map.ik, ik)]
    notes = tuple(
        (
            f"Bone '{bone}' has no property '{name}' that could be keyed; the rig may be of another "
            f"version than the map '{character_map.title}'"
        )
        for bone, name in lost
    )
    return replace(character_map, settings=settings, ik=ik), notes
