"""Characters for tests: skeletons of many shapes and conventions, and their maps."""

import json
from collections.abc import Mapping
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from keymark.core.arrays import Array
from keymark.core.retarget.character import Character, CharacterBone
from keymark.core.retarget.maps.character_map import CharacterMap, IkControls, RoleBones, Setting, Switch
from keymark.core.retarget.retarget_record import RECOGNIZED, RetargetRecord, UsedCharacter, UsedMap
from keymark.core.take.conversion_settings import RetargetOptions

SHARED = Path(__file__).resolve().parents[2] / "shared" / "characters"

JOINTS = {
    "hips": (0.0, 0.0, 0.95),
    "spine": (0.0, 0.01, 1.05),
    "chest": (0.0, 0.015, 1.22),
    "neck": (0.0, 0.02, 1.45),
    "head": (0.0, 0.0, 1.54),
    "shoulder": (0.03, 0.01, 1.40),
    "upper_arm": (0.17, 0.02, 1.38),
    "forearm": (0.44, 0.03, 1.38),
    "hand": (0.68, 0.02, 1.38),
    "finger": (0.78, 0.01, 1.37),
    "thigh": (0.09, 0.0, 0.90),
    "shin": (0.095, -0.01, 0.49),
    "foot": (0.1, 0.02, 0.08),
    "toe": (0.105, -0.11, 0.02),
    "top": (0.0, -0.01, 1.72),
    "fingertip": (0.86, 0.005, 1.36),
    "toetip": (0.106, -0.19, 0.015),
}
"""Joints of a body of 1.72 m in a T pose [m], left side, facing -Y."""
CHAINS = (
    (None, "hips spine chest neck head top"),
    ("chest", "shoulder upper_arm forearm hand finger fingertip"),
    ("hips", "thigh shin foot toe toetip"),
)
"""What each chain of bones hangs on, and its joints; the last is an end."""
TAILS = {part: end for _, chain in CHAINS for part, end in pairwise(chain.split())}
PARENTS = {
    part: above
    for on, chain in CHAINS
    for above, part in pairwise((on, *chain.split()[:-1]))
    if part is not None
}
SIDED = ("shoulder", "upper_arm", "forearm", "hand", "finger", "thigh", "shin", "foot", "toe")


def plain_character(
    *,
    names: Mapping[str, str] | None = None,
    without: tuple[str, ...] = (),
    arms_down_deg: float = 0.0,
    scale: float = 1.0,
    turn: Array | None = None,
    root: str | None = None,
    roll_rad: float = 0.0,
) -> Character:
    """A deform skeleton.

    Args:
        names: Bone names by `hips`, `upper_arm.L` ...; by default those keys themselves.
        without: Parts that it lacks, such as `shoulder`, `toe`, `chest`; children hang on the next above.
        arms_down_deg: 0 for a T pose, about 45 for an A pose.
        scale: Size of the object; bones are larger by its inverse, so that the body keeps its meters.
        turn: (3, 3) turns all bones in the armature's space.
        root: Name of a bone on the ground that carries the hips.
        roll_rad: Turns every bone about its own length.
    """
    turning = np.eye(3) if turn is None else turn
    bones: list[CharacterBone] = []
    index: dict[str, int] = {}
    if root is not None:
        bones.append(
            CharacterBone(root, -1, _matrix(np.zeros(3), turning @ [0, 0.3, 0], 0.0), turning @ [0, 0.3, 0])
        )
        index[root] = 0
    for key in _keys(without):
        part, _, side = key.partition(".")
        head, tail = (_place(name, side, arms_down_deg) / scale for name in (part, _end(part, without)))
        head, tail = turning @ head, turning @ tail
        above = PARENTS[part]
        while above in without:
            above = PARENTS[str(above)]
        own = f"{above}.{side}" if above in SIDED else above
        parent = index.get(str(own), 0 if root is not None else -1)
        index[key] = len(bones)
        bones.append(CharacterBone((names or {}).get(key, key), parent, _matrix(head, tail, roll_rad), tail))
    return Character("Character", tuple(bones), scale)


def plain_map(character: Character) -> CharacterMap:
    """The map of a `plain_character` with its default names."""
    there = set(character.index)
    roles = {
        role: RoleBones((role,))
        for role in (*_keys(()),)
        if role in there and role not in ("spine", "chest") and not role.startswith("finger")
    }
    spine = tuple(name for name in ("spine", "chest") if name in there)
    if spine:
        roles["spine"] = RoleBones(spine)
    return CharacterMap("Plain", roles)


