"""Review curves: the confidence of each frame as F-curves beside the motion's own, for the Graph Editor.

They animate custom properties of the armature object, which move nothing: bones, exporters by default, and
readers of keyframes ignore them.
"""

import bpy
import numpy as np

from ...core.arrays import Array
from ...core.review.review import Review
from .actions import channelbag_for
from .keys import MOTION, remove_generated_keys, write_keys

GROUP = "Keymark Confidence"
SUFFIX = " (Keymark)"  # suffix of all custom properties' names, which tells them from others

ReviewCurve = tuple[str, Array, float, str]
"""Quantity with its unit, values (F,) (frames that are NaN get no key), the slider's end, and a tooltip."""


def _review_curves(review: Review) -> list[ReviewCurve]:
    """Curves of a review: confidence, near-membership, reprojection error and the points' sigmas."""
    believed = np.where(review.keypoints.thrown_out, np.nan, review.keypoints.distance_px)
    distance = np.concatenate([review.reprojection_px, believed], axis=1)
    compared = np.isfinite(distance)
    total, count = np.where(compared, distance, 0.0).sum(axis=1), compared.sum(axis=1)
    reprojection = np.where(count > 0, total / np.maximum(count, 1), np.nan)
    joints = "Share of the joints expected within 2.5 % of the performer's height of their true place"
    near = "Degree to which a keyframe is near: 1 at a keyframe, 0 midway between two"
    pixels = (
        "Mean distance between the markers and keypoints seen and those predicted, in pixels of the footage"
    )
    return [
        ("Confidence", review.confidence, 1.0, joints),
        ("Nearness", review.nearness, 1.0, near),
        ("Reprojection px", reprojection, 10.0, pixels),
        *(
            (
                f"Sigma {point} mm",
                1e3 * std,
                100.0,
                f"Standard deviation of the point {point}, in millimeters",
            )
            for point, std in zip(review.point_names, review.sigma_m.T, strict=True)
        ),
    ]


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
    curves = _review_curves(review)
    remove_generated_keys(channelbag, (curve_path(name) for name, *_ in curves))
    if not armature_object.is_editable:
        return
    for name, values, soft_max, description in curves:
        known, property_name = np.isfinite(values), name + SUFFIX
        if not known.any():
            armature_object.pop(property_name, None)
            continue
        if property_name not in armature_object:
            armature_object[property_name] = 0.0
        interface = armature_object.id_properties_ui(property_name)
        interface.update(min=0.0, soft_min=0.0, soft_max=soft_max, description=description)
        column = (curve_path(name), 0, GROUP, values[known])
        write_keys(channelbag, [column], review.frames[known], MOTION)
