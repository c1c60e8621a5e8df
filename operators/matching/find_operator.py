"""Base of the operators that find keyframes in the footage: the floor, and what is done with the result."""

from typing import TYPE_CHECKING

import bpy

from ..keypoints.requirements import points_to_follow
from ..shell.found_frames import count_found, doubtful_matches
from ..shell.job_operator import JobOperator
from ..shell.messages import say, warn
from ..shell.requirements import actor, all_colors, camera, footage, idle
from ..shell.takes import active_take
from .properties import FloorSettings

if TYPE_CHECKING:
    from .found_result import FoundResult

READ = 0.5
"""Share of the job at which the clip is read."""


class FindOperator(FloorSettings, JobOperator):
    """Mixin of an operator that finds keyframes: `start` gives a job that returns a `FoundResult`."""

    requirements = (footage, camera, actor, points_to_follow, all_colors, idle)

    @property
    def floor_m(self) -> float | None:
        """Height of the floor [m]; None where it is to be found."""
        return float(self.floor_height) if self.floor == "HEIGHT" else None

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Take the floor from the panel."""
        matching = active_take(context.scene).matching
        self.floor, self.floor_height = matching.floor, matching.floor_height
        return super().invoke(context, event)

    def finish(self, scene: bpy.types.Scene, result: "FoundResult") -> None:
        """Key what was found, go to the most doubtful frame, and say how many there are."""
        take = result.write(scene)
        scene.frame_set(scene.frame_current, subframe=scene.frame_subframe)
        for note in result.clip.notes:
            warn(self, note)
        self.report({"INFO"}, take.matching.reason)
        count, doubtful = count_found(take)
        if doubtful:
            take.matching.shown_match = doubtful_matches(take)[0]
            say(
                self,
                "WARNING",
                "{count} keyframes found, {doubtful} of them doubtful; the most doubtful one is shown",
                count=count,
                doubtful=doubtful,
            )
        else:
            say(self, "INFO", "{count} keyframes found, none of them doubtful", count=count)