def shared_characters() -> dict[str, Character]:
    """The skeletons beside the project by name; none where there are no such files."""
    return {
        file.name.split(".")[1]: shared_character(file) for file in sorted(SHARED.glob("mpfb2/rig.*.json"))
    }


def shared_character(file: Path) -> Character:
    """A skeleton of MPFB's format, in meters; bones without length, which Blender drops, are left out."""
    value = json.loads(file.read_text(encoding="utf-8"))
    listed: dict[str, Any] = value.get("bones", value)
    given = {name: bone for name, bone in listed.items() if _length(bone) > 1e-6}
    for bone in given.values():
        while bone.get("parent") and bone["parent"] not in given:
            bone["parent"] = listed[bone["parent"]].get("parent")
    order: list[str] = []
    while len(order) < len(given):
        ready = [
            n for n in given if n not in order and (not given[n].get("parent") or given[n]["parent"] in order)
        ]
        order += ready
    index = {name: number for number, name in enumerate(order)}
    bones = []
    for name in order:
        bone = given[name]
        head, tail = (np.array(bone[end]["default_position"], dtype=np.float64) for end in ("head", "tail"))
        rest = _matrix(head, tail, float(bone.get("roll", 0.0)))
        above = bone.get("parent")
        bones.append(
            CharacterBone(
                name,
                index[above] if above else -1,
                rest,
                tail,
                connected=bool(bone.get("use_connect", False)),
            )
        )
    return Character(file.name.split(".")[1], tuple(bones))


def _length(bone: dict[str, Any]) -> float:
    head, tail = (np.array(bone[end]["default_position"]) for end in ("head", "tail"))
    return float(np.linalg.norm(tail - head))


def renamed(character: Character) -> Character:
    """The character with bones called `bone_000` and so on."""
    bones = tuple(replace(bone, name=f"bone_{n:03}") for n, bone in enumerate(character.bones))
    return Character(character.name, bones, character.scale)


def _keys(without: tuple[str, ...]) -> tuple[str, ...]:
    found = []
    for part in PARENTS:
        if part in without:
            continue
        found += [f"{part}.{side}" for side in "LR"] if part in SIDED else [part]
    return tuple(found)


def _end(part: str, without: tuple[str, ...]) -> str:
    end = TAILS[part]
    while end in without and end in TAILS:
        end = TAILS[end]
    return end


def _place(part: str, side: str, arms_down_deg: float) -> Array:
    place = np.array(JOINTS[part])
    if part in ("forearm", "hand", "finger", "fingertip"):
        pivot, angle = np.array(JOINTS["upper_arm"]), np.radians(arms_down_deg)
        x, z = place[0] - pivot[0], place[2] - pivot[2]
        place[0] = pivot[0] + np.cos(angle) * x + np.sin(angle) * z
        place[2] = pivot[2] - np.sin(angle) * x + np.cos(angle) * z
    return place * [-1.0, 1.0, 1.0] if side == "R" else place


def _matrix(head: Array, tail: Array, roll_rad: float) -> Array:
    """(4, 4) a bone's rest matrix as Blender makes it from head, tail and roll."""
    along = np.asarray(tail - head) / np.linalg.norm(tail - head)
    x, y, z = along
    if y > -1.0 + 1e-9:
        theta = 1.0 + y
        turn = np.array(
            [[1.0 - x * x / theta, x, -x * z / theta], [-x, y, -z], [-x * z / theta, z, 1.0 - z * z / theta]]
        )
    else:
        turn = np.diag([-1.0, -1.0, 1.0])
    cos, sin = np.cos(roll_rad), np.sin(roll_rad)
    matrix = np.eye(4)
    matrix[:3, :3] = turn @ np.array([[cos, 0.0, sin], [0.0, 1.0, 0.0], [-sin, 0.0, cos]])
    matrix[:3, 3] = head
    return matrix


# --- A character map and a record of retargeting with every field


