"""Words in bones' names, and the parts of the body they speak for.

A score is a log-likelihood: how much likelier the part is, given the word, than without it.
"""

import re
import unicodedata
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache

from ..character import ARM, LEG, MIDDLE

SIDE_WORDS: Mapping[str, str] = {
    **dict.fromkeys(("l", "left", "lft", "lf", "lt", "左", "gauche", "links", "izq", "sinistra", "sx"), "L"),
    **dict.fromkeys(("r", "right", "rgt", "rt", "右", "droite", "rechts", "der", "destra", "dx"), "R"),
}

Entries = Mapping[tuple[str, ...], Mapping[str, float]]  # by words that stand together the scores of parts


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

FINGER_WORDS = {
    "thumb": {"thumb", "親指"},
    "index": {"index", "人指", "人差指"},
    "middle": {"middle", "mid", "中指"},
    "ring": {"ring", "薬指"},
    "pinky": {"pinky", "pinkie", "little", "小指"},
}
"""Of `OTHER_WORDS` those that tell fingers apart."""

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

LIMB_HELPERS = frozenset({"twist", "roll"})  # mere description in a trunk, as in NeckTwist01

FILLER_WORDS = frozenset(
    """bone jnt joint def org bip bip001 cc base mixamorig j b c x sk bn bind skin deform skeleton armature
    rig character valve biped human man male female char bend stretch m f start main
    """.split()
)
"""Words that say nothing of the part."""


OTHER_PART = -2.0  # score of a part where the name speaks for another
NO_PART = -4.0  # score of every part where the name speaks for something that plays no role
CLEAR = 1.0  # score from which a name speaks for a part
LONGEST_NAME = 120  # characters of a name that are read; Blender's own names hold 63 bytes

_NAMESPACE = re.compile(r"^.*[:|]")
_PIECES = re.compile(r"[A-Z]+(?![a-z])|[A-Z][a-z]+|[a-z]+|[^\W\d_]+", re.UNICODE)
_BORDERS = re.compile(r"(\W|_|\d+|[左右]|(?<=[a-z])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z]))")
_LATIN = re.compile(r"[a-z]+")
_VOCABULARY = frozenset(
    {word for words in (*TRUNK_WORDS, *LIMB_WORDS) for word in words}
    | set(SIDE_WORDS)
    | MECHANISM_WORDS
    | OTHER_WORDS
    | FILLER_WORDS
)
_LONGEST_WORD = max(len(word) for word in _VOCABULARY)


@dataclass(frozen=True)
class NameReading:
    """What a bone's name says."""

    words: tuple[str, ...]  # its words in lower case, without numbers and namespace
    side: str | None  # `L`, `R`, or None
    scores: Mapping[str, float]  # by part of `roles.MIDDLE`, `ARM` and `LEG`; 0 where the name says nothing
    mechanism: bool  # whether it names a control or helper
    other: bool  # whether it names something that plays no role: a finger, cloth, an end
    unsided: str  # the name with the side's word replaced, equal for a pair's two names

    @cached_property
    def clear_part(self) -> str | None:
        """The part that the name speaks for most; None where it speaks for none."""
        part = max(self.scores, key=lambda name: self.scores[name])
        return part if self.scores[part] >= CLEAR else None


@lru_cache(maxsize=4096)
def read_name(name: str) -> NameReading:
    """Read a bone's name."""
    text = _NAMESPACE.sub("", unicodedata.normalize("NFKC", name[:LONGEST_NAME])) or name[:LONGEST_NAME]
    words = tuple(word for piece in _PIECES.findall(text) for word in _taken_apart(piece.casefold()))
    borders = _BORDERS.split(name[:LONGEST_NAME])
    unsided = "".join("*" if part and part.casefold() in SIDE_WORDS else part for part in borders if part)
    sides = {SIDE_WORDS[word] for word in words if word in SIDE_WORDS}
    side = sides.pop() if len(sides) == 1 else None
    meaning = tuple(word for word in words if word not in SIDE_WORDS)
    mechanism = any(word in MECHANISM_WORDS for word in meaning)
    other = any(word in OTHER_WORDS for word in meaning)
    trunk = _part_scores(meaning, TRUNK_WORDS, MIDDLE)
    limb = _part_scores(meaning, LIMB_WORDS, (*ARM, *LEG))
    of_trunk, of_limb = any(trunk.values()), any(limb.values())
    if side is not None or (of_limb and not of_trunk):  # LeftHip is a thigh, pelvis.L no pelvis
        trunk = dict.fromkeys(MIDDLE, OTHER_PART)
    if of_trunk and not of_limb:
        limb = dict.fromkeys(limb, OTHER_PART)
    if mechanism or any(word in OTHER_WORDS - LIMB_HELPERS for word in meaning):
        trunk = dict.fromkeys(MIDDLE, NO_PART)
    if mechanism or other:
        limb = dict.fromkeys(limb, NO_PART)
    return NameReading(words, side, {**trunk, **limb}, mechanism, other, unsided)


def _taken_apart(piece: str) -> list[str]:
    """A piece as the fewest words of the vocabulary; itself where that does not work."""
    if piece in _VOCABULARY:
        return [piece]
    best: list[tuple[int, list[str]] | None] = [(0, [])]
    for end in range(1, len(piece) + 1):
        # A letter that is no word counts as three words.
        ways = [] if _LATIN.fullmatch(piece) or best[-1] is None else [(best[-1][0] + 3, best[-1][1])]
        for start in range(max(0, end - _LONGEST_WORD), end):
            before, word = best[start], piece[start:end]
            at_end = start == 0 or end == len(piece)  # only there single letters are words: those of sides
            if before is not None and word in _VOCABULARY:
                if len(word) > 1 or not word.isascii() or (word in SIDE_WORDS and at_end):
                    ways.append((before[0] + 1, [*before[1], word]))
        best.append(min(ways, key=lambda way: way[0], default=None))
    return best[-1][1] if best[-1] is not None and best[-1][1] else [piece]


def _part_scores(
    words: tuple[str, ...], table: Mapping[tuple[str, ...], Mapping[str, float]], parts: tuple[str, ...]
) -> dict[str, float]:
    """Scores of parts by the entries whose words are all there, longer entries before shorter."""
    there = set(words)
    best: dict[str, float] = {}
    longest = 0
    for entry, scores in table.items():
        if there.issuperset(entry) and len(entry) >= longest:
            if len(entry) > longest:
                best, longest = {}, len(entry)
            for part, score in scores.items():
                best[part] = max(score, best.get(part, score))
    if not best:
        return dict.fromkeys(parts, 0.0)
    return {part: best.get(part, OTHER_PART) for part in parts}
