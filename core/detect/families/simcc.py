"""Networks that tell columns and rows apart: RTMPose, RTMW, DWPose, and RTMW3D with depths besides (SimCC).

Li et al. 2022, "SimCC: a Simple Coordinate Classification Perspective for Human Pose Estimation"; MMPose's
projects rtmpose and rtmpose3d. Bins are halves of the pixels' own numbers, which count from their middles.
"""

from collections.abc import Sequence

import numpy as np

from ...arrays import Array
from ...body.skeleton import SIDES
from ..layouts import HAND_POINTS, LAYOUTS, layout_of
from ..pose_network import Look
from .network import Network, Signature, Window, peaks

BINS = 2  # of a pixel
DEPTH_RANGE_M = 2.1744869  # of the first and of the last bin of depths from the hips
LAYOUT_NAMES = ("coco17", "halpe26", "wholebody133")
BODY, HANDS = slice(17), slice(91, 133)  # of whole bodies
LEAST_SCORE = 0.5  # of a hand's points that show one, in the body's


class SimCC(Network):
    """Bins of columns, of rows, and perhaps of depths."""

    KNOWN = "RTMPose, RTMW, DWPose and RTMW3D with simcc_x and simcc_y of 17, 26 or 133 points"
    SHARE = 1.25

    @classmethod
    def recognize(cls, signature: Signature) -> "SimCC | None":
        """See `Network`."""
        size, shapes = signature.size, [one.shape for one in signature.outputs]
        if size is None or len(signature.inputs) != 1 or len(shapes) not in (2, 3):
            return None
        count, bins = shapes[0][1], [BINS * side for side in size]
        layout = layout_of(count or 0)
        alike = all(len(shape) == 3 and shape[:2] == (1, count) for shape in shapes)
        if layout is None or layout.name not in LAYOUT_NAMES or not alike:
            return None
        if [shape[2] for shape in shapes[:2]] != bins or (shapes[-1][2] or 0) < 3:
            return None
        family = "RTMW" if layout is LAYOUTS["wholebody133"] else "RTMPose"
        return cls(signature, family + "3D" * (len(shapes) == 3), layout)

    def read(self, outputs: Sequence[Array], window: Window) -> Look:
        """See `Network`."""
        used = self.layout.numbers
        (column, sure), (row, also) = (peaks(one[0]) for one in outputs[:2])
        place = np.stack([column, row], axis=-1) / BINS + 0.5
        pixel, score = window.pixel(place), np.maximum(np.minimum(sure, also), 0.0)
        depth = fingers = None
        if len(outputs) == 3:
            bins = outputs[2].shape[-1]
            depth = (peaks(outputs[2][0])[0] / (0.5 * bins) - 1.0) * DEPTH_RANGE_M
        if depth is not None and self.layout is LAYOUTS["wholebody133"]:
            shape = (len(SIDES), HAND_POINTS, -1)
            fingers = np.column_stack([pixel, depth])[HANDS].reshape(shape)
            shown = score[HANDS].reshape(shape).mean(axis=(1, 2)) > LEAST_SCORE * score[BODY].mean()
            fingers = np.where(shown[:, None, None], fingers, np.nan)
        deep = None if depth is None else depth[used]
        return Look(pixel[used], score[used], depth_m=deep, fingers=fingers)
