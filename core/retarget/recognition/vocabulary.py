"""Words in bones' names, and the parts of the body they speak for.

A score is a log-likelihood: how much likelier the part is, given the word, than without it.
"""

from collections.abc import Mapping

SIDE_WORDS: Mapping[str, str] = {
    **dict.fromkeys(("l", "left", "lft", "lf", "lt", "左", "gauche", "links", "izq", "sinistra", "sx"), "L"),
    **dict.fromkeys(("r", "right", "rgt", "rt", "右", "droite", "rechts", "der", "destra", "dx"), "R"),
}

TRUNK_WORDS: Mapping[tuple[str, ...], Mapping[str, float]] = {
    ("hips",): {"hips": 3.0},
    ("hip",): {"hips": 2.0},
    ("pelvis",): {"hips": 2.8},
    ("lower", "body"): {"hips": 2.5},
    ("lower", "torso"): {"hips": 2.5},
    ("upper", "torso"): {"spine": 3.0},
    ("下半身",): {"hips": 2.0},
    ("腰",): {"hips": 1.5},
    ("センター",): {"hips": 1.0},
    ("cog",): {"hips": 1.0},
    ("骨盤",): {"hips": 3.0},
    ("root",): {"hips": 0.5},
    ("torso",): {"spine": 1.5, "hips": 0.5},
    ("trunk",): {"spine": 1.5, "hips": 0.0},
    ("body",): {"spine": 0.5, "hips": 0.5},
    ("spine",): {"spine": 2.5, "hips": 1.5, "neck": 1.5, "head": 0.5},
    ("chest",): {"spine": 3.0},
    ("upper", "chest"): {"spine": 3.0},
    ("upper", "body"): {"spine": 3.0},
    ("lower", "back"): {"spine": 3.0},
    ("back",): {"spine": 2.0},
    ("waist",): {"spine": 2.0, "hips": 0.0},
    ("abdomen",): {"spine": 3.0},
    ("stomach",): {"spine": 2.0},
    ("belly",): {"spine": 1.0},
    ("thorax",): {"spine": 3.0},
    ("lumbar",): {"spine": 3.0},
    ("ribcage",): {"spine": 2.5},
    ("ribs",): {"spine": 2.0},
    ("rib", "cage"): {"spine": 2.5},
    ("上半身",): {"spine": 3.0},
    ("胸",): {"spine": 2.0},
    ("neck",): {"neck": 3.0, "head": 0.0},
    ("cervical",): {"neck": 2.5},
    ("首",): {"neck": 3.0},
    ("head",): {"head": 3.0},
    ("skull",): {"head": 2.5},
    ("cranium",): {"head": 2.5},
    ("頭",): {"head": 3.0},
    ("头",): {"head": 3.0},
}
"""Parts of the trunk by words that stand together; other parts of the trunk are then unlikely."""

