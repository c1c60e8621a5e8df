"""Contradictions: what is seen at a frame of a take and no plausible posture explains, kept while it is true.

Whoever looks for a posture notes what it found, an empty list as well, and the panel shows it at that frame.
It holds until the frame is looked at again or posed, or the footage is read anew with other markers.
"""

from collections.abc import Sequence

import bpy

from .fields import HIDDEN, Number, Text

SAME_FRAME = 0.5  # a note nearer to a frame than this [frames] is of that frame
SEPARATOR = "\n"  # between names, which are of one line each


class KEYMARK_PG_contradiction(bpy.types.PropertyGroup):
    """What no plausible posture explains at a frame."""

    frame: Number("Frame", "The scene frame")
    names: Text("Names", "Names of the markers and keypoints, a line each", options=HIDDEN)
    reading: Text("Reading", "Key of the reading of the clip that it was found in", options=HIDDEN)


def note_contradictions(take: bpy.types.PropertyGroup, frame: float, names: Sequence[str]) -> None:
    """Note which markers and keypoints no plausible posture explains at a scene frame; none: all are."""
    noted = take.contradictions
    for index in reversed(range(len(noted))):
        if abs(noted[index].frame - frame) < SAME_FRAME:
            noted.remove(index)
    if names:
        entry = noted.add()
        entry.frame, entry.names, entry.reading = frame, SEPARATOR.join(names), take.reading_key
