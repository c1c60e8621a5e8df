"""Names of bones in published conventions, by the parts of `_characters.plain_character`."""

from _characters import SIDED

TRUNK = ("hips", "spine", "chest", "neck", "head")
LIMBS = ("shoulder", "upper_arm", "forearm", "hand", "thigh", "shin", "foot", "toe")

_MIXAMO = "*Shoulder *Arm *ForeArm *Hand *UpLeg *Leg *Foot *ToeBase"
_UNREAL = "clavicle_* upperarm_* lowerarm_* hand_* thigh_* calf_* foot_* ball_*"
_SMPL = "*_Collar *_Shoulder *_Elbow *_Wrist *_Hip *_Knee *_Ankle *_Foot"
_ARP = "shoulder.* arm_stretch.* forearm_stretch.* hand.* thigh_stretch.* leg_stretch.* foot.* toes_01.*"
_VRM = "*Shoulder *UpperArm *LowerArm *Hand *UpperLeg *LowerLeg *Foot *Toes"
_VROID = "*_Shoulder *_UpperArm *_LowerArm *_Hand *_UpperLeg *_LowerLeg *_Foot *_ToeBase"
_DAZ_9 = "*_shoulder *_upperarm *_forearm *_hand *_thigh *_shin *_foot *_toes"
_DAZ_8 = "*Collar *ShldrBend *ForearmBend *Hand *ThighBend *Shin *Foot *Toe"
_CC = "*_Clavicle *_Upperarm *_Forearm *_Hand *_Thigh *_Calf *_Foot *_ToeBase"
_RIGIFY = "shoulder.* upper_arm.* forearm.* hand.* thigh.* shin.* foot.* toe.*"
_MAKEHUMAN = "clavicle.* upperarm01.* lowerarm01.* wrist.* upperleg01.* lowerleg01.* foot.* toe1-1.*"
_BIPED = "* Clavicle|* UpperArm|* Forearm|* Hand|* Thigh|* Calf|* Foot|* Toe0"
_OLDER_CMU = "*Collar *Shoulder *Elbow *Wrist *Hip *Knee *Ankle *Toe"
_XSENS = "*Shoulder *UpperArm *Forearm *Hand *Thigh *Shin *Foot *Toe"
_ROKOKO = "*Shoulder *Arm *Forearm *Hand *Thigh *Shin *Foot *Toe"

