"""Turns of bones that follow from the performer's segments alone, and where they put the joints."""

from collections.abc import Mapping

import numpy as np

from ...arrays import Array
from ...body import rotations
from .rest_body import RestBody

SEGMENTS = {
    "hips": "pelvis",
    "head": "head",
    "shoulder": "girdle",
    "upper_arm": "upper_arm",
    "forearm": "forearm",
    "hand": "hand",
    "thigh": "thigh",
    "shin": "shin",
    "foot": "foot",
    "toe": "foot",
}
"""The performer's segment that a role follows; spine and neck lie between two of them."""


def segment_of(role: str) -> str:
    """The performer's segment that a role of one bone follows."""
    part, dot, side = role.partition(".")
    return f"{SEGMENTS[part]}{dot}{side}"


def bone_turns(body: RestBody, turn: Mapping[str, Array], alignment: Mapping[str, Array]) -> list[Array]:
    """(F, 3, 3) a bone: its turn from the character's rest, in canonical axes.

    Args:
        body: The character at rest.
        turn: (F, 3, 3) by segment of the performer, on the character's stage.
        alignment: (3, 3) by role.
    """
    found: list[Array] = []
    chest = turn["chest" if body.is_moved("spine") else "pelvis"]
    for bone in body.bones:
        if not body.is_moved(bone.role):
            found.append(
                found[bone.carrier] if bone.carrier >= 0 else np.broadcast_to(np.eye(3), chest.shape)
            )
            continue
        if bone.role in ("spine", "neck"):
            lower, upper = (turn["pelvis"], turn["chest"]) if bone.role == "spine" else (chest, turn["head"])
            share = body.character_map.shares(bone.role)[bone.number]
            wanted = lower @ rotations.exponential(
                share * rotations.logarithm(np.swapaxes(lower, -1, -2) @ upper)
            )
        else:
            wanted = turn[segment_of(bone.role)]
        found.append(np.asarray(wanted @ alignment[bone.role]))
    return found


def joint_places(body: RestBody, turns: list[Array]) -> list[Array]:
    """(F, 3) a bone: its joint relative to the midpoint of the hip joints [m]."""
    places: list[Array] = []
    for bone in body.bones:
        if bone.carrier < 0:
            places.append(np.zeros((len(turns[0]), 3)))
        else:
            offset = bone.head - body.bones[bone.carrier].head
            places.append(places[bone.carrier] + turns[bone.carrier] @ offset)
    middle = 0.5 * (places[body.first["thigh.L"]] + places[body.first["thigh.R"]])
    return [place - middle for place in places]
