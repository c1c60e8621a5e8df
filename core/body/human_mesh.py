"""The shipped human body: a smooth skin with the parts that move it, fitted to joints of another body.

`tools/make_human_mesh.py` makes it. Parts are finer than the skeleton's segments: whoever skins it says which
of its own bones a part stands for.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

from ..arrays import Array, IndexArray
from .rotations import smallest
from .skeleton import SIDES

FILE = Path(__file__).resolve().parents[2] / "presets" / "body" / "human.npz"
UNIT_M = 1.0 / 20_000.0  # of the file's vertices
TRUNK = (("hips", 0.0, 0.2), ("waist", 0.2, 0.4), ("ribs", 0.4, 0.7), ("chest", 0.7, 1.0))
"""Parts of the trunk, with the shares of the way from hips to neck at which they begin and end."""
LIMBS = (("upper_arm", "forearm", "hand", "hand_end"), ("thigh", "shin", "foot", "toe", "toe_end"))
"""Joints along a limb; each part is called after the joint that it begins at."""
LAST = ("head", "hand", "toe")  # parts whose length is as the body's girth, whatever bone ends there
COLLAR = 0.16  # where a shoulder's part begins, as a share of the way from the middle to the shoulder


@dataclass(frozen=True, eq=False)
class HumanMesh:
    """A human skin in a T pose, Z up, facing -Y, the hips' middle at the origin."""

    vertices: Array  # (N, 3) [m]
    triangles: IndexArray  # (T, 3) corners, counterclockwise from outside
    parts: tuple[str, ...]  # names of the P parts
    weights: Array  # (N, P) how much of each vertex each part moves; rows add up to 1
    joints: Mapping[str, Array]
    """(3,) by name: `neck`, `head`, `crown`, and with `.L` and `.R` those of `LIMBS` [m]."""

    @classmethod
    def read(cls) -> "HumanMesh":
        """The shipped body, read once."""
        return _read(FILE)

    def fitted(self, joints: Mapping[str, Array]) -> Array:
        """(N, 3) the vertices on a body with other joints at rest, of the same names [m].

        Parts are as long as the body's own and as wide as its hips, shoulders and legs are on average.
        """
        girth = _size(joints) / _size(self.joints)
        own, other = part_ends(self.joints), part_ends(joints)
        found = np.zeros_like(self.vertices)
        for index, part in enumerate(self.parts):
            rows = np.flatnonzero(self.weights[:, index])
            (start, end), (to_start, to_end) = own[part], other[part]
            length, to_length = float(np.linalg.norm(end - start)), float(np.linalg.norm(to_end - to_start))
            before, after = (end - start) / length, (to_end - to_start) / to_length
            offset = self.vertices[rows] - start
            along = offset @ before
            longer = girth if part.partition(".")[0] in LAST else to_length / length
            moved = to_start + girth * (offset - along[:, None] * before) @ smallest(before, after).T
            moved += longer * along[:, None] * after
            found[rows] += self.weights[rows, index, None] * moved
        return found

    def on_bones(self, bones: Mapping[str, Mapping[str, float]]) -> dict[str, Array]:
        """(N,) weights by bone, of shares by part and bone that a part is made of."""
        found: dict[str, Array] = {}
        for index, part in enumerate(self.parts):
            for bone, share in bones[part].items():
                found[bone] = found.get(bone, np.zeros(len(self.vertices))) + share * self.weights[:, index]
        return found


@cache
def _read(file: Path) -> HumanMesh:
    with np.load(file, allow_pickle=False) as stored:
        rows, shares = stored["parts"].astype(np.intp), stored["shares"].astype(np.float64) / 255.0
        parts = tuple(str(name) for name in stored["names"])
        weights = np.zeros((len(rows), len(parts)))
        for column in range(rows.shape[1]):
            weights[np.arange(len(rows)), rows[:, column]] += shares[:, column]
        names = (str(name) for name in stored["joint_names"])
        return HumanMesh(
            stored["vertices"].astype(np.float64) * UNIT_M,
            stored["triangles"].astype(np.intp),
            parts,
            weights,
            dict(zip(names, stored["joints"].astype(np.float64), strict=True)),
        )


def part_ends(joints: Mapping[str, Array]) -> dict[str, tuple[Array, Array]]:
    """Where each part begins and ends, of a body's joints [m]."""
    hips = 0.5 * (joints["thigh.L"] + joints["thigh.R"])
    shoulders = 0.5 * (joints["upper_arm.L"] + joints["upper_arm.R"])
    way = joints["neck"] - hips
    found = {part: (hips + first * way, hips + last * way) for part, first, last in TRUNK}
    found["neck"] = (joints["neck"], joints["head"])
    found["head"] = (joints["head"], joints["crown"])
    for side in SIDES:
        for limb in LIMBS:
            for first, last in zip(limb[:-1], limb[1:], strict=True):
                found[f"{first}.{side}"] = (joints[f"{first}.{side}"], joints[f"{last}.{side}"])
        # A foot stays level whatever height its bone's end has: its sole is flat at rest.
        ankle, *ahead = (joints[f"{name}.{side}"] for name in ("foot", "toe", "toe_end"))
        ball, tip = (np.array([*place[:2], ankle[2]]) for place in ahead)
        found[f"foot.{side}"], found[f"toe.{side}"] = (ankle, ball), (ball, tip)
        shoulder = joints[f"upper_arm.{side}"]
        found[f"shoulder.{side}"] = (shoulders + COLLAR * (shoulder - shoulders), shoulder)
    return found


def _size(joints: Mapping[str, Array]) -> float:
    """A body's size by the width of hips and shoulders and the length of its legs [m]."""

    def apart(one: str, other: str) -> float:
        return float(np.linalg.norm(joints[one] - joints[other]))

    leg = apart("thigh.L", "shin.L") + apart("shin.L", "foot.L")
    return float((apart("thigh.L", "thigh.R") * apart("upper_arm.L", "upper_arm.R") * leg) ** (1.0 / 3.0))
