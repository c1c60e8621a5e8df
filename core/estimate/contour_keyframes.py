"""Rows by which contours judge keyframes: edges found near them less what the posed body predicts.

The eight samples of a part err together and are many; the mean of either side's half, four numbers a part,
says as much of where it lies, how it is turned and how thick it is.
"""

from dataclasses import replace

import numpy as np

from ..arrays import Array, IndexArray
from ..body.posture import Posture
from ..observation.contours import SHAPE, SHARES, SIDES, ContourModel
from .contour_evidence import SHAPE_STD_M, ContourEvidence
from .keyframe_rows import UNUSED, EvidenceRows
from .terms.contours import PIXEL_STD

LENS_DIFFERENCE = 1e-3
EDGE_STD_M = 0.003
"""Error of an edge beyond the part's shape, which is fitted to the keyframes along with their own errors."""
HALVES = 2
ROWS = HALVES * len(SIDES)
"""Rows of a part."""


def contour_rows(contours: ContourEvidence, posture: Posture, frame: IndexArray) -> EvidenceRows:
    """A row for either side of both halves of each part, with the part's shape as parameters.

    Args:
        contours: Edges and appearance, learned at the keyframes.
        posture: The J judged postures.
        frame: (J,) their indices in the clip.
    """
    model, factor = contours.model, contours.album.factor
    predicted, edges = contours.near(posture, frame, contours.schedule.judging)
    average = replace(model, shape=np.zeros_like(model.shape))
    pose = model.body.pose(posture)
    flat = average.evaluate(pose, frame)
    camera = replace(model.camera, lens_mm=model.camera.lens_mm * float(np.exp(LENS_DIFFERENCE)))
    zoomed = replace(average, camera=camera).evaluate(pose, frame)
    by_lens = np.sum(predicted.normal * (zoomed.pixel - flat.pixel), axis=-1) / LENS_DIFFERENCE
    found = np.isfinite(edges.variance)
    # Average contours lie as far from the edges as the predicted ones and the fitted shape together.
    own_shape = np.sum(predicted.shape_rate * model.shape[model.part_of], axis=-1)
    residual = -edges.distance - own_shape
    scale = np.linalg.norm(predicted.shape_rate[..., :2], axis=-1)
    variance = edges.variance + (PIXEL_STD * factor) ** 2 + (EDGE_STD_M * scale) ** 2
    weight = np.where(found, 1.0 / np.where(found, variance, 1.0), 0.0)
    groups = _groups(model)
    total = weight @ groups  # (J, G)

    def mean(values: Array) -> Array:
        """Weighted means over groups of samples (J, N, ...)."""
        summed = np.einsum("jn,jn...,ng->jg...", weight, values, groups)
        return summed / np.maximum(total, 1e-12).reshape(*total.shape, *([1] * (values.ndim - 2)))

    count = groups.T @ np.ones(len(groups))
    used = total > 0.0
    parts = len(model.parts.segments)
    own = np.zeros((*total.shape, parts, SHAPE))
    rows = np.arange(total.shape[1])
    own[:, rows, rows // ROWS] = mean(predicted.shape_rate)
    # Samples of a group err alike: they weigh as much as one.
    spread = (weight > 0.0) @ groups / np.maximum(total, 1e-12)
    assert (count == len(SHARES) / HALVES).all()
    return EvidenceRows(
        np.where(used, mean(residual), 0.0),
        own.reshape(*total.shape, parts * SHAPE),
        np.where(used, mean(by_lens), 0.0),
        np.where(used[..., None], mean(model.normal_jacobian(predicted, predicted.normal, pose)), 0.0),
        np.where(used, spread, UNUSED),
        np.diag(np.tile(SHAPE_STD_M, parts) ** -2),
    )


def _groups(model: ContourModel) -> Array:
    """(N, G) which samples belong to which of the rows: part by part, half by half, side by side."""
    samples = len(SHARES) * len(SIDES)
    within = np.arange(len(model.part_of)) % samples
    half, side = within // len(SIDES) * HALVES // len(SHARES), within % len(SIDES)
    group = model.part_of * ROWS + half * len(SIDES) + side
    return np.eye(len(model.parts.segments) * ROWS)[group]
