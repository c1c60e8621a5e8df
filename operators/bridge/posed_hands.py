"""Hands that are seen, put right where a person poses them."""

import numpy as np
from bpy.types import FCurve, PoseBone

from ...core.arrays import Array
from ...core.body.rotations import exponential, logarithm
from ...core.feet.palms import POSED_S
from ...core.keys.rig import rotation_matrices
from .armature import BoneModel
from .rotation_modes import rotation_path

STILL_RAD = 1e-3  # a hand that is keyed less far from rest is not posed


def put_right(
    seen: Array, time_s: Array, frames: Array, bone: PoseBone, model: BoneModel, curves: list[FCurve]
) -> Array:
    """The turns (F, 3, 3) of a hand or finger that is seen, as its bone's curves of the keyframes correct it.

    `frames` (F,) are scene frames. Between neighboring keyframes that pose it the correction passes from one
    to the other, beyond them it fades.
    """
    path = rotation_path(bone.rotation_mode)
    turning = {curve.array_index: curve for curve in curves if curve.data_path.endswith(path)}
    keyed = np.array(sorted({point.co[0] for curve in turning.values() for point in curve.keyframe_points}))
    values = np.zeros((len(keyed), len(getattr(bone, path))))
    for index, curve in turning.items():
        values[:, index] = [curve.evaluate(frame) for frame in keyed]
    shown = rotation_matrices(values, bone.rotation_mode)
    posed = np.linalg.norm(logarithm(shown), axis=-1) > STILL_RAD
    inside = (keyed >= frames[0]) & (keyed <= frames[-1])
    keyed, posed, shown = keyed[inside], posed[inside], shown[inside]
    there = seen[np.abs(frames[:, None] - keyed).argmin(axis=0)]
    wanted = model.axes @ shown @ model.axes.T
    change = np.where(posed[:, None], logarithm(np.swapaxes(there, -1, -2) @ wanted), 0.0)
    at_s = np.interp(keyed, frames, time_s)
    knots = list(zip(at_s, change, strict=True))
    for side in (-1, 1):
        neighbor = np.concatenate([posed[1:], [False]] if side > 0 else [[False], posed[:-1]])
        knots += [(when + side * POSED_S, np.zeros(3)) for when in at_s[posed & ~neighbor]]
    if not knots:
        return seen
    knots.sort(key=lambda knot: knot[0])
    when, changes = np.array([knot[0] for knot in knots]), np.array([knot[1] for knot in knots])
    return np.asarray(seen @ exponential(np.stack([np.interp(time_s, when, axis) for axis in changes.T], -1)))
