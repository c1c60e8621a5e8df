"""The ways of a flipped limb, gone through one by one: known as long as the pose is one of them."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import bpy
import numpy as np

if TYPE_CHECKING:
    from ...core.body.kinematics import Body
    from ...core.body.posture import Posture
    from ...core.footage.camera import Camera

SAME = 1e-3
"""Difference of postures that comes from the precision of bones alone [m, rad]."""


@dataclass(frozen=True, eq=False)
class Ways:
    """A posture and the ways to flip it, the most plausible first."""

    key: tuple[int, float, str]
    """Number of the armature in this session, scene frame, part of the body."""
    postures: "tuple[Posture, ...]"
    """The first is the one that was flipped."""


_last: dict[str, Ways] = {}
"""The last ways by part of the body."""


def next_way(
    armature_object: bpy.types.Object,
    frame: float,
    limb: str,
    body: "Body",
    posture: "Posture",
    camera: "Camera",
) -> "tuple[Posture, int, int] | None":
    """The way after the one that is shown, from the last back to the first; None where there is no other.

    Returns:
        The posture, its number among the others from 1 (0 for the posture at first), and how many others
        there are.
    """
    from ...core.posing.depth_flip import flipped

    key = armature_object.session_uid, frame, limb
    ways = _last.get(limb)
    shown = None if ways is None or ways.key != key else _shown(ways, posture)
    if ways is None or shown is None:
        ways, shown = Ways(key, (posture, *flipped(body, posture, camera, limb))), 0
        _last[limb] = ways
    count = len(ways.postures)
    if count == 1:
        return None
    following = (shown + 1) % count
    return ways.postures[following], following, count - 1


def _shown(ways: Ways, posture: "Posture") -> int | None:
    """Which of the ways a posture is; None where it is none of them."""
    apart = [float(np.abs(posture.minus(way)).max()) for way in ways.postures]
    nearest = int(np.argmin(apart))
    return nearest if apart[nearest] < SAME else None
