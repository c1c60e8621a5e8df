"""Recognition of Rigify's rigs, as Blender makes them: people are recognized, animals refused."""

from pathlib import Path

import _metarigs
import bpy
import pytest
from _armatures import run_script
from _characters import renamed
from keymark.core.errors import InputError
from keymark.core.retarget.character import Character
from keymark.core.retarget.character_motion import find_stance
from keymark.core.retarget.recognition.recognize import Recognition, recognize
from keymark.operators.bridge.character.read_character import read_character

PEOPLE = ("human", "basic_human")
ANIMALS = tuple(name for name in _metarigs.METARIGS if name not in PEOPLE)
ROLES = {
    "hips": "spine",
    "spine": "spine.001 spine.002 spine.003",
    "neck": "spine.004 spine.005",
    "head": "spine.006",
} | {
    f"{part}.{side}": f"{part}.{side}"
    for side in "LR"
    for part in ("shoulder", "upper_arm", "forearm", "hand", "thigh", "shin", "foot", "toe")
}
FINGERS = {
    f"{finger}.{side}": " ".join(f"{bone}.{number:02}.{side}" for number in (1, 2, 3))
    for side in "LR"
    for finger in ("thumb", "index", "middle", "ring", "pinky")
    for bone in ("thumb" if finger == "thumb" else f"f_{finger}",)
}


@pytest.fixture(scope="module")
def rigs(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Character]:
    """All metarigs and the generated full human by name."""
    path = tmp_path_factory.mktemp("metarigs") / "metarigs.blend"
    run_script(Path(_metarigs.__file__), path)
    bpy.ops.wm.open_mainfile(filepath=str(path), use_scripts=False)
    names = (*_metarigs.METARIGS, "generated")
    return {name: read_character(bpy.data.objects[name]) for name in names}


def played(found: Recognition, character: Character, original: Character) -> dict[str, str]:
    """Bones by role with the names of the original, without what says whether they are controls."""
    names = [bone.name.removeprefix("ORG-").removeprefix("DEF-") for bone in original.bones]
    return {
        role: " ".join(names[character.index[bone]] for bone in bones.bones)
        for role, bones in found.character_map.roles.items()
    }


@pytest.mark.slow
@pytest.mark.parametrize("name", [*PEOPLE, "generated"])
def test_people_are_recognized_with_names_and_without(rigs: dict[str, Character], name: str) -> None:
    character = rigs[name]
    found = recognize(character)
    assert found.character_map.preset == ("rigify" if name == "generated" else "rigify_metarig")
    roles = ROLES if name == "basic_human" else ROLES | FINGERS
    assert played(found, character, character) == roles and found.doubts == ()
    plain = renamed(character)
    placed = ROLES | FINGERS if name == "human" else ROLES  # the whole rig has too much on its hands
    assert played(recognize(plain), plain, character) == placed
    assert abs(find_stance(character, found.character_map) - [[1, 0, 0], [0, 1, 0], [0, 0, 1]]).max() < 1e-9


@pytest.mark.slow
@pytest.mark.parametrize("name", ANIMALS)
def test_animals_are_refused_with_names_and_without(rigs: dict[str, Character], name: str) -> None:
    for character in (rigs[name], renamed(rigs[name])):
        with pytest.raises(InputError):
            recognize(character)


def test_controls_of_a_generated_rig_are_those_it_has(rigify: bpy.types.Object) -> None:
    found = recognize(read_character(rigify))
    character_map, bones = found.character_map, rigify.pose.bones
    assert found.character_map.preset == "rigify" and found.doubts == ()
    assert character_map.root == "root" and character_map.ik.keys() == {"arm.L", "arm.R", "leg.L", "leg.R"}
    for setting in character_map.settings:
        assert type(bones[setting.bone][setting.property]) is type(setting.value)
    for controls in character_map.ik.values():
        assert controls.pole in bones and controls.switch is not None
        assert controls.switch.property in bones[controls.switch.bone]
    assert len(character_map.settings) == 22 and len(character_map.fk) == len(character_map.roles)
    for role, keyed in character_map.fk.items():
        for control, bone in zip(keyed, character_map.bones(role), strict=True):
            if control is not None and role != "hips":
                apart = bones[control].bone.head_local - bones[bone].bone.head_local
                assert apart.length < 1e-5, (role, control)
