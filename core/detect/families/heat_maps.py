"""Networks that give a heat map for every point: ViTPose, HRNet and their like, by MMPose's conventions.

Transformers were trained without bias, the first cell in the middle of the first pixel and the last in that
of the last (Huang et al. 2020, "The Devil is in the Details"); the others with a cell for four pixels.
"""

from collections.abc import Sequence

import numpy as np

from ...arrays import Array
from ..layouts import LAYOUTS
from ..pose_network import Look
from .network import Network, Signature, Window, vertex

CELL = 4  # pixels
LAYOUT_OF = {LAYOUTS[name].count: LAYOUTS[name] for name in ("coco17", "wholebody133")}


class HeatMaps(Network):
    """A heat map a point, a quarter as wide and high as the picture."""

    KNOWN = "ViTPose and HRNet with heat maps of 17 or 133 points"
    SHARE = 1.25

    def __init__(self, signature: Signature, points: int) -> None:
        self._unbiased = bool(signature.file.operators & {"Softmax", "LayerNormalization"})
        super().__init__(signature, "ViTPose" if self._unbiased else "HRNet", LAYOUT_OF[points])

    @classmethod
    def recognize(cls, signature: Signature) -> "HeatMaps | None":
        """See `Network`."""
        if signature.size is None or len(signature.inputs) != 1 or len(signature.outputs) != 1:
            return None
        (output,), (width, height) = signature.outputs, signature.size
        points = (output.shape + (None, None))[1] or 0
        fits = output.shape == (1, points, height // CELL, width // CELL) and not (width | height) % CELL
        return cls(signature, points) if fits and points in LAYOUT_OF else None

    def read(self, outputs: Sequence[Array], window: Window) -> Look:
        """See `Network`."""
        maps = outputs[0][0, self.layout.numbers]
        rows, columns = np.unravel_index(maps.reshape(len(maps), -1).argmax(axis=-1), maps.shape[1:])
        points, place = np.arange(len(maps)), []
        for axis, at in ((2, columns), (1, rows)):
            inner = np.clip(at, 1, maps.shape[axis] - 2)
            spots = [(points, rows, inner + step) if axis == 2 else (points, inner + step, columns)
                     for step in (-1, 0, 1)]  # fmt: skip
            cell = at + np.where(at == inner, vertex(*(maps[spot] for spot in spots)), 0.0)
            own = self.size[2 - axis]
            place.append(cell * ((own - 1) / (maps.shape[axis] - 1) if self._unbiased else CELL) + 0.5)
        score = np.clip(maps[points, rows, columns], 0.0, 1.0)
        return Look(window.pixel(np.stack(place, axis=-1)), score)
