"""InstantHMR, a small network that has learned 70 points in the picture and in space from SAM 3D Body.

github.com/mohamdev/InstantHMR, by its README and its `instanthmr/inference.py`. The points are those of MHR
(Momentum Human Rig); later files leave out those in space.
"""

from collections.abc import Sequence

import numpy as np

from ...arrays import Array, Image, SingleArray
from ..hands import hand_of
from ..layouts import Layout
from ..pose_network import Look
from .network import Box, Network, Signature, Window

DIAGONALS = 1.05  # focal length that later files take for granted, in diagonals of the picture
_FACE = ("nose", "eye.L", "eye.R", "ear.L", "ear.R")
_BODY = [f"{part}.{side}" for part in ("shoulder", "elbow", "hip", "knee", "ankle") for side in "LR"]
_FEET = [f"{part}.{side}" for side in "LR" for part in ("toe", "small_toe", "heel")]
_HANDS = {"thumb": 2, "index": 7, "pinky": 19, "wrist": 20}  # of a hand, whose fingers begin at their tips
RIGHT, LEFT = 21, 42  # where the hands' points begin
FROM_WRIST = np.array([20, *(4 * finger + joint for finger in range(5) for joint in (3, 2, 1, 0))])
LAYOUT = Layout(
    "mhr70",
    70,
    dict(enumerate([*_FACE, *_BODY, *_FEET]))
    | {
        first + at: f"{part}.{side}"
        for side, first in (("R", RIGHT), ("L", LEFT))
        for part, at in _HANDS.items()
    }
    | {69: "neck"},
)
HIPS = [LAYOUT.numbers.index(number) for number in (9, 10)]


class InstantHMR(Network):
    """Points in the picture, from -1 to 1 of the square that it sees, and in space about the body."""

    KNOWN = "InstantHMR with image, cliff_cond and joints_2d of 70 points"
    SHARE = 1.2

    def __init__(self, signature: Signature, flat: int, deep: int | None) -> None:
        super().__init__(signature, "InstantHMR", LAYOUT)
        self._flat, self._deep = flat, deep
        self.motion = deep is not None
        self._by_angle = signature.file.metadata.get("cliff_focal", "").lower() == "true"

    @classmethod
    def recognize(cls, signature: Signature) -> "InstantHMR | None":
        """See `Network`."""
        size, shapes = signature.size, [one.shape for one in signature.outputs]
        flat, deep = (1, LAYOUT.count, 2), (1, LAYOUT.count, 3)
        if size is None or size[0] != size[1] or [one.shape for one in signature.inputs[1:]] != [(1, 3)]:
            return None
        if flat not in shapes:
            return None
        return cls(signature, shapes.index(flat), shapes.index(deep) if deep in shapes else None)

    def prepare(self, picture: Image, box: Box) -> tuple[Window, Sequence[SingleArray]]:
        """See `Network`; beside the square it is told where in the picture the box is, and how large."""
        height, width = picture.shape[:2]
        window, inputs = super().prepare(picture, box)
        whole = np.array([width, height])
        off, side = box.center - 0.5 * whole, float(box.size.max())
        if self._by_angle:
            focal_px = DIAGONALS * float(np.hypot(width, height))
            place = [*np.arctan(off / focal_px), side / focal_px]
        else:
            place = [*(2.0 * off / whole), side / max(width, height)]
        return window, [*inputs, np.array([place], dtype=np.float32)]

    def read(self, outputs: Sequence[Array], window: Window) -> Look:
        """See `Network`."""
        used = LAYOUT.numbers
        pixel = window.pixel(0.5 * (outputs[self._flat][0] + 1.0) * self.size[0])
        if self._deep is None:
            return Look(pixel[used], None)
        space = outputs[self._deep][0]
        hands = [
            hand_of(space[first + FROM_WRIST], pixel[first + FROM_WRIST[0]], side)
            for side, first in (("L", LEFT), ("R", RIGHT))
        ]
        return Look(pixel[used], None, space[used] - space[used][HIPS].mean(axis=0), hands=np.array(hands))
