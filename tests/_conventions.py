"""Names of bones in published conventions, by the parts of `_characters.plain_character`."""

from _characters import SIDED

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
