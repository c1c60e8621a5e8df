"""A performer's motion on characters of many shapes: directions, feet, place, and what is left alone."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from _characters import plain_character, plain_map, shared_characters
from _performances import (
    joints,
    performance,
    quality,
    shaped,
    solved,
    source_joints,
    stepping,
    steps,
    steps_elsewhere,
)
from keymark.core.arrays import Array
from keymark.core.body.kinematics import SegmentMotion, segment_motion
from keymark.core.body.posture import Posture, yaw_rotation
from keymark.core.errors import InputError
from keymark.core.feet.natural_extremities import natural_extremities
from keymark.core.retarget.character import LONG_BONES, Character, Similarity
from keymark.core.retarget.character_motion import CharacterMotion
from keymark.core.retarget.maps.character_map import CharacterMap, RoleBones
from keymark.core.retarget.quality import direction_errors_deg
from keymark.core.retarget.recognition.recognize import recognize
from keymark.core.take.conversion_settings import Placement, RetargetOptions, RootMotion

FREE = RetargetOptions(plant_feet=False, reach_hands=False)
LYING = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
"""Turns an armature's space so that X is up in it."""


def wider_hips(name: str, place: Array) -> Array:
    """Legs 7 cm farther out."""
    out = name.startswith(("thigh", "shin", "foot", "toe"))
    return place + [0.07 * np.sign(place[0]) * out, 0.0, 0.0]


def bent_knees(name: str, place: Array) -> Array:
    """Knees 10 cm farther ahead."""
    at_knee = name.startswith(("shin", "thigh")) and abs(place[2] - 0.49) < 0.01
    return place - [0.0, 0.1 * at_knee, 0.0]


def short_legs(name: str, place: Array) -> Array:
    """Legs half as long, and all above them lower."""
    low = place[2]
    height = low if low < 0.15 else 0.08 + 0.5 * (low - 0.08) if low <= 0.9 else low - 0.41
    return np.array([place[0], place[1], height])


def feet_on_root() -> tuple[Character, CharacterMap]:
    """Feet that hang on the root, and arms without clavicles."""
    character = plain_character(root="root", without=("shoulder",))
    bones = tuple(
        replace(bone, parent=0) if bone.name.startswith("foot") else bone for bone in character.bones
    )
    loose = Character(character.name, bones)
    return loose, plain_map(loose)


SHAPES = {
    "T": lambda: shaped(lambda _, place: place),
    "A": lambda: shaped(lambda _, place: place, arms_down_deg=45.0),
    "hanging": lambda: shaped(lambda _, place: place, arms_down_deg=88.0),
    "tiny": lambda: shaped(lambda _, place: place, scale=0.01),
    "bare": lambda: shaped(lambda _, place: place, without=("toe", "shoulder", "chest", "spine", "finger")),
    "lying": lambda: shaped(lambda _, place: place, turn=LYING),
    "rolled": lambda: shaped(lambda _, place: place, roll_rad=0.7),
    "wide": lambda: shaped(wider_hips),
    "bent": lambda: shaped(bent_knees),
    "short": lambda: shaped(short_legs),
    "loose": feet_on_root,
}


def assert_stands(
    character: Character,
    character_map: CharacterMap,
    motion: CharacterMotion,
    source: SegmentMotion | None = None,
) -> None:
    """Resting feet do not slide, none is in the ground, and legs are about as the performer's."""
    figures = quality(character, character_map, source or steps(), motion)
    assert motion.rests and (figures.skate_worst_mm or 0.0) < 0.01
    assert (figures.penetration_mm or 0.0) < 0.1
    assert figures.legs_deg is not None and figures.legs_deg < 1.5
    assert figures.legs_worst_deg is not None and figures.legs_worst_deg < 8.0


def assert_points_alike(character_map: CharacterMap, motion: CharacterMotion, limbs: Sequence[str]) -> None:
    """The limbs point where the performer's do."""
    for limb in limbs:
        shown = joints(character_map, motion)
        errors = direction_errors_deg(source_joints(steps()), shown, LONG_BONES[limb])
        assert errors.shape == (118, 2) and errors.max() < 0.01


