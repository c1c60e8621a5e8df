"""Check how well the markers are found in the footage."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import bpy

from ..shell.base_operator import warn
from ..shell.job_operator import JobOperator
from ..shell.requirements import footage, idle, markers, picked_color
from ..shell.takes import active_take, footage_of, take_by_identifier
from .ignored_regions import ignored_regions
from .marker_styles import check_unchanged, find_markers, picked_styles, write_readouts
from .mask_previews import update_shown_masks

if TYPE_CHECKING:
    from ...core.footage.ignored_regions import IgnoredRegion
    from ...core.footage.marker_check import MarkerCheck
    from ...core.footage.region_tracks import MarkerStyle
    from ...core.progress import Job


@dataclass(frozen=True, eq=False)
class Checked:
    """Result of the job."""

    take: str  # The take's identifier
    styles: "tuple[MarkerStyle, ...]"
    ignored: "tuple[IgnoredRegion, ...]"
    check: "MarkerCheck"


class KEYMARK_OT_check_markers(JobOperator, bpy.types.Operator):
    """Look for the markers in frames all over the clip: how large, distinct and reliably found each one is"""

    bl_idname = "keymark.check_markers"
    bl_label = "Check Markers"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (footage, markers, picked_color, idle)

    def start(self, scene: bpy.types.Scene) -> "Job[Checked]":
        take = active_take(scene)
        source, identifier, styles = footage_of(scene, take), take.identifier, picked_styles(take)
        ignored = ignored_regions(take)
        return Checked(identifier, styles, ignored, (yield from find_markers(source, styles, ignored)))

    def finish(self, scene: bpy.types.Scene, result: Checked) -> None:
        take = take_by_identifier(scene, result.take)
        check_unchanged((picked_styles(take), ignored_regions(take)), (result.styles, result.ignored))
        warnings = write_readouts(take, result.styles, result.check)
        update_shown_masks(scene)
        for sentence in warnings:
            warn(self, sentence)
        if not warnings:
            self.report({"INFO"}, f"All {len(result.styles)} markers with a color are found well")


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_check_markers,))
