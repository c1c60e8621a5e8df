"""Names of bones read as tokens: the side they name, and how well they fit each role."""

import re
import unicodedata
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache

from ..roles import ARM, LEG, MIDDLE
from .vocabulary import (
    FILLER_WORDS,
    LIMB_HELPERS,
    LIMB_WORDS,
    MECHANISM_WORDS,
    OTHER_WORDS,
    SIDE_WORDS,
    TRUNK_WORDS,
)

OTHER_PART = -2.0
"""Score of a part where the name speaks for another."""
NO_PART = -4.0
"""Score of every part where the name speaks for something that plays no role."""
CLEAR = 1.0
"""Score from which a name speaks for a part."""
UNKNOWN = 3
"""As many words as this a letter counts that is no word."""
LONGEST_NAME = 120
"""Characters of a name that are read; Blender's own names hold 63 bytes."""

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

    words: tuple[str, ...]
    """Its words in lower case, without numbers and namespace."""
    side: str | None
    """`L`, `R`, or None."""
    scores: Mapping[str, float]
    """By part of `roles.MIDDLE`, `ARM` and `LEG`; 0 where the name says nothing."""
    mechanism: bool
    """Whether it names a control or helper."""
    other: bool
    """Whether it names something that plays no role: a finger, cloth, an end."""
    unsided: str
    """The name with the side's word replaced, equal for a pair's two names."""

    @cached_property
    def clear_part(self) -> str | None:
        """The part that the name speaks for most; None where it speaks for none."""
        part = max(self.scores, key=lambda name: self.scores[name])
        return part if self.scores[part] >= CLEAR else None


@lru_cache(maxsize=4096)
def read_name(name: str) -> NameReading:
    """Read a bone's name."""
    words = _words(name)
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
    return NameReading(words, side, {**trunk, **limb}, mechanism, other, _unsided(name))


def _words(name: str) -> tuple[str, ...]:
    """The name's words in lower case; compounds such as `lforearm` are taken apart."""
    text = _NAMESPACE.sub("", unicodedata.normalize("NFKC", name[:LONGEST_NAME])) or name[:LONGEST_NAME]
    found: list[str] = []
    for piece in _PIECES.findall(text):
        found += _taken_apart(piece.casefold())
    return tuple(found)


def _taken_apart(piece: str) -> list[str]:
    """A piece as words of the vocabulary, the fewest; itself where that does not work.

    In scripts without spaces what is no word is left out.
    """
    if piece in _VOCABULARY:
        return [piece]
    best: list[tuple[int, list[str]] | None] = [(0, [])]
    for end in range(1, len(piece) + 1):
        ways = [] if _LATIN.fullmatch(piece) or best[-1] is None else [(best[-1][0] + UNKNOWN, best[-1][1])]
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


def _unsided(name: str) -> str:
    """The name with the words and letters of sides replaced by one sign."""
    pieces = _BORDERS.split(name[:LONGEST_NAME])
    return "".join("*" if piece and piece.casefold() in SIDE_WORDS else piece for piece in pieces if piece)
