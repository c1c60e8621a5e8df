"""Mirroring a map: partners by the names of the sides, by places where names do not tell, or none."""

from dataclasses import replace

import numpy as np
import pytest
from _characters import plain_character, plain_map, renamed
from keymark.core.arrays import Array
from keymark.core.body.rotations import hinge
from keymark.core.retarget.character import LIMBS, ROLES, Character, CharacterBone
from keymark.core.retarget.maps.character_map import CharacterMap, IkControls, RoleBones, Switch
from keymark.core.retarget.maps.map_registry import mirrored_map

LEFT, RIGHT = (LIMBS[f"arm.{side}"] + LIMBS[f"leg.{side}"] for side in "LR")


def only_left(character_map: CharacterMap) -> CharacterMap:
    """The map without the right side."""
    return replace(character_map, roles={r: b for r, b in character_map.roles.items() if r not in RIGHT})


def by_place(character: Character, whole: CharacterMap) -> CharacterMap:
    """The map of a character with its bones renamed, by where they were."""
    names = {old.name: new.name for old, new in zip(character.bones, renamed(character).bones, strict=True)}
    return replace(
        whole,
        roles={
            role: RoleBones(tuple(names[bone] for bone in found.bones)) for role, found in whole.roles.items()
        },
    )


def about_z(angle_deg: float) -> Array:
    """A turn."""
    return hinge(np.array([0.0, 0.0, 1.0]), np.array(np.radians(angle_deg)))


@pytest.mark.parametrize("arms_down_deg", [0.0, 45.0])
@pytest.mark.parametrize("turn_deg", [0.0, 90.0, 180.0, 57.0])
def test_the_right_side_is_found_by_places_alone(arms_down_deg: float, turn_deg: float) -> None:
    named = plain_character(arms_down_deg=arms_down_deg, turn=about_z(turn_deg), scale=0.01)
    whole = by_place(named, plain_map(named))
    mirrored, missing = mirrored_map(renamed(named), only_left(whole), "L")
    assert missing == ()
    assert {role: mirrored.bones(role) for role in ROLES} == {role: whole.bones(role) for role in ROLES}


@pytest.mark.parametrize(
    ("left", "right"),
    [
        ("{}.L", "{}.R"),
        ("l{}", "r{}"),
        ("mixamorig:Left{}", "mixamorig:Right{}"),
        ("{}_l_skin", "{}_r_skin"),
        ("左{}", "右{}"),
    ],
)
def test_names_count_before_places(left: str, right: str) -> None:
    names = {role: (left if role in LEFT else right).format(role[:-2].title()) for role in (*LEFT, *RIGHT)}
    names |= {f"finger.{side}": (left, right)["LR".index(side)].format("Finger") for side in "LR"}
    character = plain_character(names=names)
    moved = tuple(
        replace(bone, rest=bone.rest + 0.2 * np.eye(4, k=3)[:, ::1])
        if bone.name in names.values() and bone.name not in {names[role] for role in LEFT}
        else bone
        for bone in character.bones
    )
    posed = Character("Posed", moved)
    given = CharacterMap(
        "Left", {role: RoleBones((names[role],)) for role in LEFT} | {"hips": RoleBones(("hips",))}
    )
    mirrored, missing = mirrored_map(posed, given, "L")
    assert missing == ()
    assert all(mirrored.bone(role) == names[role] for role in RIGHT)


def test_a_bone_without_a_partner_is_named_and_its_role_stays() -> None:
    whole = plain_character()
    kept = tuple(bone for bone in whole.bones if bone.name != "toe.R")
    index = {bone.name: number for number, bone in enumerate(kept)}
    bones = tuple(
        replace(bone, parent=index[whole.bones[bone.parent].name] if bone.parent >= 0 else -1)
        for bone in kept
    )
    given = only_left(plain_map(whole))
    given = replace(given, roles={**given.roles, "toe.R": RoleBones(("foot.R",))})
    mirrored, missing = mirrored_map(Character("One Toe", bones), given, "L")
    assert missing == ("toe.R",)
    assert mirrored.bone("toe.R") == "foot.R" and mirrored.bone("foot.R") == "foot.R"


def test_from_right_to_left_and_a_twist_bone_is_not_taken() -> None:
    plain = plain_character()
    names = renamed(plain)
    arm = names.bones[plain.index["upper_arm.L"]]
    twist = CharacterBone("bone_twist", arm.parent, arm.rest, 0.5 * (arm.head + arm.tail))
    character = Character("Twisted", (names.bones[0], *names.bones[1:], twist))
    whole = by_place(plain, plain_map(plain))
    right = replace(whole, roles={r: b for r, b in whole.roles.items() if r not in LEFT})
    mirrored, missing = mirrored_map(character, right, "R")
    assert missing == ()
    assert mirrored.bone("upper_arm.L") == arm.name


def test_controls_are_mirrored_with_their_bones() -> None:
    character = plain_character()
    given = only_left(plain_map(character))
    given = replace(
        given,
        fk={"forearm.L": ("finger.L",)},
        ik={"arm.L": IkControls("hand.L", "nowhere", None, Switch("shoulder.L", "IK_FK", 0.0, 1.0))},
    )
    mirrored, _ = mirrored_map(character, given, "L")
    assert mirrored.fk["forearm.R"] == ("finger.R",)
    assert mirrored.ik["arm.R"] == IkControls("hand.R", None, None, Switch("shoulder.R", "IK_FK", 0.0, 1.0))
    assert mirrored.ik["arm.L"] == given.ik["arm.L"]


def test_a_map_without_bones_stays_as_it_is() -> None:
    character = plain_character()
    empty = CharacterMap("Empty", {})
    assert mirrored_map(character, empty, "L") == (empty, ())
