"""Roles of a character from its likeliest figure."""

import numpy as np

from ..maps.character_map import RoleBones
from ..roles import ARM, LEG
from .facing import Facing
from .figure import Figure
from .names import CLEAR

LONE = 0.8
"""Confidence of a hand without a counterpart."""


def roles_of(figure: Figure, facing: Facing) -> dict[str, RoleBones]:
    """Bones, confidence and source of each role that is there."""
    trunk, bones = figure.trunk, figure.frame.bones
    found: dict[str, RoleBones] = {}
    heads = () if trunk.head is None else (trunk.head,)
    for part, those in (
        ("hips", (trunk.hips,)),
        ("spine", trunk.spine),
        ("neck", trunk.neck),
        ("head", heads),
    ):
        if those:
            names = tuple(bones.names[bone] for bone in those)
            found[part] = RoleBones(names, float(trunk.sure[part]), _source(figure, part, those))
    near_side, far_side = ("L", "R") if facing.ahead > 0 else ("R", "L")
    for part in (*ARM, *LEG):
        choice = figure.limbs[part]
        if choice.bone < 0:
            continue
        other = int(figure.frame.symmetry.partner[choice.bone])
        for side, bone in ((near_side, choice.bone), (far_side, other)):
            found[f"{part}.{side}"] = RoleBones(
                (bones.names[bone],), choice.probability * facing.confidence, _source(figure, part, (bone,))
            )
    for side, forearm in (("L", found["forearm.L"].bones[0]), ("R", found["forearm.R"].bones[0])):
        if "hand.L" not in found and "hand.R" not in found:
            hand = _lone_hand(figure, bones.names.index(forearm))
            if hand is not None:
                source = _source(figure, "hand", (hand,))
                found[f"hand.{side}"] = RoleBones((bones.names[hand],), LONE * facing.confidence, source)
    return found


def _lone_hand(figure: Figure, forearm: int) -> int | None:
    """The hand on a forearm whose counterpart has none: as far from the elbow as the shoulder, about."""
    frame = figure.frame
    elbow, shoulder = (frame.place[figure.bone(part)] for part in ("forearm", "upper_arm"))
    length = float(np.linalg.norm(elbow - shoulder))
    for bone in frame.bones.children[forearm]:
        way = float(np.linalg.norm(frame.bones.head[bone] - frame.bones.head[forearm])) / frame.bones.size
        alone = frame.symmetry.partner[bone] < 0 and not frame.bones.readings[bone].other
        if alone and 0.5 * length < way < 1.7 * length:
            return bone
    return None


def _source(figure: Figure, part: str, bones: tuple[int, ...]) -> str:
    readings = figure.frame.bones.readings
    return "names" if all(readings[bone].scores[part] >= CLEAR for bone in bones) else "shape"
