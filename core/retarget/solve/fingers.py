"""Fingers on a character: bent as far as the performer's, whatever their bones are bent at rest."""

from collections.abc import Mapping

import numpy as np

from ...arrays import Array
from ...body.fingers import flexion_axis, flexions, palm_axes
from ...body.rotations import hinge
from ...body.skeleton import FINGERS, SIDES
from ...numerics.vectors import unit
from .rest_body import RestBody


def finger_bends(body: RestBody, wanted: Mapping[str, Array]) -> dict[int, Array]:
    """(F, 3, 3) by index of bone: its turn from rest in the frame of what carries it.

    `wanted` are flexions (F, 3) of the joints by role. Fingers of a hand whose palm's direction at rest is
    not known stay as they are.
    """
    found: dict[int, Array] = {}
    for side in SIDES:
        palm = _palm(body, side)
        for finger in FINGERS:
            role = f"{finger}.{side}"
            if palm is None or role not in wanted or not body.is_moved(role):
                continue
            bones = range(body.first[role], body.last[role] + 1)
            joints = [body.joint(f"hand.{side}"), *(body.bones[bone].head for bone in bones)]
            tip = body.tip(role)
            joints.append(2.0 * joints[-1] - joints[-2] if tip is None else tip)
            ways = unit(np.diff(joints, axis=0))
            axis = flexion_axis(finger, ways[1], palm)
            own = wanted[role]
            if len(bones) < own.shape[1]:  # the last one bends for those that are missing
                last = own[:, len(bones) - 1 :].sum(axis=1, keepdims=True)
                own = np.concatenate([own[:, : len(bones) - 1], last], axis=1)
            bent = own - flexions(ways, axis)
            found |= {bone: hinge(axis, bent[:, number]) for number, bone in enumerate(bones)}
    return found


def _palm(body: RestBody, side: str) -> Array | None:
    """(3, 3) axes of a hand at rest, by where its fingers begin; None of fewer than two."""
    starts = {
        finger: body.joint(f"{finger}.{side}") for finger in FINGERS if f"{finger}.{side}" in body.first
    }
    others = [start for finger, start in starts.items() if finger != FINGERS[0]]
    if not others or len(starts) < 2:
        return None
    first, last = (others[0], others[-1]) if len(others) > 1 else (starts[FINGERS[0]], others[0])
    return palm_axes(np.mean(others, axis=0) - body.joint(f"hand.{side}"), first - last, side)
