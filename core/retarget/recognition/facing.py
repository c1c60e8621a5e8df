"""Where a figure faces, and with it which side is its left: feet, knees, elbows, eyes and names."""

from dataclasses import dataclass

import numpy as np

from ...arrays import Array
from .figure import Figure

NAMES_WEIGHT = 3.0
FEET_WEIGHT = 2.5
KNEES_WEIGHT = 1.0
ELBOWS_WEIGHT = 0.8
EYES_WEIGHT = 0.8
"""Feet alone do not outvote names; feet, knees and elbows together do."""
SURE = 0.9
"""Confidence from which left and right are not doubted."""


@dataclass(frozen=True)
class Facing:
    """Which way a figure faces."""

    ahead: float
    """1 where it faces along the frame's `behind`, -1 where it faces the other way."""
    confidence: float
    by_names: float
    """Vote of the names, positive for `ahead`; 0 where they name no sides."""
    by_shape: float
    """Vote of feet, knees, elbows and eyes, positive for `ahead`."""


def find_facing(figure: Figure) -> Facing:
    """Where a figure faces; `frame.one_side` is its left side if `ahead` is 1, its right side otherwise."""
    shape = _feet(figure) + _knees(figure) + _elbows(figure) + _eyes(figure)
    names = NAMES_WEIGHT * _names(figure)
    total = shape + names
    ahead = 1.0 if total >= 0.0 else -1.0
    confidence = float(1.0 / (1.0 + np.exp(-1.3 * abs(total))))
    return Facing(ahead, confidence, ahead * names, ahead * shape)


def _feet(figure: Figure) -> float:
    """What hangs on an ankle lies mostly ahead of it."""
    frame, limbs = figure.frame, figure.limbs
    points = frame.branch[limbs["foot"].bone] - frame.place[limbs["foot"].bone]
    far = points[int(np.argmax(np.abs(points[:, 1]))), 1] / _leg_length(figure)
    return FEET_WEIGHT * float(np.clip(far / 0.1, -1.0, 1.0))


def _knees(figure: Figure) -> float:
    """Knees bend ahead."""
    hip, knee, ankle = _places(figure, "thigh", "shin", "foot")
    return KNEES_WEIGHT * float(np.clip(_bulge(hip, knee, ankle) / 0.03, -1.0, 1.0))


def _elbows(figure: Figure) -> float:
    """Elbows bend behind."""
    if figure.bone("hand") < 0:
        return 0.0
    shoulder, elbow, wrist = _places(figure, "upper_arm", "forearm", "hand")
    return -ELBOWS_WEIGHT * float(np.clip(_bulge(shoulder, elbow, wrist) / 0.04, -1.0, 1.0))


def _eyes(figure: Figure) -> float:
    """Small pairs on the head lie ahead of its joint, if anything does."""
    frame, head = figure.frame, figure.trunk.head
    if head is None:
        return 0.0
    bones = frame.bones
    pairs = [b for b in bones.subtree[head] if frame.one_side[b] and len(bones.subtree[b]) <= 2]
    named = [b for b in pairs if any(word in ("eye", "eyes", "目") for word in bones.readings[b].words)]
    offsets = [frame.place[bone, 1] - frame.place[head, 1] for bone in named or pairs]
    if not offsets:
        return 0.0
    weight = EYES_WEIGHT * (2.0 if named else 1.0)
    return weight * float(np.clip(np.median(offsets) / _leg_length(figure) / 0.06, -1.0, 1.0))


def _names(figure: Figure) -> float:
    """Mean of the sides that names give the one side and its counterpart: 1 for left, -1 for right."""
    frame = figure.frame
    votes = []
    for choice in figure.limbs.values():
        if choice.bone < 0:
            continue
        for bone, sign in ((choice.bone, 1.0), (int(frame.symmetry.partner[choice.bone]), -1.0)):
            side = frame.bones.readings[bone].side if bone >= 0 else None
            if side is not None:
                votes.append(sign if side == "L" else -sign)
    return float(np.mean(votes)) if votes else 0.0


def _bulge(first: Array, middle: Array, last: Array) -> float:
    """How far, in lengths, the middle joint lies along `behind` from the line through its neighbors."""
    line = last - first
    reach = float(line @ line)
    if reach <= 0.0:
        return 0.0
    off = middle - first - line * float(np.clip((middle - first) @ line / reach, 0.0, 1.0))
    return float(off[1]) / float(np.sqrt(reach))


def _places(figure: Figure, *parts: str) -> list[Array]:
    return [figure.frame.place[figure.limbs[part].bone] for part in parts]


def _leg_length(figure: Figure) -> float:
    hip, knee, ankle = _places(figure, "thigh", "shin", "foot")
    return max(float(np.linalg.norm(knee - hip) + np.linalg.norm(ankle - knee)), 1e-9)
