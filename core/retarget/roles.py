"""Roles of a character's bones: the parts of a body that they play.

A role of a side ends in `.L` or `.R`, the character's own left and right.
"""

from ..body.skeleton import SIDES

MIDDLE = ("hips", "spine", "neck", "head")
CHAINS = ("spine", "neck")
"""Roles that several bones may share, from the hips upward."""
ARM = ("shoulder", "upper_arm", "forearm", "hand")
LEG = ("thigh", "shin", "foot", "toe")
ROLES = (*MIDDLE, *(f"{part}.{side}" for side in SIDES for part in (*ARM, *LEG)))
"""All roles, the trunk's first."""
REQUIRED = (
    "hips",
    *(f"{part}.{side}" for side in SIDES for part in ("upper_arm", "forearm", "thigh", "shin", "foot")),
)
"""Roles without which an armature is no character; all others may be missing."""
LIMBS = {
    f"{limb}.{side}": tuple(f"{part}.{side}" for part in parts)
    for limb, parts in (("arm", ARM), ("leg", LEG))
    for side in SIDES
}
"""The roles of `arm.L`, `leg.L`, `arm.R` and `leg.R`, from the trunk outward."""
SOURCES = ("preset", "names", "shape", "you")
"""Where a role may come from: a convention's preset, the bones' names, their places, or the person."""