LIMB_WORDS: Mapping[tuple[str, ...], Mapping[str, float]] = {
    ("clavicle",): {"shoulder": 3.0},
    ("clav",): {"shoulder": 3.0},
    ("collar",): {"shoulder": 3.0},
    ("collar", "bone"): {"shoulder": 3.0},
    ("scapula",): {"shoulder": 1.5},
    ("girdle",): {"shoulder": 1.5},
    ("shoulder",): {"shoulder": 2.0, "upper_arm": 1.2},
    ("肩",): {"shoulder": 3.0},
    ("shldr",): {"upper_arm": 2.5, "shoulder": 0.5},
    ("upper", "arm"): {"upper_arm": 3.0},
    ("up", "arm"): {"upper_arm": 3.0},
    ("humerus",): {"upper_arm": 3.0},
    ("bicep",): {"upper_arm": 1.5},
    ("arm",): {"upper_arm": 2.0, "forearm": 0.5, "shoulder": -0.5, "hand": -0.5},
    ("腕",): {"upper_arm": 3.0},
    ("上腕",): {"upper_arm": 3.0},
    ("fore", "arm"): {"forearm": 3.0},
    ("lower", "arm"): {"forearm": 3.0},
    ("low", "arm"): {"forearm": 3.0},
    ("elbow",): {"forearm": 2.5},
    ("radius",): {"forearm": 2.0},
    ("ulna",): {"forearm": 1.5},
    ("ひじ",): {"forearm": 3.0},
    ("肘",): {"forearm": 3.0},
    ("前腕",): {"forearm": 3.0},
    ("hand",): {"hand": 2.8},
    ("wrist",): {"hand": 3.0},
    ("palm",): {"hand": 1.0},
    ("手首",): {"hand": 3.0},
    ("手",): {"hand": 2.5},
    ("thigh",): {"thigh": 3.0},
    ("upper", "leg"): {"thigh": 3.0},
    ("up", "leg"): {"thigh": 3.0},
    ("femur",): {"thigh": 3.0},
    ("hip",): {"thigh": 2.0},
    ("leg",): {"thigh": 1.2, "shin": 1.2, "foot": -0.5, "toe": -0.5},
    ("足",): {"thigh": 2.0, "foot": 0.0},
    ("太もも",): {"thigh": 3.0},
    ("shin",): {"shin": 3.0},
    ("calf",): {"shin": 3.0},
    ("lower", "leg"): {"shin": 3.0},
    ("low", "leg"): {"shin": 3.0},
    ("knee",): {"shin": 2.5},
    ("tibia",): {"shin": 3.0},
    ("ひざ",): {"shin": 3.0},
    ("膝",): {"shin": 3.0},
    ("すね",): {"shin": 3.0},
    ("foot",): {"foot": 2.5, "toe": 0.8},
    ("feet",): {"foot": 2.0},
    ("ankle",): {"foot": 2.8},
    ("足首",): {"foot": 3.0},
    ("toe",): {"toe": 2.8},
    ("toes",): {"toe": 3.0},
    ("toe", "base"): {"toe": 3.0},
    ("ball",): {"toe": 2.5},
    ("つま先",): {"toe": 3.0},
    ("足先",): {"toe": 2.0},
}
"""Parts of a limb by words that stand together; other parts of limbs are then unlikely."""

MECHANISM_WORDS = frozenset(
    """ik fk pole target ctrl ctl control controller mch helper tweak handle driver driven constraint aim
    space switch pivot null locator dummy vis wgt goal spin rock parent offset hinge swing stretchto
    cancel キャンセル 親 物理""".split()
)
"""Words of bones that steer others and move no flesh."""

OTHER_WORDS = frozenset(
    """end nub tip site eff effector socket attach slot grip holster prop weapon sword gun shield blade bow
    finger thumb index middle ring pinky pinkie little mid metacarpal carpal meta knuckle nail
    親指 人指 人差指 中指 薬指 小指 指 先
    breast bust boob pectoral pec nipple 胸筋 乳
    eye eyes jaw teeth tooth tongue lip lips mouth ear ears brow eyebrow lid eyelid cheek nose nostril chin
    temple forehead face facial lash iris pupil snout muzzle beak horn antler 目 眼 舌 あご
    hair ponytail braid bang bangs beard mustache 髪 前髪 skirt スカート cloth dress cape cloak coat sleeve
    袖 scarf tie ribbon リボン robe hood hat cap helmet belt strap pouch bag pack backpack armor pad
    tail wing wings feather fin mane muscle corrective butt buttock glute heel twist roll 捩 捩れ adjust bulge
    camera light mesh geo bendy""".split()
)
"""Words of fingers, faces, clothes, things held, corrections and ends of chains."""

LIMB_HELPERS = frozenset({"twist", "roll"})
"""Of `OTHER_WORDS` those that in a trunk are mere description, as in NeckTwist01."""

FILLER_WORDS = frozenset(
    """bone jnt joint def org bip bip001 cc base mixamorig j b c x sk bn bind skin deform skeleton armature
    rig character valve biped human man male female char bend stretch m f start main
    """.split()
)
"""Words that say nothing of the part."""
