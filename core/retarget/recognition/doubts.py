"""Doubts: sentences that name role, bone and why, for a person to look at."""

from collections.abc import Mapping

from ...files.json_file import shown
from ...text import Sentence
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
            Sentence(
                "left and right are taken from the shape, against the names of the bones: feet and knees "
                "point the other way"
            )
        ]
    if against and facing.by_names > 0.0 and abs(facing.by_shape) > 1.0:
        return [
            Sentence(
                "left and right are taken from the names of the bones, although the feet point the other way"
            )
        ]
    if facing.confidence < SURE_SIDES:
        return [
            Sentence(
                "left and right may be swapped for all roles of a side: names, feet, knees and elbows "
                "hardly tell where the character faces"
            )
        ]
    return []


def trunk_doubts(figure: Figure) -> list[str]:
    """What is doubtful about hips, spine, neck and head."""
    names = figure.frame.bones.names
    found: list[str] = []
    for bone, part, other in figure.trunk.doubtful:
        name = shown(names[bone])
        if part in MIDDLE and other in MIDDLE:
            found.append(
                Sentence(
                    "{role} is doubtful: {bone} may be part of {other}, by its place",
                    role=part,
                    bone=name,
                    other=other,
                )
            )
        elif part in MIDDLE:
            found.append(
                Sentence("{role} is doubtful: {bone} may play no part, by its place", role=part, bone=name)
            )
        elif other in MIDDLE:
            found.append(
                Sentence("{role} is doubtful: {bone} may be part of it, by its place", role=other, bone=name)
            )
    return found


def limb_doubts(figure: Figure, facing: Facing, roles: Mapping[str, RoleBones]) -> list[str]:
    """What is doubtful about arms and legs."""
    bones, partner = figure.frame.bones, figure.frame.symmetry.partner
    near = "L" if facing.ahead > 0 else "R"
    found: list[str] = []
    for part in (*ARM, *LEG):
        choice = figure.limbs[part]
        if choice.probability >= SURE:
            continue
        for side in "LR":
            role = f"{part}.{side}"
            rival = choice.rival if side == near or choice.rival < 0 else int(partner[choice.rival])
            other = shown(bones.names[rival]) if rival >= 0 else ""
            if role in roles:
                found.append(_doubtful(role, roles[role], other))
            elif other:
                found.append(Sentence("{role} not found, but {bone} may be it", role=role, bone=other))
    return found


def name_doubts(figure: Figure, roles: Mapping[str, RoleBones]) -> list[str]:
    """Roles of sides that a bone plays although another has the name for it."""
    readings = dict(zip(figure.frame.bones.names, figure.frame.bones.readings, strict=True))
    found: list[str] = []
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
                found.append(
                    Sentence(
                        "{role} not found, but {bone} has the name for it", role=role, bone=shown(named[0])
                    )
                )
            else:
                found.append(
                    Sentence(
                        "{role} is doubtful: {bone} was chosen by its place, and {other} has the name for it",
                        role=role,
                        bone=shown(bone),
                        other=shown(named[0]),
                    )
                )
    return found


def missing_doubts(character_map: CharacterMap) -> list[str]:
    """Roles that most characters have and this one lacks."""
    found: list[str] = []
    if "head" not in character_map.roles:
        found.append(Sentence("head not found: no bone of the middle lies where a head begins"))
    hands = [role for role in ("hand.L", "hand.R") if role not in character_map.roles]
    if hands:
        found.append(
            Sentence("{roles} not found: the forearm is the last bone of the arm", roles=" and ".join(hands))
        )
    return found


def _doubtful(role: str, given: RoleBones, other: str) -> Sentence:
    how, bone = "its name" if given.source == "names" else "its place", shown(given.bones[0])
    if not other:
        return Sentence(
            "{role} is doubtful: {bone} was chosen by {how}, and the limb may lack it",
            role=role,
            bone=bone,
            how=how,
        )
    return Sentence(
        "{role} is doubtful: {bone} was chosen by {how}, and {other} fits almost as well",
        role=role,
        bone=bone,
        how=how,
        other=other,
    )
