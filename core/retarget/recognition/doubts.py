"""Doubts: sentences that name role, bone and why, for a person to look at."""

from collections.abc import Mapping

from ...files.json_file import shown
from ..maps.character_map import CharacterMap, RoleBones
from ..roles import ARM, LEG, MIDDLE
from .facing import SURE as SURE_SIDES
from .facing import Facing
from .figure import Figure

SURE = 0.75
"""Confidence from which a role is not doubted."""


def side_doubts(facing: Facing) -> list[str]:
    """What is doubtful about left and right."""
    against = facing.by_names * facing.by_shape < 0.0
    if against and facing.by_names < 0.0 and abs(facing.by_shape) > 1.0:
        return [
            "left and right are taken from the shape, against the names of the bones: feet and knees point "
            "the other way"
        ]
    if against and facing.by_names > 0.0 and abs(facing.by_shape) > 1.0:
        return ["left and right are taken from the names of the bones, although the feet point the other way"]
    if facing.confidence < SURE_SIDES:
        return [
            "left and right may be swapped for all roles of a side: names, feet, knees and elbows hardly "
            "tell where the character faces"
        ]
    return []


def trunk_doubts(figure: Figure) -> list[str]:
    """What is doubtful about hips, spine, neck and head."""
    names = figure.frame.bones.names
    found = []
    for bone, part, other in figure.trunk.doubtful:
        if part in MIDDLE and other in MIDDLE:
            found.append(f"{part} is doubtful: {shown(names[bone])} may be part of {other}, by its place")
        elif part in MIDDLE:
            found.append(f"{part} is doubtful: {shown(names[bone])} may play no part, by its place")
        elif other in MIDDLE:
            found.append(f"{other} is doubtful: {shown(names[bone])} may be part of it, by its place")
    return found


def limb_doubts(figure: Figure, facing: Facing, roles: Mapping[str, RoleBones]) -> list[str]:
    """What is doubtful about arms and legs."""
    bones, partner = figure.frame.bones, figure.frame.symmetry.partner
    near = "L" if facing.ahead > 0 else "R"
    found = []
    for part in (*ARM, *LEG):
        choice = figure.limbs[part]
        if choice.probability >= SURE:
            continue
        for side in "LR":
            role = f"{part}.{side}"
            rival = choice.rival if side == near or choice.rival < 0 else int(partner[choice.rival])
            other = shown(bones.names[rival]) if rival >= 0 else ""
            if role in roles:
                why = f"{other} fits almost as well" if other else "the limb may lack it"
                found.append(_sentence(role, roles[role], why))
            elif other:
                found.append(f"{role} not found, but {other} may be it")
    return found


def name_doubts(figure: Figure, roles: Mapping[str, RoleBones]) -> list[str]:
    """Roles of sides that a bone plays although another has the name for it."""
    readings = dict(zip(figure.frame.bones.names, figure.frame.bones.readings, strict=True))
    found = []
    for part in (*ARM, *LEG):
        for side in "LR":
            role = f"{part}.{side}"
            bone = roles[role].bones[0] if role in roles else None
            named = [
                name
                for name, reading in readings.items()
                if (reading.clear_part, reading.side) == (part, side)
            ]
            if not named or (bone is not None and readings[bone].clear_part == part):
                continue
            if bone is None:
                found.append(f"{role} not found, but {shown(named[0])} has the name for it")
            else:
                why = f"{shown(named[0])} has the name for it"
                found.append(f"{role} is doubtful: {shown(bone)} was chosen by its place, and {why}")
    return found


def missing_doubts(character_map: CharacterMap) -> list[str]:
    """Roles that most characters have and this one lacks."""
    found = []
    if "head" not in character_map.roles:
        found.append("head not found: no bone of the middle lies where a head begins")
    hands = [role for role in ("hand.L", "hand.R") if role not in character_map.roles]
    if hands:
        found.append(f"{' and '.join(hands)} not found: the forearm is the last bone of the arm")
    return found


def _sentence(role: str, given: RoleBones, why: str) -> str:
    how = "its name" if given.source == "names" else "its place"
    return f"{role} is doubtful: {shown(given.bones[0])} was chosen by {how}, and {why}"