@pytest.mark.parametrize("shape", SHAPES)
def test_a_body_of_any_shape_points_stands_and_stays_rigid(shape: str) -> None:
    character, character_map = SHAPES[shape]()
    assert_points_alike(character_map, solved(character, character_map, steps(), FREE), tuple(LONG_BONES))
    motion = solved(character, character_map, steps())
    assert_stands(character, character_map, motion)
    assert len(motion.rests) == 4
    for pose in motion.poses.values():
        turn = pose[:, :3, :3]
        np.testing.assert_allclose(turn @ np.swapaxes(turn, -1, -2), [np.eye(3)] * 118, atol=1e-9)
        assert (np.linalg.det(turn) > 0.0).all()
    for above, below in (("thigh", "shin"), ("shin", "foot"), ("upper_arm", "forearm"), ("forearm", "hand")):
        rest = np.linalg.norm(character.bone(f"{above}.L").head - character.bone(f"{below}.L").head)
        way = motion.poses[f"{above}.L"][:, :3, 3] - motion.poses[f"{below}.L"][:, :3, 3]
        np.testing.assert_allclose(np.linalg.norm(way, axis=-1), rest, rtol=1e-6)


@pytest.mark.parametrize("shape", ["T", "bare", "wide", "short"])
def test_nothing_pops(shape: str) -> None:
    character, character_map = SHAPES[shape]()
    planted = joints(character_map, solved(character, character_map, steps()))
    free = joints(character_map, solved(character, character_map, steps(), FREE))
    for role in ("shin.L", "shin.R", "foot.L", "foot.R", "hips", "hand.L"):
        before, after = (
            np.linalg.norm(np.diff(paths[role], 2, axis=0), axis=-1) for paths in (free, planted)
        )
        assert after.max() < 1.5 * before.max()


def test_the_character_stands_and_faces_where_the_performer_does() -> None:
    character, character_map = SHAPES["lying"]()
    source = steps_elsewhere()
    motion = solved(character, character_map, source)
    plain = solved(character, character_map, steps())
    for name, pose in motion.poses.items():
        np.testing.assert_allclose(pose, plain.poses[name], atol=1e-6)
    up = motion.to_world.rotation @ LYING @ [0.0, 0.0, 1.0]
    np.testing.assert_allclose(up, [0.0, 0.0, 1.0], atol=1e-9)
    hips = 0.5 * (source.start["thigh.L"][0] + source.start["thigh.R"][0])
    shown = joints(character_map, motion)
    middle = 0.5 * (shown["thigh.L"][0] + shown["thigh.R"][0])
    np.testing.assert_allclose(middle[:2], hips[:2], atol=1e-6)
    across, across_source = (
        shown["thigh.L"][0] - shown["thigh.R"][0],
        source.start["thigh.L"] - source.start["thigh.R"],
    )
    np.testing.assert_allclose(
        across / np.linalg.norm(across), across_source[0] / np.linalg.norm(across_source[0]), atol=1e-6
    )


def test_a_smaller_character_goes_a_smaller_way() -> None:
    character, character_map = SHAPES["short"]()
    motion = solved(character, character_map, steps())
    whole, whole_map = SHAPES["T"]()
    other = solved(whole, whole_map, steps())
    ratio = motion.size / other.size
    assert 0.4 < ratio < 0.6
    small = motion.to_world.to_world(motion.poses["hips"][:, :3, 3])
    large = other.to_world.to_world(other.poses["hips"][:, :3, 3])
    way, expected = small[:, :2] - small[0, :2], ratio * (large[:, :2] - large[0, :2])
    np.testing.assert_allclose(way, expected, atol=0.006)
    np.testing.assert_allclose(small[0, :2], large[0, :2], atol=0.01)


def test_the_character_may_stay_where_it_is() -> None:
    character, character_map = SHAPES["T"]()
    here = Similarity(yaw_rotation(np.array(0.4)), np.array([5.0, 6.0, 0.5]), 1.0)
    options = RetargetOptions(place=Placement.CHARACTER)
    motion = solved(character, character_map, steps_elsewhere(), options, here)
    assert motion.to_world is here
    assert_stands(character, character_map, motion, steps_elsewhere())
    np.testing.assert_allclose(joints(character_map, motion)["hips"][0, :2], [5.0, 6.0], atol=0.02)


