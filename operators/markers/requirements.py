"""Requirements of the operators of markers."""

import bpy

from ..shell.takes import find_take


def still_areas(context: bpy.types.Context) -> str | None:
    """Some still area of a marker's color is known that is surely no marker."""
    take = find_take(context.scene)
    known = take is not None and any(
        marker.has_readout(take) and len(marker.still_areas) for marker in take.markers
    )
    return None if known else "Check the markers first; no still area of a marker's color is known"


def some_ignored(context: bpy.types.Context) -> str | None:
    """Some region of the picture is ignored."""
    take = find_take(context.scene)
    return None if take and len(take.ignored_regions) else "No region of the picture is left out"
