"""Review curves: the confidence of each frame as F-curves beside the motion's own, for the Graph Editor.

They animate custom properties of the armature object, which move nothing: bones, exporters by default, and
readers of keyframes ignore them.
"""

from dataclasses import dataclass

import bpy
import numpy as np

from ...core.arrays import Array
from ...core.review.review import Review
from .actions import channelbag_for
from .keys import add_generated_keys, remove_generated_keys

GROUP = "Keymark Confidence"
SUFFIX = " (Keymark)"  # suffix of all custom properties' names, which tells them from others


@dataclass(frozen=True, eq=False)
class ReviewCurve:
    """One curve and the property it animates."""

    name: str  # the quantity, with its unit
    description: str
    values: Array  # (F,) values; frames that are NaN get no key
    soft_max: float  # upper end of the property's slider; the lower is 0

    @property
    def property_name(self) -> str:
        """Name of the custom property."""
        return self.name + SUFFIX


def review_curves(review: Review) -> tuple[ReviewCurve, ...]:
    """Curves of a review: confidence, near-membership, reprojection error and the points' sigmas."""
    believed = np.where(review.keypoints.thrown_out, np.nan, review.keypoints.distance_px)
    distance = np.concatenate([review.reprojection_px, believed], axis=1)
    compared = np.isfinite(distance)
    total = np.where(compared, distance, 0.0).sum(axis=1)
    count = compared.sum(axis=1)
    reprojection = np.where(count > 0, total / np.maximum(count, 1), np.nan)
    curves = [
        ReviewCurve(
            "Confidence",
            "Share of the joints expected within 2.5 % of the performer's height of their true place",
            review.confidence,
            1.0,
        ),
        ReviewCurve(
            "Nearness",
            "Degree to which a keyframe is near: 1 at a keyframe, 0 midway between two",
            review.nearness,
            1.0,
        ),
        ReviewCurve(
            "Reprojection px",
            "Mean distance between the markers and keypoints seen and those predicted, in pixels of the "
            "footage",
            reprojection,
            10.0,
        ),
    ]
    curves += [
        ReviewCurve(
            f"Sigma {name} mm",
            f"Standard deviation of the point {name}, in millimeters",
            1e3 * sigma_m,
            100.0,
        )
        for name, sigma_m in zip(review.point_names, review.sigma_m.T, strict=True)
    ]
    return tuple(curves)


def curve_path(name: str) -> str:
    """Data path of the custom property of a review curve, on the armature object."""
    return f'["{bpy.utils.escape_identifier(name + SUFFIX)}"]'


def is_review_curve(fcurve: bpy.types.FCurve) -> bool:
    """Whether a curve is a review curve, and not part of the motion."""
    end = f'{bpy.utils.escape_identifier(SUFFIX)}"]'
    return str(fcurve.data_path).startswith('["') and str(fcurve.data_path).endswith(end)


def write_review_curves(armature_object: bpy.types.Object, action: bpy.types.Action, review: Review) -> None:
    """Write all curves into the motion's Action; those of an earlier review are replaced.

    An object that cannot take custom properties, being linked from another file, gets no curves.
    """
    channelbag = channelbag_for(action, armature_object)
    curves = review_curves(review)
    remove_generated_keys(channelbag, (curve_path(curve.name) for curve in curves))
    if not armature_object.is_editable:
        return
    for curve in curves:
        known = np.isfinite(curve.values)
        if not known.any():
            armature_object.pop(curve.property_name, None)
            continue
        _ensure_property(armature_object, curve)
        add_generated_keys(
            channelbag, curve_path(curve.name), 0, GROUP, review.frames[known], curve.values[known]
        )


def _ensure_property(armature_object: bpy.types.Object, curve: ReviewCurve) -> None:
    name = curve.property_name
    if name not in armature_object:
        armature_object[name] = 0.0
    interface = armature_object.id_properties_ui(name)
    interface.update(min=0.0, soft_min=0.0, soft_max=curve.soft_max, description=curve.description)
