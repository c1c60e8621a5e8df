"""Names of the points of the body that a keypoint may show.

The principal points of the skeleton, and what detectors add: face, spine, hands and feet. Left and right are
the performer's own.
"""

from collections.abc import Sequence

from ...body.human import HUMAN
from ...body.skeleton import SIDES

FACE = ("nose", *(f"{part}.{side}" for part in ("eye", "ear") for side in SIDES))
SPINE = ("crown", "neck", "pelvis")
"""Top of the head, the middle between the shoulders, and the middle between the hips."""
HANDS = tuple(f"{part}.{side}" for part in ("index", "thumb", "pinky") for side in SIDES)
"""Knuckles: where the finger begins."""
FEET = tuple(f"{part}.{side}" for part in ("heel", "toe", "small_toe") for side in SIDES)
"""Back of the heel, tip of the big toe, tip of the small toe."""
BODY_POINTS = (*HUMAN.point_names, *FACE, *SPINE, *HANDS, *FEET)
"""All names, in the order in which they are listed to people."""


def mirrored_point(name: str) -> str:
    """The same point on the other side of the body; a point in the middle is its own mirror image."""
    stem, dot, side = name.rpartition(".")
    return f"{stem}.{'R' if side == 'L' else 'L'}" if dot else name


def mirror_images(names: Sequence[str], sources: Sequence[str]) -> list[int]:
    """For each keypoint the index of the one that its source has on the other side; its own without one."""
    index = {key: i for i, key in enumerate(zip(names, sources, strict=True))}
    return [
        index.get((mirrored_point(name), source), i)
        for i, (name, source) in enumerate(zip(names, sources, strict=True))
    ]
