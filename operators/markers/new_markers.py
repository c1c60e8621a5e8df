"""New markers of a take: the segment the next one goes on, and its name."""

import bpy

from ..shell.takes import unique_name
from .properties import SEGMENTS

USUAL_SEGMENTS = ("trunk", "forearm.L", "forearm.R", "shin.L", "shin.R")
"""The five segments whose markers help most, in the order in which they are offered."""


def next_segment(take: bpy.types.PropertyGroup) -> str | None:
    """Return the segment to mark next; None if all have markers."""
    marked = {marker.segment for marker in take.markers}
    return next((segment for segment in (*USUAL_SEGMENTS, *SEGMENTS) if segment not in marked), None)


def free_name(take: bpy.types.PropertyGroup, segment: str) -> str:
    """Return a unique name for a marker: the segment's, with a number if another marker has it."""
    return unique_name(segment, (marker.name for marker in take.markers))


def append_marker(take: bpy.types.PropertyGroup, segment: str) -> bpy.types.PropertyGroup:
    """Add a marker named after its segment, and make it the active one."""
    name = free_name(take, segment)
    marker = take.markers.add()
    marker.segment, marker.name = segment, name
    marker.named_after = segment
    take.active_marker = len(take.markers) - 1
    return marker
