"""Words in bones' names, and the parts of the body they speak for.

A score is a log-likelihood: how much likelier the part is, given the word, than without it.
"""

from collections.abc import Mapping

SIDE_WORDS: Mapping[str, str] = {
    **dict.fromkeys(("l", "left", "lft", "lf", "lt", "左", "gauche", "links", "izq", "sinistra", "sx"), "L"),
    **dict.fromkeys(("r", "right", "rgt", "rt", "右", "droite", "rechts", "der", "destra", "dx"), "R"),
}

Entries = Mapping[tuple[str, ...], Mapping[str, float]]
"""By words that stand together the scores of parts."""


def _entries(alone: Mapping[str, Mapping[float, str]], shared: Mapping[str, Mapping[str, float]]) -> Entries:
    """Entries of words that speak for one part, by part and score, and of those that speak for several."""
    found = {
        tuple(words.split("+")): {part: score}
        for part, scores in alone.items()
        for score, listed in scores.items()
        for words in listed.split()
    }
    return found | {tuple(words.split("+")): scores for words, scores in shared.items()}


TRUNK_WORDS = _entries(
    {
        "hips": {
            3.0: "hips 骨盤",
            2.8: "pelvis",
            2.5: "lower+body lower+torso",
            2.0: "hip 下半身",
            1.5: "腰",
            1.0: "センター cog",
            0.5: "root",
        },
        "spine": {
            3.0: "upper+torso chest upper+chest upper+body lower+back abdomen thorax lumbar 上半身",
            2.5: "ribcage rib+cage",
            2.0: "back stomach ribs 胸",
            1.0: "belly",
        },
        "neck": {3.0: "首", 2.5: "cervical"},
        "head": {3.0: "head 頭 头", 2.5: "skull cranium"},
    },
    {
        "torso": {"spine": 1.5, "hips": 0.5},
        "trunk": {"spine": 1.5, "hips": 0.0},
        "body": {"spine": 0.5, "hips": 0.5},
        "spine": {"spine": 2.5, "hips": 1.5, "neck": 1.5, "head": 0.5},
        "waist": {"spine": 2.0, "hips": 0.0},
        "neck": {"neck": 3.0, "head": 0.0},
    },
)
"""Parts of the trunk by words that stand together; other parts of the trunk are then unlikely."""

LIMB_WORDS = _entries(
    {
        "shoulder": {3.0: "clavicle clav collar collar+bone 肩", 1.5: "scapula girdle"},
        "upper_arm": {3.0: "upper+arm up+arm humerus 腕 上腕", 1.5: "bicep"},
        "forearm": {3.0: "fore+arm lower+arm low+arm ひじ 肘 前腕", 2.5: "elbow", 2.0: "radius", 1.5: "ulna"},
        "hand": {3.0: "wrist 手首", 2.8: "hand", 2.5: "手", 1.0: "palm"},
        "thigh": {3.0: "thigh upper+leg up+leg femur 太もも", 2.0: "hip"},
        "shin": {3.0: "shin calf lower+leg low+leg tibia ひざ 膝 すね", 2.5: "knee"},
        "foot": {3.0: "足首", 2.8: "ankle", 2.0: "feet"},
        "toe": {3.0: "toes toe+base つま先", 2.8: "toe", 2.5: "ball", 2.0: "足先"},
    },
    {
        "shoulder": {"shoulder": 2.0, "upper_arm": 1.2},
        "shldr": {"upper_arm": 2.5, "shoulder": 0.5},
        "arm": {"upper_arm": 2.0, "forearm": 0.5, "shoulder": -0.5, "hand": -0.5},
        "leg": {"thigh": 1.2, "shin": 1.2, "foot": -0.5, "toe": -0.5},
        "足": {"thigh": 2.0, "foot": 0.0},
        "foot": {"foot": 2.5, "toe": 0.8},
    },
)
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