def full_map() -> CharacterMap:
    """A map of a plain character with controls, settings, soles and whatever else a map may hold."""
    plain = plain_map(plain_character(root="root"))
    roles = dict(plain.roles)
    roles["spine"] = RoleBones(("spine", "chest"), 0.8, "names", (0.25, 1.0))
    roles["toe.L"] = RoleBones(("toe.L",), 0.4, "shape")
    return replace(
        plain,
        title="Anna, größer",
        roles=roles,
        fk={"hips": ("torso",), "spine": (None, "chest control")},
        ik={
            "arm.L": IkControls("hand_ik.L", "elbow.L", None, Switch("hand_ik.L", 'IK "FK"', 0.0, 1.0)),
            "leg.R": IkControls("foot_ik.R", toe="toe_ik.R"),
        },
        settings=(
            Setting("torso", "neck_follow", 1.0),
            Setting("torso", "torso_parent", 2),
            Setting("hand_ik.L", "pole_vector", True),
        ),
        root="root",
        soles={"foot.L": ((0.1, 0.02, 0.0), (0.1, -0.1, 0.0)), "toe.L": ((0.105, -0.19, 0.0),)},
        rest_corrections={"upper_arm.L": (0.8, 0.0, 0.6, 0.0)},
        left_alone=("neck", "head"),
        preset="rigify",
        author="A. Person",
        license="CC0-1.0",
        description="For tests.",
        tags=("cartoon",),
    )


def full_record() -> RetargetRecord:
    """A record with every field."""
    return RetargetRecord(
        keymark="1.0.0",
        take="walk",
        character=UsedCharacter("anna.blend", "rig", "ef" * 32),
        map=UsedMap("Anna", RECOGNIZED, "rigify"),
        action="walk on rig",
        frames=8,
        frame_start=1,
        fps=30.0,
        size=0.987,
        options=RetargetOptions(root_motion="in-place", tolerance_mm=2.5),
        roles=full_map().roles,
        limbs={"arm.L": "fk", "leg.L": "both"},
        quality={"skate_mm_per_frame": 0.012, "hands_mm": None},
        doubts=("toe.L may be another bone",),
        notes=("A note.",),
        files={"character.blend": "ab" * 32},
    )


# --- Names of bones in published conventions, by the parts of `_characters.plain_character`


