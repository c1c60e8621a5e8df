"""Layouts: which point of the body each number in a detector's list of points shows.

What the points mean differs between detectors. COCO's points were clicked by people who saw clothes, so that
hips lie higher and farther apart than the joints; OpenPose's Neck and MidHip are the middles of shoulders and
hips; Halpe's Head is the top of the head, its Neck and Hip are points of their own; BlazePose's foot index is
the tip of the big toe, and its mouth and the corners of its eyes are left out. Layouts without a point for
the head have the ears: what was seen is kept, and the estimate makes of it what it can.
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from types import MappingProxyType

from ..body.human import HUMAN
from ..body.skeleton import SIDES
from .keypoints import BODY_POINTS

OWN = "own"  # name of a layout whose file lists the names itself
HAND_POINTS = 21


@dataclass(frozen=True)
class Layout:
    """An order of points."""

    name: str
    count: int  # number of points of a person in the file
    points: Mapping[int, str]  # the body point by number; numbers that are missing show nothing that is used

    @property
    def names(self) -> tuple[str, ...]:
        """The body points that are used, in the order of their numbers."""
        return tuple(self.points[number] for number in sorted(self.points))

    @property
    def numbers(self) -> list[int]:
        """Their numbers."""
        return sorted(self.points)

    @property
    def with_hands(self) -> "Layout":
        """The layout followed by the points of the left hand and of the right, unless it has hands itself."""
        more = {} if "index.L" in self.names else _hands(self.count, self.count + HAND_POINTS)
        return Layout(self.name, self.count + 2 * HAND_POINTS, MappingProxyType({**self.points, **more}))


def _both(*parts: str) -> list[str]:
    return [f"{part}.{side}" for part in parts for side in SIDES]


def _limb(side: str, *parts: str) -> list[str]:
    return [f"{part}.{side}" for part in parts]


def _layout(
    name: str, count: int, names: Sequence[str | None], more: Mapping[int, str] | None = None
) -> Layout:
    points = {number: point for number, point in enumerate(names) if point is not None}
    return Layout(name, count, MappingProxyType(points | dict(more or {})))


def _hands(left: int, right: int) -> dict[int, str]:
    """Knuckles of the two hands, whose 21 points begin at these numbers."""
    knuckles = {"index": 5, "thumb": 2, "pinky": 17}
    return {
        first + knuckle: f"{finger}.{side}"
        for side, first in zip(SIDES, (left, right), strict=True)
        for finger, knuckle in knuckles.items()
    }


_ARM, _LEG, _FOOT = ("shoulder", "elbow", "wrist"), ("hip", "knee", "ankle"), ("toe", "small_toe", "heel")
_COCO = ["nose", *_both("eye", "ear", *_ARM, *_LEG)]
_FEET = [*_limb("L", *_FOOT), *_limb("R", *_FOOT)]
_HALPE = [*_COCO, "crown", "neck", "pelvis", *_both(*_FOOT)]
_OPENPOSE_ARMS = ["nose", "neck", *_limb("R", *_ARM), *_limb("L", *_ARM)]
_OPENPOSE_LEGS = [*_limb("R", *_LEG), *_limb("L", *_LEG), "eye.R", "eye.L", "ear.R", "ear.L"]  # and the face
_BLAZEPOSE = [
    *("nose", None, "eye.L", None, None, "eye.R", None, "ear.L", "ear.R", None, None),
    *_both(*_ARM, "pinky", "index", "thumb", *_LEG, "heel", "toe"),
]
_KNOWN = (
    _layout("coco17", 17, _COCO),
    _layout("coco18", 18, [*_OPENPOSE_ARMS, *_OPENPOSE_LEGS]),
    _layout("body25", 25, [*_OPENPOSE_ARMS, "pelvis", *_OPENPOSE_LEGS, *_FEET]),
    _layout("halpe26", 26, _HALPE),
    _layout("blazepose33", 33, _BLAZEPOSE),
    _layout("wholebody133", 133, [*_COCO, *_FEET], _hands(91, 112)),
    _layout("halpe136", 136, _HALPE, _hands(94, 115)),
)
LAYOUTS: Mapping[str, Layout] = MappingProxyType({layout.name: layout for layout in _KNOWN})
"""All that detectors use; no two have the same number of points."""


def layout_of(count: int) -> Layout | None:
    """The layout that has so many points; None where none has."""
    return next((layout for layout in LAYOUTS.values() if layout.count == count), None)


def own_layout(names: Sequence[str]) -> Layout:
    """A layout of these body points."""
    return _layout(OWN, len(names), names)


SIDE_WORDS = {"l": "L", "left": "L", "r": "R", "right": "R"}
SYNONYMS = {
    "skull": "head",
    "head top": "crown",
    "top of head": "crown",
    "top head": "crown",
    "vertex": "crown",
    "throat": "neck",
    "hips": "pelvis",
    "hip": "pelvis",
    "root": "pelvis",
    "big toe": "toe",
    "toes": "toe",
    "little toe": "small_toe",
    "small toe": "small_toe",
    "pinky toe": "small_toe",
    "index finger": "index",
    "little finger": "pinky",
}
"""Other words for a body point, sides left out; hips without a side are the middle between both."""
PAIRED = {name.partition(".")[0] for name in HUMAN.point_names if "." in name}
WORDS = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+")
"""Words of a name, whatever separates them, as in `LeftWrist`, `left_wrist` and `wrist.L`; no numbers."""


@lru_cache(maxsize=4096)  # panels ask for all tracks of a clip whenever they are drawn
def named_point(name: str) -> str | None:
    """Body point that a track is named after, as `wrist.L`, `Left Wrist` or `l_wrist.001`; None if none."""
    words = [word.lower() for word in WORDS.findall(name)]
    if len(words) == 1 and words[0][1:] in PAIRED:  # as in LKNEE
        words = [words[0][:1], words[0][1:]]
    sides = {SIDE_WORDS[word] for word in words if word in SIDE_WORDS}
    part = " ".join(word for word in words if word not in SIDE_WORDS)
    if len(sides) > 1 or not part:
        return None
    (side,) = sides or {""}
    if side:
        stems = (part.replace(" ", "_"), SYNONYMS.get(part, ""))
        candidates = [f"{stem}.{side}" for stem in stems]
    else:
        candidates = [part, SYNONYMS.get(part, "")]
    return next((point for point in candidates if point in BODY_POINTS), None)
