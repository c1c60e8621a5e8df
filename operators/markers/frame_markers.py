"""How many of a take's markers are seen in the current frame, as a label."""

import bpy

from ..shell.results import reading_of
from ..shell.shown_frame import clip_index


def markers_label(take: bpy.types.PropertyGroup) -> str:
    """As in `4 of 5`, once the clip was read for these markers; before that how many there are."""
    count = len(take.markers)
    if not count or take.clip is None:
        return ""
    reading = reading_of(take)
    names = tuple(marker.name for marker in take.markers)
    index = clip_index(take)
    if reading is None or reading.tracks.names != names or not 0 <= index < reading.tracks.frame_count:
        return "1 marker" if count == 1 else f"{count} markers"
    return f"{int(reading.tracks.visible[index].sum())} of {count}"
