"""A motion segment by segment: how each part of the body is turned, and where it begins and ends."""

from collections.abc import Mapping
from dataclasses import dataclass

from ..arrays import Array
from .extremities import Extremities, segment_ends, segment_turn
from .kinematics import Body
from .posture import Posture


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


def segment_motion(body: Body, posture: Posture, time_s: Array, extremities: Extremities) -> SegmentMotion:
    """The motion of every segment.

    Args:
        body: The body.
        posture: A batch of F postures.
        time_s: (F,) time of each frame [s].
        extremities: Its hands and feet, as `finish/natural_extremities` gives them or as they are posed.
    """
    pose = body.pose(posture)
    names = [segment.name for segment in body.skeleton.segments]
    ends = {name: segment_ends(body, pose, extremities, name) for name in names}
    return SegmentMotion(
        body,
        time_s,
        {name: segment_turn(body, pose, extremities, name) for name in names},
        {name: start for name, (start, _) in ends.items()},
        {name: end for name, (_, end) in ends.items()},
    )