TRUNK = ("hips", "spine", "chest", "neck", "head")
PARTS = ("shoulder", "upper_arm", "forearm", "hand", "thigh", "shin", "foot", "toe")
_LIMBS = {
    "mixamo": "*Shoulder *Arm *ForeArm *Hand *UpLeg *Leg *Foot *ToeBase",
    "rigify": "shoulder.* upper_arm.* forearm.* hand.* thigh.* shin.* foot.* toe.*",
    "unreal": "clavicle_* upperarm_* lowerarm_* hand_* thigh_* calf_* foot_* ball_*",
    "arp": (
        "shoulder.* arm_stretch.* forearm_stretch.* hand.* thigh_stretch.* leg_stretch.* foot.* toes_01.*"
    ),
    "vrm": "*Shoulder *UpperArm *LowerArm *Hand *UpperLeg *LowerLeg *Foot *Toes",
    "vroid": "*_Shoulder *_UpperArm *_LowerArm *_Hand *_UpperLeg *_LowerLeg *_Foot *_ToeBase",
    "makehuman": "clavicle.* upperarm01.* lowerarm01.* wrist.* upperleg01.* lowerleg01.* foot.* toe1-1.*",
    "older_cmu": "*Collar *Shoulder *Elbow *Wrist *Hip *Knee *Ankle *Toe",
    "daz_8": "*Collar *ShldrBend *ForearmBend *Hand *ThighBend *Shin *Foot *Toe",
    "daz_9": "*_shoulder *_upperarm *_forearm *_hand *_thigh *_shin *_foot *_toes",
    "cc": "*_Clavicle *_Upperarm *_Forearm *_Hand *_Thigh *_Calf *_Foot *_ToeBase",
    "smpl": "*_Collar *_Shoulder *_Elbow *_Wrist *_Hip *_Knee *_Ankle *_Foot",
    "smpl_x": "*_collar *_shoulder *_elbow *_wrist *_hip *_knee *_ankle *_foot",
    "biped": "* Clavicle|* UpperArm|* Forearm|* Hand|* Thigh|* Calf|* Foot|* Toe0",
    "xsens": "*Shoulder *UpperArm *Forearm *Hand *Thigh *Shin *Foot *Toe",
    "rokoko": "*Shoulder *Arm *Forearm *Hand *Thigh *Shin *Foot *Toe",
    "mmd": "*肩 *腕 *ひじ *手首 *足 *ひざ *足首 *つま先",
    "robot": "Shoulder* UpperArm* LowerArm* Palm1* UpperLeg* LowerLeg* Foot* Toes*",
    "joints": (
        "shoulder_joint_*_1 arm_joint_*_1 arm_joint_*_2 arm_joint_*_3 leg_joint_*_1 "
        "leg_joint_*_2 leg_joint_*_3 leg_joint_*_5"
    ),
    "bones": "clavicle_* humerus_* radius_* wrist_* femur_* tibia_* ankle_* toes_*",
}
# Convention, preset (- for none), prefix (~ is a space), words of the sides, names of the trunk, limbs.
_TABLE = """
Mixamo | mixamo | mixamorig: | Left Right | Hips Spine Spine1 Neck Head | mixamo
Mixamo, second character | mixamo | mixamorig7: | Left Right | Hips Spine Spine1 Neck Head | mixamo
Ready Player Me | mixamo | | Left Right | Hips Spine Spine1 Neck Head | mixamo
HumanIK | mixamo | Character1_ | Left Right | Hips Spine Spine1 Neck Head | mixamo
Rigify metarig | rigify_metarig | | L R | spine spine.001 spine.002 spine.004 spine.006 | rigify
Rigify for games | rigify_metarig | DEF- | L R | spine spine.001 spine.002 spine.004 spine.006 | rigify
Unreal | unreal | | l r | pelvis spine_01 spine_02 neck_01 head | unreal
Auto-Rig Pro | auto_rig_pro_deform | | l r | root.x spine_01.x spine_02.x neck.x head.x | arp
VRM | vrm | | left right | hips spine chest neck head | vrm
VRoid | vroid | J_Bip_ | L R | C_Hips C_Spine C_Chest C_Neck C_Head | vroid
MakeHuman | makehuman | | L R | root spine05 spine04 neck01 head | makehuman
CMU | cmu_motionbuilder | | Left Right | Hips LowerBack Spine Neck Head | mixamo
CMU, older | cmu_older | | Left Right | Hips Chest Chest2 Neck Head | older_cmu
Daz Genesis 8 | daz_genesis_8 | | l r | hip abdomenLower chestLower neckLower head | daz_8
Daz Genesis 9 | daz_genesis_9 | | l r | hip spine1 spine2 neck1 head | daz_9
Character Creator | character_creator | CC_Base_ | L R | Hip Waist Spine01 NeckTwist01 Head | cc
SMPL | smpl | | L R | Pelvis Spine1 Spine2 Neck Head | smpl
SMPL-X | smpl_x | | left right | pelvis spine1 spine2 neck head | smpl_x
Biped | biped | Bip01~ | L R | Pelvis Spine Spine1 Neck Head | biped
Xsens | xsens | | Left Right | Hips Chest Chest2 Neck Head | xsens
Rokoko | rokoko | | Left Right | Hips Spine1 Spine2 Neck Head | rokoko
MikuMikuDance | mmd | | 左 右 | 下半身 上半身 上半身2 首 頭 | mmd
of a robot | - | | L R | Hips Abdomen Torso Neck Head | robot
numbered | - | Skeleton_ | L R | torso_joint_1 torso_joint_2 torso_joint_3 neck_joint_1 neck_joint_2 | joints
of bones | - | | l r | pelvis lumbar thorax cervical skull | bones
"""
_ROWS = {
    row[0]: row[1:]
    for row in ([cell.strip() for cell in line.split("|")] for line in _TABLE.splitlines() if line)
}


def convention_names(convention: str) -> dict[str, str]:
    """Names by `hips`, `upper_arm.L` and so on."""
    _, prefix, words, trunk, limbs = _ROWS[convention]
    prefix, sides = prefix.replace("~", " "), words.split()
    patterns = _LIMBS[limbs].split("|") if "|" in _LIMBS[limbs] else _LIMBS[limbs].split()
    found = {part: prefix + name for part, name in zip(TRUNK, trunk.split(), strict=True)}
    for part, pattern in zip(PARTS, patterns, strict=True):
        assert part in SIDED
        for side, word in zip("LR", sides, strict=True):
            found[f"{part}.{side}"] = prefix + pattern.replace("*", word)
    for side, word in zip("LR", sides, strict=True):
        found[f"finger.{side}"] = f"{prefix}{word} thing"
    return found


CONVENTIONS = tuple(_ROWS)
PRESET_OF = {convention: None if row[0] == "-" else row[0] for convention, row in _ROWS.items()}
