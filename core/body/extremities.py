"""Extremities: hands and feet, which no degree of freedom turns against forearm and shin."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from ..arrays import Array
from .kinematics import Body, Pose
from .skeleton import Skeleton


@dataclass(frozen=True, eq=False)
class Extremities:
    """How hands and feet are turned about wrists and ankles, beside a batch of postures."""

    turns: Mapping[str, Array]
    """(..., 3, 3) by segment: its turn in its parent's frame. One that is not listed is rigid with its
    parent."""

    def without(self, names: Collection[str]) -> "Extremities":
        """Those that are not named."""
        kept = {name: turn for name, turn in self.turns.items() if name not in names}
        return Extremities(MappingProxyType(kept))


RIGID = Extremities(MappingProxyType({}))
"""All of them as their parents."""


def extremity_names(skeleton: Skeleton) -> tuple[str, ...]:
    """The segments that move with their parent's joint: hands and feet."""
    joint_of = {segment.name: segment.joint for segment in skeleton.segments}
    return tuple(
        segment.name
        for segment in skeleton.segments
        if segment.parent is not None and segment.joint == joint_of[segment.parent]
    )


def segment_turn(body: Body, pose: Pose, extremities: Extremities, name: str) -> Array:
    """World orientation (..., 3, 3) of a segment's frame; KeyError for an unknown one."""
    segment = next((s for s in body.skeleton.segments if s.name == name), None)
    if segment is None:
        raise KeyError(name)
    above = pose.rotation[..., segment.joint, :, :]
    return np.asarray(above @ extremities.turns[name]) if name in extremities.turns else above


def segment_ends(body: Body, pose: Pose, extremities: Extremities, name: str) -> tuple[Array, Array]:
    """World positions (..., 3) of a segment's two ends [m]; KeyError for an unknown segment."""
    start, end = body.segment_ends(pose, name)
    if name not in extremities.turns:
        return start, end
    segment = next(s for s in body.skeleton.segments if s.name == name)
    along = body.local(segment.end) - body.local(segment.start)
    return start, np.asarray(start + segment_turn(body, pose, extremities, name) @ along)
