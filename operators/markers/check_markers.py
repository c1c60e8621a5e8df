"""Check how well the markers can be found in the footage."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import bpy

from ..shell.job_operator import JobOperator
from ..shell.messages import say
from ..shell.requirements import footage, idle, markers, picked_color
from ..shell.takes import active_take, footage_of, take_by_identifier
from .marker_readouts import check_unchanged, look_at_markers, write_readouts
from .marker_styles import picked_styles
from .mask_previews import look_at_frame

if TYPE_CHECKING:
    from ...core.footage.marker_check import MarkerCheck
    from ...core.footage.marker_style import MarkerStyle
    from ...core.progress import Job


@dataclass(frozen=True, eq=False)
class Checked:
    """What was looked for, and what was found."""

    take: str
    """The take's identifier."""
    styles: "tuple[MarkerStyle, ...]"
    check: "MarkerCheck"


class KEYMARK_OT_check_markers(JobOperator, bpy.types.Operator):
    """Look for the markers all over the clip: how large each is, how distinct, how often it is found"""

    bl_idname = "keymark.check_markers"
    bl_label = "Check Markers"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (footage, markers, picked_color, idle)

    def start(self, scene: bpy.types.Scene) -> "Job[Checked]":
        """Look at the frames."""
        take = active_take(scene)
        source, identifier, styles = footage_of(scene, take), take.identifier, picked_styles(take)
        return Checked(identifier, styles, (yield from look_at_markers(source, styles)))

    def finish(self, scene: bpy.types.Scene, result: Checked) -> None:
        """Store the readouts."""
        take = take_by_identifier(scene, result.take)
        check_unchanged(picked_styles(take), result.styles)
        warnings = write_readouts(take, result.styles, result.check)
        show_frame(scene)
        for sentence in warnings:
            self.report({"WARNING"}, sentence)
        if not warnings:
            say(self, "INFO", "All {count} markers with a color are found well", count=len(result.styles))


def show_frame(scene: bpy.types.Scene) -> None:
    """Make the masks of the current frame where they are shown."""
    if bpy.context.window_manager.keymark_show_masks:
        look_at_frame(scene)


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_check_markers,))
