"""Leave out the still areas that have a marker's color and are surely none."""

from typing import TYPE_CHECKING

import bpy

from ..shell.job_operator import JobOperator
from ..shell.messages import warn
from ..shell.requirements import footage, idle, markers
from ..shell.takes import active_take
from .ignored_check import LeftOut, leave_out, write_left_out
from .requirements import still_areas

if TYPE_CHECKING:
    from ...core.progress import Job


class KEYMARK_OT_ignore_still_areas(JobOperator, bpy.types.Operator):
    """Leave out what keeps a marker's color in the same pixels while the marker moves: it is surely none"""

    bl_idname = "keymark.ignore_still_areas"
    bl_label = "Ignore Still Areas"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (footage, markers, still_areas, idle)

    def start(self, scene: bpy.types.Scene) -> "Job[LeftOut]":
        """Return the job that looks for the markers without the areas."""
        from ...core.footage.ignored_regions import IgnoredRegion

        take = active_take(scene)
        boxes = [
            tuple(area.box)
            for marker in take.markers
            if marker.has_readout(take)
            for area in marker.still_areas
        ]
        return leave_out(scene, tuple(IgnoredRegion(box=box) for box in dict.fromkeys(boxes)))

    def finish(self, scene: bpy.types.Scene, result: LeftOut) -> None:
        """Store the areas and the readouts."""
        for sentence in write_left_out(scene, result):
            warn(self, sentence)
        self.report({"INFO"}, f"Still areas are never a marker: {len(result.more)} more")


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_ignore_still_areas,))
