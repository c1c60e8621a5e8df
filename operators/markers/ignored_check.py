"""The job of operators that leave regions of the picture out: markers are looked for without them."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import bpy

from ..shell.redraw import redraw_footage
from ..shell.takes import active_take, footage_of, take_by_identifier
from .ignored_regions import add_ignored_regions, ignored_regions
from .marker_readouts import check_unchanged, find_markers, write_readouts
from .marker_styles import picked_styles
from .mask_previews import update_shown_masks

if TYPE_CHECKING:
    from ...core.footage.ignored_regions import IgnoredRegion
    from ...core.footage.marker_check import MarkerCheck
    from ...core.footage.marker_style import MarkerStyle
    from ...core.progress import Job


@dataclass(frozen=True, eq=False)
class LeftOut:
    """Result of the job."""

    take: str
    """The take's identifier."""
    before: "tuple[IgnoredRegion, ...]"
    """What was ignored before."""
    more: "tuple[IgnoredRegion, ...]"
    styles: "tuple[MarkerStyle, ...]"
    check: "MarkerCheck | None"
    """None where no marker has a color yet."""


def leave_out(scene: bpy.types.Scene, more: "tuple[IgnoredRegion, ...]") -> "Job[LeftOut]":
    """Look for the active take's markers without more regions of the picture."""
    take = active_take(scene)
    source, identifier = footage_of(scene, take), take.identifier
    styles, before = picked_styles(take), ignored_regions(take)
    check = (yield from find_markers(source, styles, (*before, *more))) if styles else None
    return LeftOut(identifier, before, more, styles, check)


def write_left_out(scene: bpy.types.Scene, result: LeftOut) -> list[str]:
    """Store the regions and what was found of the markers; return all warnings."""
    take = take_by_identifier(scene, result.take)
    check_unchanged((picked_styles(take), ignored_regions(take)), (result.styles, result.before))
    add_ignored_regions(take, result.more)
    warnings = [] if result.check is None else write_readouts(take, result.styles, result.check)
    update_shown_masks(scene)
    redraw_footage(bpy.context)
    return warnings
