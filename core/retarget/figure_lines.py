"""Lines of a character's figure for pictures: from joint to joint, whatever its bones' tails do."""

from dataclasses import dataclass

from .character import LIMBS, MIDDLE
from .maps.character_map import CharacterMap


@dataclass(frozen=True)
class FigureLine:
    """A part of the figure."""

    start: str  # the bone whose head is its beginning
    end: str | None  # the bone whose head is its end; None where that is the first bone's own tail
    side: str  # `L`, `R`, or empty for the trunk


def figure_lines(character_map: CharacterMap) -> tuple[FigureLine, ...]:
    """Trunk, neck and head, and each limb from its shoulder or hip to its last bone."""
    trunk = [bone for role in MIDDLE for bone in character_map.bones(role)]
    chains = [("", trunk)]
    for limb, roles in LIMBS.items():
        bones = [bone for bone in map(character_map.bone, roles) if bone is not None]
        chains.append((limb[-1], bones))
    return tuple(
        FigureLine(start, end, side)
        for side, chain in chains
        for start, end in zip(chain, [*chain[1:], None], strict=True)
    )
