"""Fingers of characters: found by names or across the palm, bent as far as the performer's from any rest."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from _characters import plain_character, plain_map, renamed, shared_characters
from _performances import solved, steps
from keymark.core.arrays import Array
from keymark.core.body.fingers import RESTING, finger_bones, flexions, palm_axes
from keymark.core.body.rotations import hinge, logarithm, smallest
from keymark.core.body.skeleton import FINGERS
from keymark.core.numerics.vectors import unit
from keymark.core.retarget.character import FINGER_ROLES, Character, CharacterBone
from keymark.core.retarget.character_motion import CharacterMotion
from keymark.core.retarget.maps.character_map import CharacterMap
from keymark.core.retarget.recognition.fingers import find_fingers
from keymark.core.retarget.recognition.recognize import recognize

Namer = Callable[[str, int, str], str]
WHERE = {"L": "Left", "R": "Right"}
VRM = ("Proximal", "Intermediate", "Distal")
NAMERS: dict[str, Namer] = {
    "rigify": lambda finger, n, side: f"{'' if finger == 'thumb' else 'f_'}{finger}.0{n}.{side}",
    "mixamo": lambda finger, n, side: f"mixamorig:{WHERE[side]}Hand{finger.title()}{n}",
    "unreal": lambda finger, n, side: f"{finger}_0{n}_{side.lower()}",
    "vrm": lambda finger, n, side: (
        f"{WHERE[side].lower()}{finger.replace('pinky', 'little').title()}{VRM[n - 1]}"
    ),
    "vroid": lambda finger, n, side: f"J_Bip_{side}_{finger.replace('pinky', 'little').title()}{n}",
    "arp": lambda finger, n, side: f"{finger}{n}.{side.lower()}",
    "character creator": lambda finger, n, side: (
        f"CC_Base_{side}_{finger.replace('middle', 'mid').title()}{n}"
    ),
    "daz": lambda finger, n, side: f"{side.lower()}{finger.replace('middle', 'mid').title()}{n}",
    "smpl-x": lambda finger, n, side: f"{WHERE[side].lower()}_{finger}{n}",
    "none": lambda finger, n, side: f"b{FINGERS.index(finger) * 7 % 5}{n}{side}",
}


def with_fingers(name: Namer, curl_rad: float = 0.0, palms: bool = False, ends: bool = False) -> Character:
    """A character with three bones to a finger, bent at rest, maybe with bones in the palm and ends."""
    character = plain_character(without=("finger",))
    bones = list(character.bones)
    for side in RESTING:
        hand = character.index[f"hand.{side}"]
        wrist, above, place, turn = bones[hand].head, hand, np.zeros(3), np.eye(3)
        for bone, start, end, axis in finger_bones(side):
            finger, number, _ = bone.split(".")
            if number == "1":
                above, place, turn = hand, start, np.eye(3)
                if palms and finger != "thumb":
                    bones.append(_bone(f"palm {bone}", hand, wrist + 0.03 * start, wrist + 0.2 * start))
                    above = len(bones) - 1
            turn = turn @ hinge(axis, np.array(curl_rad))
            after = place + turn @ (end - start)
            bones.append(
                _bone(name(finger, int(number), side), above, wrist + 0.2 * place, wrist + 0.2 * after)
            )
            above, place = len(bones) - 1, after
            if ends and number == "3":
                bones.append(
                    _bone(f"end {bone}", above, bones[above].tail, bones[above].tail + [0.0, 0.0, 0.01])
                )
    return Character("Character", tuple(bones))


def _bone(name: str, parent: int, head: Array, tail: Array) -> CharacterBone:
    rest = np.eye(4)
    rest[:3, :3], rest[:3, 3] = smallest(np.array([0.0, 1.0, 0.0]), unit(tail - head)), head
    return CharacterBone(name, parent, rest, tail)


@pytest.mark.parametrize("ends", [False, True])
@pytest.mark.parametrize("convention", NAMERS)
def test_fingers_are_found_by_their_names_or_their_places(convention: str, ends: bool) -> None:
    name = NAMERS[convention]
    character = with_fingers(name, 0.3, palms=ends, ends=ends)
    found = find_fingers(character, plain_map(character))
    assert {role: bones.bones for role, bones in found.items()} == {
        role: tuple(name(role[:-2], number, role[-1]) for number in (1, 2, 3)) for role in FINGER_ROLES
    }
    assert {bones.source for bones in found.values()} == {"shape" if convention == "none" else "names"}


def test_what_hangs_on_a_hand_is_no_finger_and_known_ones_stay() -> None:
    character = plain_character()
    assert find_fingers(character, plain_map(character)) == {}
    character = with_fingers(NAMERS["mixamo"])
    fingers = find_fingers(character, plain_map(character))
    own = {role: bones for role, bones in fingers.items() if role in ("index.L", "ring.R")}
    known = replace(plain_map(character), roles={**plain_map(character).roles, **own})
    assert find_fingers(character, known) == {}


@pytest.mark.parametrize("kind", shared_characters())
def test_fingers_of_shared_characters(kind: str) -> None:
    character = shared_characters()[kind]
    by_name = recognize(character).character_map
    by_place = recognize(renamed(character)).character_map
    for role in FINGER_ROLES if kind != "cmu_mb" else ():
        found = [renamed(character).index[bone] for bone in by_place.bones(role)]
        assert len(found) == 3
        assert [character.index[bone] for bone in by_name.bones(role)] == found


def performed(character: Character, wanted: dict[str, Array]) -> tuple[CharacterMap, CharacterMotion]:
    character_map = plain_map(character)
    roles = {**character_map.roles, **find_fingers(character, character_map)}
    character_map = replace(character_map, roles=roles)
    return character_map, solved(character, character_map, replace(steps(), fingers=wanted))


@pytest.mark.parametrize("ends", [False, True])
@pytest.mark.parametrize("rest_rad", [0.0, 0.35])
def test_fingers_bend_as_far_as_the_performers(rest_rad: float, ends: bool) -> None:
    character = with_fingers(NAMERS["mixamo"], rest_rad, ends=ends)
    frames = np.arange(len(steps().time_s))[:, None]
    wanted = {
        role: 0.5 + 0.4 * np.sin(0.1 * frames + number) + np.array([0.1, 0.2, -0.1])
        for number, role in enumerate(FINGER_ROLES)
    }
    character_map, motion = performed(character, wanted)
    for role, angles in wanted.items():
        bones = character_map.bones(role)
        heads = [motion.poses[bone][:, :3, 3] for bone in (f"hand.{role[-1]}", *bones)]
        last = character.bone(bones[-1])
        pose = motion.poses[bones[-1]] @ np.linalg.inv(last.rest)
        tip = pose[:, :3, :3] @ last.tail + pose[:, :3, 3]
        ways = unit(np.diff(np.stack([*heads, tip], axis=1), axis=1))
        axis = unit(np.cross(ways[:, 1], ways[:, 2]))
        off = np.degrees(flexions(ways, axis) - angles)
        assert np.abs(off[:, 1:]).max() < 1.0
        assert np.abs(off[:, 0]).max() < 3.0


@pytest.mark.parametrize("kind", [kind for kind in shared_characters() if kind != "cmu_mb"])
def test_palms_face_as_the_performers(kind: str) -> None:
    character = shared_characters()[kind]
    character_map = recognize(character).character_map
    motion = solved(character, character_map, steps())
    for side in RESTING:
        (hand,) = character_map.bones(f"hand.{side}")
        starts = [
            character.bone(character_map.bones(f"{finger}.{side}")[0]).head - character.bone(hand).head
            for finger in FINGERS[1:]
        ]
        resting = palm_axes(np.mean(starts, axis=0), starts[0] - starts[-1], side)
        own = motion.poses[hand][:, :3, :3] @ character.bone(hand).rest[:3, :3].T @ resting
        palm = steps().turn[f"hand.{side}"] @ RESTING[side]
        apart = logarithm(np.swapaxes(motion.to_world.rotation @ own, -1, -2) @ palm)
        assert np.degrees(np.linalg.norm(apart, axis=-1)).max() < 0.1


def test_fingers_that_nobody_saw_follow_the_hand() -> None:
    character = with_fingers(NAMERS["unreal"], 0.2)
    _, motion = performed(character, {})
    for bone, above in (("index_02_l", "hand.L"), ("thumb_01_r", "hand.R")):
        rest = np.linalg.inv(character.bone(above).rest) @ character.bone(bone).rest
        np.testing.assert_allclose(motion.poses[bone], motion.poses[above] @ rest, atol=1e-9)