def test_the_way_may_be_taken_off_or_go_onto_the_root() -> None:
    body, posture = stepping()
    frames = posture.batch[0]
    walked = posture.translation + np.linspace([0.0, 0.0, 0.0], [2.0, -3.0, 0.0], frames)
    source = performance(body, Posture(posture.skeleton, walked, posture.rotations, posture.angles))
    character = plain_character(root="root")
    character_map = replace(plain_map(character), root="root")
    filmed = solved(character, character_map, source)
    in_place = solved(character, character_map, source, RetargetOptions(root_motion=RootMotion.IN_PLACE))
    on_root = solved(character, character_map, source, RetargetOptions(root_motion=RootMotion.ROOT_BONE))
    hips = in_place.poses["hips"][:, :3, 3]
    assert np.linalg.norm(hips - hips[0], axis=-1).max() < 0.3
    np.testing.assert_allclose(hips + in_place.way_m, filmed.poses["hips"][:, :3, 3], atol=1e-9)
    assert filmed.root is None and in_place.root is None and on_root.root is not None
    for name, pose in filmed.poses.items():
        np.testing.assert_allclose(on_root.poses[name], pose, atol=1e-12)
    np.testing.assert_allclose(on_root.root[0], character.bone("root").rest, atol=1e-9)
    hips = filmed.poses["hips"][:, :2, 3]
    np.testing.assert_allclose(on_root.root[-1, :2, 3], hips[-1] - hips[0] + on_root.root[0, :2, 3], atol=0.1)
    up = on_root.root[:, :3, :3] @ character.bone("root").rest[:3, :3].T @ [0.0, 0.0, 1.0]
    np.testing.assert_allclose(up, [[0.0, 0.0, 1.0]] * frames, atol=1e-9)


def test_without_a_root_bone_the_way_stays_on_the_hips_and_is_said() -> None:
    character, character_map = SHAPES["T"]()
    motion = solved(character, character_map, steps(), RetargetOptions(root_motion=RootMotion.ROOT_BONE))
    assert motion.root is None and "root bone" in motion.notes[0]


def test_roles_left_alone_go_with_what_carries_them() -> None:
    character = plain_character()
    character_map = replace(plain_map(character), left_alone=("head", "shoulder.L", "toe.L", "hand.R"))
    motion = solved(character, character_map, steps(), FREE)
    assert not {"head", "shoulder.L", "toe.L", "hand.R"} & set(motion.poses)
    chest, arm = motion.poses["chest"], motion.poses["upper_arm.L"]
    local = np.linalg.solve(chest, arm)[:, :3, 3]
    np.testing.assert_allclose(local, local[:1].repeat(len(local), 0), atol=1e-9)
    assert_points_alike(character_map, motion, ("arm.L",))


def test_a_leg_left_alone_is_not_planted_and_hips_left_alone_stay() -> None:
    character = plain_character()
    known = plain_map(character)
    legless = solved(character, replace(known, left_alone=("shin.L",)), steps())
    assert {rest.leg for rest in legless.rests} == {"leg.R"}
    motion = solved(character, replace(known, left_alone=("hips",)), steps())
    assert "hips" not in motion.poses and motion.rests == ()
    thigh = motion.poses["thigh.L"][:, :3, 3]
    np.testing.assert_allclose(thigh, thigh[:1].repeat(len(thigh), 0), atol=1e-9)
    assert thigh[0] @ [0.0, 0.0, 1.0] == pytest.approx(0.9)


def test_the_spine_shares_its_turn() -> None:
    character = plain_character()
    for shares, expected in (((), 0.5), ((0.2, 1.0), 0.2)):
        roles = {**plain_map(character).roles, "spine": RoleBones(("spine", "chest"), shares=shares)}
        motion = solved(character, CharacterMap("Plain", roles), steps(), FREE)
        turns = {
            name: motion.poses[name][:, :3, :3] @ character.bone(name).rest[:3, :3].T
            for name in ("hips", "spine", "chest")
        }
        angles = {name: _angles(np.swapaxes(turns["hips"], -1, -2) @ turn) for name, turn in turns.items()}
        np.testing.assert_allclose(angles["spine"], expected * angles["chest"], atol=1e-6)


def _angles(turn: Array) -> Array:
    return np.arccos(np.clip(0.5 * (np.trace(turn, axis1=-2, axis2=-1) - 1.0), -1.0, 1.0))


