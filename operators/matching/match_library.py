"""Match the footage with keyframe libraries, to get keyframes without posing."""

from dataclasses import replace
from typing import TYPE_CHECKING

import bpy

from ...core.library.texts import EVERY_LIBRARY
from ...core.progress import stretch
from ..bridge.scene_frames import scene_frames
from ..keypoints.evidence import scene_evidence
from ..keypoints.requirements import points_to_follow
from ..shell.job_operator import JobOperator
from ..shell.messages import say
from ..shell.requirements import actor, all_colors, camera, footage, idle
from ..shell.results import reading_of
from ..shell.takes import active_take, footage_of
from .matches import known_matches
from .properties import FLOORS

if TYPE_CHECKING:
    from ...core.progress import Job
    from .match_result import MatchResult

TIMES, READ = 0.05, 0.5
"""Shares of the job at which the clip's times are read, and its pictures."""


class KEYMARK_OT_match_library(JobOperator, bpy.types.Operator):
    """Find the postures of a library in the footage, and key the actor with them; what you posed stays"""

    bl_idname = "keymark.match_library"
    bl_label = "Match Library"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (footage, camera, actor, points_to_follow, all_colors, idle)

    library: bpy.props.StringProperty(
        name="Library",
        description="Identifier or file of the library; auto takes from all of them",
        default=EVERY_LIBRARY,
    )
    floor: bpy.props.EnumProperty(
        name="Floor",
        description="Source of the floor's height, which determines the performer's distance",
        items=FLOORS,
    )
    floor_height: bpy.props.FloatProperty(
        name="Floor Height",
        description="Height of the floor that the performer stands on",
        subtype="DISTANCE",
        precision=4,
        default=0.0,
    )

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Take library and floor from the panel."""
        matching = active_take(context.scene).matching
        self.library, self.floor = matching.library_name, matching.floor
        self.floor_height = matching.floor_height
        return super().invoke(context, event)

    def start(self, scene: bpy.types.Scene) -> "Job[MatchResult]":
        """Read the scene's take and match it; earlier matches are ignored."""
        from ...core.posing.found_poses import with_found
        from ...core.posing.match_clip import match_clip
        from ...core.posing.pose_clip import pose_clip
        from ...core.take.read_footage import read_footage
        from ..bridge.take_from_scene import read_scene_take
        from ..library.registry_files import libraries_to_match
        from .match_result import MatchResult

        settings = active_take(scene)
        identifier, kept, count = settings.identifier, reading_of(settings), settings.keyframe_count or None
        floor_m = self.floor_height if self.floor == "HEIGHT" else None
        libraries = libraries_to_match(self.library)
        reading_scene = read_scene_take(
            footage_of(scene, settings),
            settings.armature,
            settings.keyframe_action,
            scene_evidence(settings),
            known_matches(settings),
        )
        whole, notes = yield from stretch(reading_scene, 0.0, TIMES)
        posed = replace(whole, keyframes=tuple(each for each in whole.keyframes if each.matched is None))
        reading = yield from stretch(read_footage(posed, kept), TIMES, READ)
        frames = scene_frames(reading.tracks.time_s, posed.frame_start, posed.fps)
        job = (
            pose_clip(posed, reading, libraries, floor_m, count)
            if self.library == EVERY_LIBRARY
            else match_clip(posed, reading, libraries[0], floor_m, count)
        )
        found = yield from stretch(job, READ, 1.0)
        keyframes = with_found(posed, found).keyframes
        matched = tuple(keyframe for keyframe in keyframes if keyframe.matched is not None)
        # Matching corrects the reading where another object of a marker's color was taken for the marker.
        return MatchResult(identifier, frames, found.reading or reading, found, matched, notes)

    def finish(self, scene: bpy.types.Scene, result: "MatchResult") -> None:
        """Key the matches beside what is posed, in place of earlier ones."""
        take = result.write(scene)
        scene.frame_set(scene.frame_current, subframe=scene.frame_subframe)
        for note in result.notes:
            self.report({"WARNING"}, note[:1].upper() + note[1:])
        matches, reason = take.matching.matches, take.matching.reason
        self.report({"INFO"}, reason)
        say(
            self,
            "INFO",
            "Matched {count} keyframes, {doubtful} of them doubtful",
            count=len(matches),
            doubtful=sum(match.is_doubtful for match in matches),
        )


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_match_library,))
