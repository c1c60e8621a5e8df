"""Fingers of a character: chains of bones below its hands, by their names or in order across the palm."""

from collections.abc import Iterator

import numpy as np

from ...arrays import Array
from ...body.skeleton import FINGERS, SIDES
from ...numerics.vectors import unit
from ..character import Character
from ..maps.character_map import CharacterMap, RoleBones
from .names import FINGER_WORDS, read_name

NAMED, PLACED = 0.95, 0.7  # confidence of fingers by their names, and by their places
MOST_BONES = 3
KNUCKLE = 0.5  # share of the way from the wrist to its end at which a finger's first bone begins at least
THUMB = 0.75  # share of the other fingers' way along the hand within which a thumb begins


def find_fingers(character: Character, character_map: CharacterMap) -> dict[str, RoleBones]:
    """The fingers of the hands that a map has, but of those of which it knows any."""
    found: dict[str, RoleBones] = {}
    for side in SIDES:
        hand = character_map.bone(f"hand.{side}")
        known = any(f"{finger}.{side}" in character_map.roles for finger in FINGERS)
        if hand is None or hand not in character.index or known:
            continue
        wrist = character.bone(hand).head
        chains = []
        for chain in _chains(character, character.index[hand]):
            while len(chain) > MOST_BONES:  # without the bone of the palm before it, and the end after it
                first, second = (np.linalg.norm(character.bones[bone].head - wrist) for bone in chain[:2])
                thumb = _named(character, chain) == FINGERS[0]
                chain = chain[1:] if first < KNUCKLE * second and not thumb else chain[:-1]
            chains += [chain] if len(chain) > 1 else []
        names = [_named(character, chain) for chain in chains]
        sure, source = NAMED, "names"
        if None in names or len(set(names)) < len(names):
            names, sure, source = _by_place(character, wrist, chains), PLACED, "shape"
        for name, chain in zip(names, chains, strict=True):
            if name is not None:
                bones = tuple(character.bones[bone].name for bone in chain)
                found[f"{name}.{side}"] = RoleBones(bones, sure, source)
    return found


def _chains(character: Character, above: int) -> Iterator[list[int]]:
    """The longest way down below each bone on a hand; where that parts in several, below each of these."""
    for child in character.children[above]:
        if read_name(character.bones[child].name).mechanism:
            continue
        ways = [_longest(character, below) for below in character.children[child]]
        if sum(len(way) > 1 for way in ways) > 1:
            yield from _chains(character, child)
        else:
            yield _longest(character, child)


def _longest(character: Character, bone: int) -> list[int]:
    ways = [_longest(character, child) for child in character.children[bone]]
    return [bone, *max(ways, key=len, default=[])]


def _named(character: Character, chain: list[int]) -> str | None:
    """The one finger that names speak for."""
    words = {word for bone in chain for word in read_name(character.bones[bone].name).words}
    found = [finger for finger, own in FINGER_WORDS.items() if words & own]
    return found[0] if len(found) == 1 else None


def _by_place(character: Character, wrist: Array, chains: list[list[int]]) -> list[str | None]:
    """Names of at most five chains: the thumb at one side begins nearer to the wrist; the others in order."""
    if not 1 < len(chains) <= len(FINGERS):
        return [None] * len(chains)
    starts = np.array([character.bones[chain[0]].head for chain in chains]) - wrist
    ways = unit(starts)
    along = unit(ways.mean(axis=0))
    far = starts @ along
    across = np.linalg.svd(ways - (ways @ along)[:, None] * along)[2][0]
    order = np.argsort(ways @ across).tolist()
    if far[order[-1]] < far[order[0]]:
        order.reverse()
    thumb = far[order[0]] < THUMB * float(np.median(far[order[1:]]))
    names: list[str | None] = [None] * len(chains)
    for place, name in zip(order, FINGERS if thumb else FINGERS[1:], strict=False):
        names[place] = name
    return names