@pytest.mark.parametrize("arms_down_deg", [30.0, 60.0, 88.0])
def test_palms_do_not_turn_over(arms_down_deg: float) -> None:
    lowered, first = plain_character(arms_down_deg=arms_down_deg), plain_character()
    turns = []
    for character, angle in ((first, 0.0), (lowered, np.radians(arms_down_deg))):
        motion = solved(character, plain_map(character), steps(), FREE)
        rest = character.bone("hand.L").rest[:3, :3]
        palm = rest.T @ [-np.sin(angle), 0.0, -np.cos(angle)]
        turns.append(motion.poses["hand.L"][:, :3, :3] @ palm)
    assert np.degrees(np.arccos(np.clip(np.sum(turns[0] * turns[1], axis=-1), -1.0, 1.0))).max() < 5.0


def test_bends_point_to_elbows_and_knees() -> None:
    character, character_map = SHAPES["T"]()
    motion = solved(character, character_map, steps())
    for limb, (upper, lower, end) in {
        "arm.L": ("upper_arm.L", "forearm.L", "hand.L"),
        "leg.R": ("thigh.R", "shin.R", "foot.R"),
    }.items():
        first, middle, last = (motion.poses[name][:, :3, 3] for name in (upper, lower, end))
        bend, line = motion.bends[limb], (last - first) / np.linalg.norm(last - first, axis=-1, keepdims=True)
        np.testing.assert_allclose(np.linalg.norm(bend, axis=-1), 1.0, atol=1e-9)
        np.testing.assert_allclose(np.sum(bend * line, axis=-1), 0.0, atol=1e-9)
        assert (np.sum(bend * (middle - first), axis=-1) > -1e-6).all()
        assert np.sum(bend[1:] * bend[:-1], axis=-1).min() > 0.8


@pytest.mark.parametrize("name", sorted(shared_characters()))
def test_characters_of_other_conventions(name: str) -> None:
    character = shared_characters()[name]
    character_map = recognize(character).character_map
    motion = solved(character, character_map, steps())
    assert_stands(character, character_map, motion)
    assert_points_alike(character_map, solved(character, character_map, steps(), FREE), tuple(LONG_BONES))


def test_a_bone_in_two_roles_and_a_limb_without_length_are_refused() -> None:
    character = plain_character()
    roles = {**plain_map(character).roles, "neck": RoleBones(("head",))}
    with pytest.raises(InputError, match="head.* for both neck and head"):
        solved(character, CharacterMap("Plain", roles), steps())
    character, character_map = shaped(
        lambda name, place: np.array([0.1, 0.0, 0.49]) if name in ("shin.L", "thigh.L") else place
    )
    with pytest.raises(InputError, match=r"thigh.L .* shin.L .* same place"):
        solved(character, character_map, steps())


@pytest.mark.parametrize("frames", [1, 2, 3])
def test_short_motions(frames: int) -> None:
    body, posture = stepping()
    character, character_map = SHAPES["T"]()
    for options in (RetargetOptions(), RetargetOptions(root_motion=RootMotion.IN_PLACE)):
        motion = solved(character, character_map, performance(body, posture[:frames]), options)
        assert all(np.isfinite(pose).all() for pose in motion.poses.values())


def test_uneven_frames() -> None:
    body, posture = stepping()
    rng = np.random.default_rng(7)
    kept = np.sort(rng.choice(posture.batch[0], 90, replace=False))
    time_s = kept / 30.0
    few = posture[kept]
    source = segment_motion(body, few, time_s, natural_extremities(body, few, time_s))
    character = plain_character()
    character_map = plain_map(character)
    assert_stands(character, character_map, solved(character, character_map, source), source)


def test_a_map_with_its_sides_mistaken_is_named() -> None:
    character = plain_character()
    known = plain_map(character)
    other = {"L": "R", "R": "L"}
    roles = {
        f"{role[:-1]}{other[role[-1]]}" if role[-2:] in (".L", ".R") else role: bones
        for role, bones in known.roles.items()
    }
    assert solved(character, known, steps()).notes == ()
    (note,) = solved(character, replace(known, roles=roles), steps()).notes
    assert "left and right may be mistaken for each other" in note