# Convention: identifier of its preset, prefix, words of the sides, names of the trunk, names of limbs.
_TABLE: dict[str, tuple[str | None, str, tuple[str, str], str, str]] = {
    "Mixamo": ("mixamo", "mixamorig:", ("Left", "Right"), "Hips Spine Spine1 Neck Head", _MIXAMO),
    "Mixamo, second character": (
        "mixamo",
        "mixamorig7:",
        ("Left", "Right"),
        "Hips Spine Spine1 Neck Head",
        _MIXAMO,
    ),
    "Ready Player Me": ("mixamo", "", ("Left", "Right"), "Hips Spine Spine1 Neck Head", _MIXAMO),
    "HumanIK": ("mixamo", "Character1_", ("Left", "Right"), "Hips Spine Spine1 Neck Head", _MIXAMO),
    "Rigify metarig": (
        "rigify_metarig",
        "",
        ("L", "R"),
        "spine spine.001 spine.002 spine.004 spine.006",
        _RIGIFY,
    ),
    "Rigify for games": (
        "rigify_metarig",
        "DEF-",
        ("L", "R"),
        "spine spine.001 spine.002 spine.004 spine.006",
        _RIGIFY,
    ),
    "Unreal": ("unreal", "", ("l", "r"), "pelvis spine_01 spine_02 neck_01 head", _UNREAL),
    "Auto-Rig Pro": (
        "auto_rig_pro_deform",
        "",
        ("l", "r"),
        "root.x spine_01.x spine_02.x neck.x head.x",
        _ARP,
    ),
    "VRM": ("vrm", "", ("left", "right"), "hips spine chest neck head", _VRM),
    "VRoid": ("vroid", "J_Bip_", ("L", "R"), "C_Hips C_Spine C_Chest C_Neck C_Head", _VROID),
    "MakeHuman": ("makehuman", "", ("L", "R"), "root spine05 spine04 neck01 head", _MAKEHUMAN),
    "CMU": ("cmu_motionbuilder", "", ("Left", "Right"), "Hips LowerBack Spine Neck Head", _MIXAMO),
    "CMU, older": ("cmu_older", "", ("Left", "Right"), "Hips Chest Chest2 Neck Head", _OLDER_CMU),
    "Daz Genesis 8": ("daz_genesis_8", "", ("l", "r"), "hip abdomenLower chestLower neckLower head", _DAZ_8),
    "Daz Genesis 9": ("daz_genesis_9", "", ("l", "r"), "hip spine1 spine2 neck1 head", _DAZ_9),
    "Character Creator": (
        "character_creator",
        "CC_Base_",
        ("L", "R"),
        "Hip Waist Spine01 NeckTwist01 Head",
        _CC,
    ),
    "SMPL": ("smpl", "", ("L", "R"), "Pelvis Spine1 Spine2 Neck Head", _SMPL),
    "SMPL-X": ("smpl_x", "", ("left", "right"), "pelvis spine1 spine2 neck head", _SMPL.lower()),
    "Biped": ("biped", "Bip01 ", ("L", "R"), "Pelvis Spine Spine1 Neck Head", _BIPED),
    "Xsens": ("xsens", "", ("Left", "Right"), "Hips Chest Chest2 Neck Head", _XSENS),
    "Rokoko": ("rokoko", "", ("Left", "Right"), "Hips Spine1 Spine2 Neck Head", _ROKOKO),
    "MikuMikuDance": (
        "mmd",
        "",
        ("左", "右"),
        "下半身 上半身 上半身2 首 頭",
        "*肩 *腕 *ひじ *手首 *足 *ひざ *足首 *つま先",
    ),
    "of a robot": (
        None,
        "",
        ("L", "R"),
        "Hips Abdomen Torso Neck Head",
        "Shoulder* UpperArm* LowerArm* Palm1* UpperLeg* LowerLeg* Foot* Toes*",
    ),
    "numbered": (
        None,
        "Skeleton_",
        ("L", "R"),
        "torso_joint_1 torso_joint_2 torso_joint_3 neck_joint_1 neck_joint_2",
        "shoulder_joint_*_1 arm_joint_*_1 arm_joint_*_2 arm_joint_*_3 "
        "leg_joint_*_1 leg_joint_*_2 leg_joint_*_3 leg_joint_*_5",
    ),
    "of bones": (
        None,
        "",
        ("l", "r"),
        "pelvis lumbar thorax cervical skull",
        "clavicle_* humerus_* radius_* wrist_* femur_* tibia_* ankle_* toes_*",
    ),
}


def convention_names(convention: str) -> dict[str, str]:
    """Names by `hips`, `upper_arm.L` and so on."""
    _, prefix, sides, trunk, limbs = _TABLE[convention]
    patterns = limbs.split("|") if "|" in limbs else limbs.split()
    found = {part: prefix + name for part, name in zip(TRUNK, trunk.split(), strict=True)}
    for part, pattern in zip(LIMBS, patterns, strict=True):
        assert part in SIDED
        for side, word in zip("LR", sides, strict=True):
            found[f"{part}.{side}"] = prefix + pattern.replace("*", word)
    for side, word in zip("LR", sides, strict=True):
        found[f"finger.{side}"] = f"{prefix}{word} thing"
    return found


CONVENTIONS = tuple(_TABLE)
PRESET_OF = {convention: row[0] for convention, row in _TABLE.items()}
