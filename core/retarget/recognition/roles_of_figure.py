"""Roles of a character from its likeliest figure."""

from ..character_map import RoleBones
from ..roles import ARM, LEG
from .facing import Facing
from .figure import Figure
from .names import CLEAR


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
    return found


def _source(figure: Figure, part: str, bones: tuple[int, ...]) -> str:
    readings = figure.frame.bones.readings
    return "names" if all(readings[bone].scores[part] >= CLEAR for bone in bones) else "shape"
