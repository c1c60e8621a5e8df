"""Check how well the markers can be found in the footage."""

from typing import TYPE_CHECKING

import bpy

from .job_operator import JobOperator
from .marker_readouts import look_at_markers, write_readouts
from .marker_styles import picked_styles
from .requirements import a_color, all_met, footage, idle, markers
from .say import say
from .takes import active_take, footage_of

if TYPE_CHECKING:
    from ..core.footage.marker_check import MarkerCheck
    from ..core.footage.marker_style import MarkerStyle
    from ..core.progress import Job


class KEYMARK_OT_check_markers(JobOperator, bpy.types.Operator):
    """Look for the markers all over the clip: how large each is, how distinct, how often it is found"""

    bl_idname = "keymark.check_markers"
    bl_label = "Check Markers"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """There must be footage, and a color to look for."""
        return all_met(cls, context, footage, markers, a_color, idle)

    def start(self, scene: bpy.types.Scene) -> "Job[tuple[tuple[MarkerStyle, ...], MarkerCheck]]":
        """Look at the frames."""
        take = active_take(scene)
        styles = picked_styles(take)
        check = yield from look_at_markers(footage_of(scene, take), styles)
        return styles, check

    def finish(self, scene: bpy.types.Scene, result: "tuple[tuple[MarkerStyle, ...], MarkerCheck]") -> None:
        """Store the readouts."""
        styles, check = result
        warnings = write_readouts(active_take(scene), styles, check)
        show_frame(scene)
        for sentence in warnings:
            self.report({"WARNING"}, sentence)
        if not warnings:
            say(self, "INFO", "All {count} markers with a color are found well", count=len(styles))


def show_frame(scene: bpy.types.Scene) -> None:
    """Make the masks of the current frame where they are shown."""
    from .marker_previews import look_at_frame

    if bpy.context.window_manager.keymark_show_masks:
        look_at_frame(scene)


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_check_markers,))
