"""Names of bones as words: sides, parts, and what plays no role."""

import pytest
from _recorded import assert_recorded
from keymark.core.retarget.recognition.names import CLEAR, LIMB_WORDS, TRUNK_WORDS, read_name


@pytest.mark.parametrize(
    ("name", "side", "part"),
    [
        ("mixamorig:LeftUpLeg", "L", "thigh"),
        ("mixamorig:RightForeArm", "R", "forearm"),
        ("DEF-upper_arm.L.001", "L", "upper_arm"),
        ("CC_Base_L_Clavicle", "L", "shoulder"),
        ("CC_Base_NeckTwist01", None, "neck"),
        ("Bip01 R Calf", "R", "shin"),
        ("ValveBiped.Bip01_L_UpperArm", "L", "upper_arm"),
        ("lShldrBend", "L", "upper_arm"),
        ("lforearm", "L", "forearm"),
        ("leftupleg", "L", "thigh"),
        ("UpperLegR", "R", "thigh"),
        ("mElbowLeft", "L", "forearm"),
        ("LowerTorso", None, "hips"),
        ("左足首", "L", "foot"),
        ("右ひじ", "R", "forearm"),
        ("上半身2", None, "spine"),
        ("ball_l", "L", "toe"),
    ],
)
def test_side_and_part_are_read(name: str, side: str | None, part: str) -> None:
    reading = read_name(name)
    assert reading.side == side and reading.clear_part == part
    assert not reading.mechanism


@pytest.mark.parametrize(
    "name",
    [
        *("lowerarm_twist_01_l", "LeftHandIndex1", "HeadTop_End", "foot_ik.L", "左足IK", "左腕捩", "eye.R"),
        *("MCH-spine.002", "thigh_ik_target.L", "breast.L", "skirt_01", "weapon_r", "左親指１"),
    ],
)
def test_controls_fingers_and_cloth_speak_for_no_part(name: str) -> None:
    assert read_name(name).clear_part is None


def test_a_side_makes_a_hip_a_thigh() -> None:
    assert read_name("hip").scores["hips"] >= CLEAR
    assert read_name("LeftHip").clear_part == "thigh"
    assert read_name("pelvis.L").clear_part is None
    for kind, words in (("trunk", TRUNK_WORDS), ("limbs", LIMB_WORDS)):
        scores = [list(read_name(" ".join(each)).scores.values()) for each in sorted(words)]
        assert_recorded(f"scores of {kind}", *scores)


@pytest.mark.parametrize("name", ["bone_012", "Bone.003", "x", "", "кость", "_", "lip" * 60, "l" * 5000])
def test_names_that_say_nothing_say_nothing(name: str) -> None:
    assert read_name(name).clear_part is None


@pytest.mark.parametrize(
    ("left", "right"),
    [
        ("LeftArm", "RightArm"),
        ("arm_l", "arm_r"),
        ("L_Arm.001", "R_Arm.001"),
        ("左腕", "右腕"),
        ("lArm", "rArm"),
    ],
)
def test_a_pairs_names_are_equal_without_their_sides(left: str, right: str) -> None:
    assert read_name(left).unsided == read_name(right).unsided
    assert read_name(left).side == "L" and read_name(right).side == "R"
