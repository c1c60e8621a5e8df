"""Where a figure faces, and with it which side is its left: feet, knees, elbows and names."""

from dataclasses import dataclass

import numpy as np

from ...arrays import Array
from .figure import Figure

NAMES_WEIGHT, FEET_WEIGHT, KNEES_WEIGHT, ELBOWS_WEIGHT = 3.0, 2.5, 1.0, 0.8
"""Feet alone do not outvote names; feet, knees and elbows together do."""


@dataclass(frozen=True)
class Facing:
    """Which way a figure faces."""

    ahead: float
    """1 where it faces along the second axis of `Frame.place`, -1 where it faces the other way."""
    confidence: float
    by_names: float
    """Vote of the names, positive for `ahead`; 0 where they name no sides."""
    by_shape: float
    """Vote of feet, knees and elbows, positive for `ahead`."""


def find_facing(figure: Figure) -> Facing:
    """Where a figure faces; `frame.one_side` is its left side if `ahead` is 1, its right side otherwise."""
    frame, limbs = figure.frame, figure.limbs
    hip, knee, ankle, shoulder, elbow = (
        frame.place[limbs[part]] for part in ("thigh", "shin", "foot", "upper_arm", "forearm")
    )
    leg = max(float(np.linalg.norm(knee - hip) + np.linalg.norm(ankle - knee)), 1e-9)
    toes = frame.branch[limbs["foot"]] - ankle  # what hangs on an ankle lies mostly ahead of it
    far = float(toes[np.abs(toes[:, 1]).argmax(), 1]) / leg
    shape = FEET_WEIGHT * float(np.clip(far / 0.1, -1.0, 1.0))
    shape += KNEES_WEIGHT * float(np.clip(_bulge(hip, knee, ankle) / 0.03, -1.0, 1.0))
    if "hand" in limbs:
        wrist = frame.place[limbs["hand"]]
        shape -= ELBOWS_WEIGHT * float(np.clip(_bulge(shoulder, elbow, wrist) / 0.04, -1.0, 1.0))
    sides = [
        sign if frame.bones.readings[bone].side == "L" else -sign
        for own in limbs.values()
        for bone, sign in ((own, 1.0), (int(frame.partner[own]), -1.0))
        if frame.bones.readings[bone].side is not None
    ]
    names = NAMES_WEIGHT * float(np.mean(sides)) if sides else 0.0
    ahead = 1.0 if shape + names >= 0.0 else -1.0
    confidence = float(1.0 / (1.0 + np.exp(-1.3 * abs(shape + names))))
    return Facing(ahead, confidence, ahead * names, ahead * shape)


def _bulge(first: Array, middle: Array, last: Array) -> float:
    """How far, in lengths, the middle joint lies ahead of the line through its neighbors."""
    line = last - first
    reach = max(float(line @ line), 1e-12)
    off = middle - first - line * float(np.clip((middle - first) @ line / reach, 0.0, 1.0))
    return float(off[1]) / float(np.sqrt(reach))
