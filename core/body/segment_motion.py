"""A motion segment by segment: how each part of the body is turned, and where it begins and ends."""

from collections.abc import Mapping
from dataclasses import dataclass

from ..arrays import Array
from .kinematics import Body


@dataclass(frozen=True, eq=False)
class SegmentMotion:
    """The body's segments in F frames, feet and hands included, which postures do not turn."""

    body: Body
    time_s: Array
    """(F,) time of each frame [s]."""
    turn: Mapping[str, Array]
    """(F, 3, 3) by segment: its turn in the world from the rest posture, which stands upright in a T pose and
    faces -Y."""
    start: Mapping[str, Array]
    """(F, 3) by segment: its joint nearer to the trunk [m]."""
    end: Mapping[str, Array]
    """(F, 3) by segment: its other end [m]."""
