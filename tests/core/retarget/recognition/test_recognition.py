"""Recognition: every convention, every space, many bodies; what is no character is refused."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest
from _body_plan import Plan
from _characters import (
    CONVENTIONS,
    PRESET_OF,
    convention_names,
    plain_character,
    plain_map,
    renamed,
    shared_characters,
)
from _varied import Varied, build, nameless, varied
from keymark.core.arrays import Array
from keymark.core.body.posture import yaw_rotation
from keymark.core.errors import InputError
from keymark.core.retarget.character import FINGER_ROLES, ROLES, Character
from keymark.core.retarget.character_motion import find_stance
from keymark.core.retarget.recognition.recognize import Recognition, find_root, recognize

Y_UP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
TRUTH = {
    "cmu_mb": "Hips|LowerBack Spine Spine1|Neck Neck1|Head|*Shoulder|*Arm|*ForeArm|*Hand"
    "|*UpLeg|*Leg|*Foot|*ToeBase|Left Right",
    "default": "root|spine05 spine04 spine03 spine02 spine01|neck01 neck02 neck03|head|clavicle.*"
    "|upperarm01.*|lowerarm01.*|wrist.*|upperleg01.*|lowerleg01.*|foot.*|toe1-1.*|L R",
    "game_engine": "pelvis|spine_01 spine_02 spine_03|neck_01|head|clavicle_*|upperarm_*|lowerarm_*|hand_*"
    "|thigh_*|calf_*|foot_*|ball_*|l r",
    "mixamo": "Hips|Spine Spine1 Spine2|Neck|Head|*Shoulder|*Arm|*ForeArm|*Hand"
    "|*UpLeg|*Leg|*Foot|*ToeBase|Left Right",
    "rigify_human_toes": "spine|spine.001 spine.002 spine.003 spine.004|spine.005|spine.006|shoulder.*"
    "|upper_arm.*|forearm.*|hand.*|thigh.*|shin.*|foot.*|toe.*|L R",
}
TRUTH["default_no_toes"] = TRUTH["default"]
TRUTH["mixamo_unity"] = TRUTH["mixamo"]


def shared_truth(name: str) -> dict[str, tuple[str, ...]]:
    """Roles of a skeleton beside the project, as its convention has them."""
    *parts, sides = TRUTH[name].split("|")
    prefix = "mixamorig:" if name.startswith("mixamo") else ""
    middle = {
        part: tuple(prefix + bone for bone in bones.split())
        for part, bones in zip(("hips", "spine", "neck", "head"), parts[:4], strict=True)
    }
    limbs = ("shoulder", "upper_arm", "forearm", "hand", "thigh", "shin", "foot", "toe")
    for part, bone in zip(limbs, parts[4:], strict=True):
        for side, word in zip("LR", sides.split(), strict=True):
            middle[f"{part}.{side}"] = (prefix + bone.replace("*", word),)
    return middle


def wrong_roles(found: Recognition, truth: Mapping[str, tuple[str, ...]]) -> list[str]:
    """Roles that other bones play than they should, and those that should not be there; fingers aside."""
    given = found.character_map
    return [role for role in ROLES if role not in FINGER_ROLES and given.bones(role) != truth.get(role, ())]


def plain_truth(character: Character) -> dict[str, tuple[str, ...]]:
    """The roles of a `plain_character`."""
    return {role: bones.bones for role, bones in plain_map(character).roles.items()}


@pytest.mark.parametrize("convention", CONVENTIONS)
def test_names_of_every_convention_are_recognized(convention: str) -> None:
    names = convention_names(convention)
    character = plain_character(names=names, arms_down_deg=40.0)
    truth = {role: tuple(names[b] for b in bones) for role, bones in plain_truth(plain_character()).items()}
    found = recognize(character)
    assert found.character_map.preset == PRESET_OF[convention]
    assert wrong_roles(found, truth) == []
    assert found.doubts == () or not found.character_map.preset
    sources = {bones.source for role, bones in found.character_map.roles.items() if role != "hips"}
    assert sources <= {"preset"} if found.character_map.preset else "names" in sources
    by_names = recognize(character, presets=())
    assert by_names.character_map.preset is None
    assert wrong_roles(by_names, truth) == []


def test_a_rig_without_names_is_recognized_by_its_shape() -> None:
    found = recognize(renamed(plain_character()))
    numbers = {bone.name: f"bone_{n:03}" for n, bone in enumerate(plain_character().bones)}
    truth = {role: tuple(numbers[b] for b in bones) for role, bones in plain_truth(plain_character()).items()}
    assert wrong_roles(found, truth) == []
    assert {bones.source for bones in found.character_map.roles.values()} == {"shape"}


@pytest.mark.parametrize("name", sorted(TRUTH))
def test_the_skeletons_beside_the_project_are_recognized(name: str) -> None:
    characters = shared_characters()
    if name not in characters:
        pytest.skip("no shared/characters beside the repository")
    truth = shared_truth(name)
    assert wrong_roles(recognize(characters[name]), truth) == []
    assert wrong_roles(recognize(characters[name], presets=()), truth) == []
    numbers = {bone.name: f"bone_{n:03}" for n, bone in enumerate(characters[name].bones)}
    plain = {role: tuple(numbers[bone] for bone in bones) for role, bones in truth.items()}
    assert wrong_roles(recognize(renamed(characters[name])), plain) == []


def test_bodies_drawn_at_random_are_recognized_by_names() -> None:
    for seed in range(500, 525):
        character = varied(seed)
        assert wrong_roles(recognize(character.character), character.truth) == [], seed


def test_nameless_bodies_drawn_at_random_are_mostly_recognized() -> None:
    roles = right = silent = 0
    for seed in range(600, 640):
        character = nameless(varied(seed))
        found = recognize(character.character)
        for role, bones in character.truth.items():
            roles += 1
            right += found.character_map.bones(role) == bones
            named = any(role in doubt or "left and right" in doubt for doubt in found.doubts)
            silent += found.character_map.bones(role) != bones and not named
        assert faces(character, found) > 0.9
    assert right >= 0.95 * roles
    assert silent <= 0.01 * roles


def faces(character: Varied, found: Recognition) -> float:
    """Cosine between where a character faces by its recognition and in truth."""
    stance = find_stance(character.character, found.character_map)
    return float((stance @ character.ahead) @ [0.0, -1.0, 0.0])


@pytest.mark.parametrize(
    "turn", [np.eye(3), yaw_rotation(2.0), yaw_rotation(np.radians(35.0)), Y_UP], ids=str
)
@pytest.mark.parametrize("scale", [1.0, 0.01, 100.0])
def test_any_space_is_read(turn: Array, scale: float) -> None:
    character = plain_character(turn=turn, scale=scale)
    for each in (character, renamed(character)):
        found = recognize(each)
        assert len(found.character_map.roles) == len(plain_truth(plain_character()))
        assert np.allclose(find_stance(each, found.character_map), turn.T, atol=1e-9)


def test_feet_on_the_root_are_joined_to_the_shins() -> None:
    for tails in ("good", "aside"):
        character = build(Plan(feet_on="root", root="ground", tails=tails))
        for each in (character, nameless(character)):
            assert wrong_roles(recognize(each.character), each.truth) == []


def test_the_bones_that_deform_are_preferred() -> None:
    character = plain_character()
    count = len(character.bones)
    controls = tuple(
        replace(b, name=f"ctl {b.name}", deforms=False, parent=b.parent + count if b.parent >= 0 else -1)
        for b in character.bones
    )
    found = recognize(replace(character, bones=(*character.bones, *controls)))
    assert wrong_roles(found, plain_truth(character)) == []


def swapped(character: Character) -> Character:
    """The character with the sides in the names exchanged, as if seen from the front."""
    other = {".L": ".R", ".R": ".L"}
    bones = tuple(replace(b, name=b.name[:-2] + other.get(b.name[-2:], b.name[-2:])) for b in character.bones)
    return replace(character, bones=bones)


def test_the_shape_decides_where_names_are_mirrored_unless_only_feet_are_against_them() -> None:
    names, other = convention_names("Mixamo"), {"L": "R", "R": "L"}
    mirrored = {key: names[key[:-1] + other.get(key[-1], key[-1]) if "." in key else key] for key in names}
    straight = build(Plan(elbow_bend_deg=0.0, knee_bend_deg=0.0, fingers=0)).character
    for character, preset, arm, words in (
        (swapped(plain_character()), None, "upper_arm.R", "against the names"),
        (plain_character(names=mirrored), "mixamo", "mixamorig:RightArm", "against the names"),
        (swapped(straight), None, "upper_arm.L", "although the feet"),
    ):
        found = recognize(character)
        assert (found.character_map.preset, found.character_map.bones("upper_arm.L")) == (preset, (arm,))
        assert any("left and right" in doubt and words in doubt for doubt in found.doubts)


def test_a_preset_alone_is_enough_where_the_shape_says_nothing() -> None:
    character = plain_character(names=convention_names("Mixamo"))
    bones = (
        replace(bone, parent=min(bone.parent, 0), tail=bone.head + [0.1, 0.0, 0.0])
        for bone in character.bones
    )
    flat = replace(character, bones=tuple(bones))
    with pytest.raises(InputError):
        recognize(renamed(flat))
    found = recognize(flat)
    assert found.character_map.preset == "mixamo"
    assert found.character_map.bones("foot.L") == ("mixamorig:LeftFoot",)
    assert any("no body was recognized" in doubt for doubt in found.doubts)


def test_a_hand_may_be_missing_on_one_side_and_the_root_is_found() -> None:
    found = recognize(without(plain_character(), "hand.R"))
    assert found.character_map.bones("hand.L") == ("hand.L",)
    assert "hand.R" not in found.character_map.roles
    assert any("hand.R" in doubt for doubt in found.doubts)
    assert recognize(plain_character(root="Base")).character_map.root == "Base"
    assert recognize(plain_character()).character_map.root is None


def without(character: Character, *names: str) -> Character:
    """The character without some bones and all that hangs on them."""
    gone: set[int] = set()
    for number, bone in enumerate(character.bones):
        if bone.name in names or bone.parent in gone:
            gone.add(number)
    kept = [number for number in range(len(character.bones)) if number not in gone]
    place = {number: row for row, number in enumerate(kept)}
    bones = tuple(replace(character.bones[n], parent=place.get(character.bones[n].parent, -1)) for n in kept)
    return replace(character, bones=bones)


def quadruped(names: Mapping[str, str] | None = None) -> Character:
    """The plain body on all fours: the trunk level, all limbs down to the ground."""
    character = plain_character(names=names, arms_down_deg=90.0, without=("finger",))
    keys = [bone.name for bone in plain_character(without=("finger",)).bones]
    level = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
    hips = np.array([0.0, 0.0, 0.95])
    bones = []
    for key, bone in zip(keys, character.bones, strict=True):
        rest, tail = bone.rest.copy(), bone.tail.copy()
        part = key.partition(".")[0]
        if part in ("upper_arm", "forearm", "hand"):
            shift = level @ (character.bones[keys.index("upper_arm.L")].head * [0.0, 1.0, 1.0] - hips)
            shift = shift + hips - character.bones[keys.index("upper_arm.L")].head * [0.0, 1.0, 1.0]
            rest[:3, 3] += shift
            tail = tail + shift
            stretch = np.array([1.0, 1.0, 1.7])
            rest[:3, 3] = (rest[:3, 3] - [0, 0, 0.95]) * stretch + [0, 0, 0.95]
        elif part in ("spine", "chest", "neck", "head", "shoulder"):
            rest[:3, 3] = level @ (rest[:3, 3] - hips) + hips
            tail = level @ (tail - hips) + hips
        bones.append(replace(bone, rest=rest, tail=tail))
    return Character("Animal", tuple(bones))


def chain(count: int) -> Character:
    """A rope."""
    template = plain_character().bones[0]
    rests = np.tile(np.eye(4), (count, 1, 1))
    rests[:, 2, 3] = 0.1 * np.arange(count)
    bones = (
        replace(template, name=f"rope{n}", parent=n - 1, rest=rest, tail=rest[:3, 3] + 0.1)
        for n, rest in enumerate(rests)
    )
    return Character("Rope", tuple(bones))


PLAIN = plain_character()
REFUSED = {
    "no bones": (replace(PLAIN, bones=()), "no bones"),
    "too few": (replace(PLAIN, bones=PLAIN.bones[:4]), "4 bones, at least 11"),
    "no scale": (replace(PLAIN, scale=0.0), "scale is 0"),
    "no number": (replace(PLAIN, scale=float("nan")), "scale is nan"),
    "no place": (
        replace(PLAIN, bones=(replace(PLAIN.bones[0], tail=np.full(3, np.nan)), *PLAIN.bones[1:])),
        "'hips'",
    ),
    "no size": (replace(PLAIN, bones=tuple(replace(b, rest=np.eye(4)) for b in PLAIN.bones)), "no size"),
    "an animal": (quadruped(), "animal"),
    "a nameless animal": (renamed(quadruped()), "animal"),
    "an animal with a person's names": (quadruped(convention_names("Mixamo")), "animal"),
    "a rope": (chain(20), "mirror"),
    "no right arm": (without(PLAIN, "upper_arm.R"), "a left arm but no right one"),
    "no left leg": (without(PLAIN, "thigh.L"), "a right leg but no left one"),
    "no arms": (without(PLAIN, "shoulder.L", "shoulder.R"), "no pair of legs and pair of arms"),
    "no feet": (without(PLAIN, "foot.L", "foot.R"), "legs without feet"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_is_no_character_is_refused_in_a_sentence(case: str) -> None:
    character, words = REFUSED[case]
    with pytest.raises(InputError) as error:
        recognize(character)
    sentence = str(error.value)
    assert words in sentence and character.name in sentence and "\n" not in sentence


def test_an_actor_of_keymark_is_refused() -> None:
    names = dict(zip(plain_character().index, HUMAN_NAMES, strict=False))
    with pytest.raises(InputError, match="actor of Keymark"):
        recognize(plain_character(names=names))


HUMAN_NAMES = (
    *("pelvis", "chest", "head"),
    *(f"{part}.{side}" for side in "LR" for part in ("girdle", "upper_arm", "forearm", "hand")),
    *(f"{part}.{side}" for side in "LR" for part in ("thigh", "shin", "foot")),
)


def test_bones_that_only_constraints_carry_are_found_by_their_controls() -> None:
    plain = plain_character()
    flat = [replace(bone, name=f"DEF-{bone.name}", parent=-1, connected=False) for bone in plain.bones]
    controls = [replace(bone, name=f"c_{bone.name}", deforms=False) for bone in plain.bones]
    found = recognize(Character("Flat", tuple([*controls, *flat])))
    assert {role: bones.bones for role, bones in found.character_map.roles.items()} == {
        role: tuple(f"DEF-{name}" for name in bones.bones)
        for role, bones in recognize(plain).character_map.roles.items()
    }
    assert found.doubts == ()


def test_the_root_of_the_controls_is_the_root_of_the_character() -> None:
    plain = plain_character(root="root")
    flat = [
        replace(bone, name=f"DEF-{bone.name}", parent=-1, connected=False)
        for bone in plain.bones
        if bone.name != "root"
    ]
    controls = [replace(bone, deforms=False) for bone in plain.bones]
    character = Character("Flat", tuple([*controls, *flat]))
    found = recognize(character).character_map
    assert found.bone("hips") == "DEF-hips" and found.root is None
    fk = {
        role: tuple(name.removeprefix("DEF-") for name in bones.bones) for role, bones in found.roles.items()
    }
    assert find_root(character, replace(found, fk=fk), np.array([0.0, 0.0, 1.0])) == "root"


def with_loose_feet(shift: tuple[float, float, float]) -> Character:
    """Feet without toes and without a parent, moved [m]."""
    bones = []
    for bone in plain_character(without=("toe",)).bones:
        if bone.name.startswith("foot"):
            bone = replace(bone, rest=bone.rest + 0.0, parent=-1)
            bone.rest[:3, 3] += shift
        bones.append(bone)
    return Character("Robot", tuple(bones))


@pytest.mark.parametrize("drop_m", [0.0, 0.04, 0.08])
@pytest.mark.parametrize("named", [True, False])
def test_feet_without_a_parent_are_those_of_the_legs(drop_m: float, named: bool) -> None:
    character = with_loose_feet((0.0, 0.0, -drop_m))
    looked_at = character if named else renamed(character)
    known = recognize(looked_at).character_map
    feet = [character.bone(f"foot.{side}").head for side in "LR"]
    found = [looked_at.bone(str(known.bone(f"foot.{side}"))).head for side in "LR"]
    np.testing.assert_allclose(np.sort(np.array(found), axis=0), np.sort(np.array(feet), axis=0))


def test_feet_far_from_any_leg_are_refused_for_what_they_are() -> None:
    with pytest.raises(InputError, match=r"the feet .foot\.L. and .foot\.R. have no parent"):
        recognize(with_loose_feet((0.0, -3.0, 0.0)))
