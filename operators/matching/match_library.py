"""Match the footage with keyframe libraries: keyframes that nobody has to pose."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import bpy

from ...core.errors import InputError
from ...core.library.texts import EVERY_LIBRARY
from ...core.progress import stretch
from ..bridge.frame_times import scene_frames
from ..library import registry
from ..markers.marker_styles import marker_styles
from ..shell.job_operator import JobOperator
from ..shell.messages import say
from ..shell.requirements import actor, all_colors, all_met, camera, footage, idle, markers
from ..shell.results import keep_reading, reading_of
from ..shell.takes import active_take, footage_of, take_called
from .matches import keep_choice, known_matches
from .properties import FLOORS

if TYPE_CHECKING:
    from ...core.footage.reading import Reading
    from ...core.library.library import Library
    from ...core.matching.match_take import LibraryChoice
    from ...core.prior.keyframes import Keyframe
    from ...core.progress import Job

TIMES, READ = 0.05, 0.5
"""Shares of the job at which the clip's times are read, and its pictures."""


@dataclass(frozen=True, eq=False)
class Outcome:
    """What the job hands over to the scene."""

    take: str
    """The take's identifier."""
    frames: Any
    """(F,) scene frames."""
    reading: "Reading"
    choice: "LibraryChoice"
    keyframes: "tuple[Keyframe, ...]"
    """Those that are matched."""
    notes: tuple[str, ...]


class KEYMARK_OT_match_library(JobOperator, bpy.types.Operator):
    """Find the postures of a library in the footage, and key the actor with them; what you posed stays"""

    bl_idname = "keymark.match_library"
    bl_label = "Match Library"
    bl_options = {"REGISTER", "UNDO"}

    library: bpy.props.StringProperty(
        name="Library",
        description="What the library is known by, or its file; auto tries all and chooses",
        default=EVERY_LIBRARY,
    )
    floor: bpy.props.EnumProperty(
        name="Floor", description="What is known of the floor, which settles the distance", items=FLOORS
    )
    floor_height: bpy.props.FloatProperty(
        name="Floor Height",
        description="How high the floor lies that the performer stands on",
        subtype="DISTANCE",
        precision=3,
        default=0.0,
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """The body that is matched is the actor's, and its markers are looked for through the camera."""
        return all_met(cls, context, footage, camera, actor, markers, all_colors, idle)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Take from the panel what to look for."""
        matching = active_take(context.scene).matching
        self.library, self.floor = matching.library_name, matching.floor
        self.floor_height = matching.floor_height
        return super().invoke(context, event)

    def start(self, scene: bpy.types.Scene) -> "Job[Outcome]":
        """Read the scene's take and match it; what earlier matching gave is left out of account."""
        from ...core.matching.match_take import match_take, with_matches
        from ...core.take.read_footage import read_footage
        from ..bridge.take_from_scene import read_scene_take

        settings = active_take(scene)
        identifier, kept, count = settings.identifier, reading_of(settings), settings.keyframe_count or None
        floor_m = self.floor_height if self.floor == "HEIGHT" else None
        libraries = _libraries(self.library)
        reading_scene = read_scene_take(
            footage_of(scene, settings),
            settings.armature,
            settings.keyframe_action,
            marker_styles(settings),
            known_matches(settings),
        )
        whole, notes = yield from stretch(reading_scene, 0.0, TIMES)
        posed = replace(whole, keyframes=tuple(each for each in whole.keyframes if each.matched is None))
        reading = yield from stretch(read_footage(posed, kept), TIMES, READ)
        frames = scene_frames(reading.tracks.time_s, posed.frame_start, posed.fps)
        choice = yield from stretch(match_take(posed, reading, libraries, floor_m, count), READ, 1.0)
        found = with_matches(posed, choice.match).keyframes if choice.match is not None else ()
        matched = tuple(keyframe for keyframe in found if keyframe.matched is not None)
        # The match may have found that another thing of its color had been taken for a marker.
        return Outcome(identifier, frames, choice.reading or reading, choice, matched, notes)

    def finish(self, scene: bpy.types.Scene, result: Outcome) -> None:
        """Key what was found beside what is posed; what earlier matching gave goes."""
        take = take_called(scene, result.take)
        keep_choice(take, result.choice, result.keyframes, result.frames)
        keep_reading(take, result.reading)
        scene.frame_set(scene.frame_current, subframe=scene.frame_subframe)
        for note in result.notes:
            self.report({"WARNING"}, note[:1].upper() + note[1:])
        matches, reason = take.matching.matches, take.matching.reason
        if result.choice.match is None:
            self.report({"WARNING"}, reason)
        else:
            self.report({"INFO"}, reason)
            say(
                self,
                "INFO",
                "Matched {count} keyframes, {doubtful} of them doubtful",
                count=len(matches),
                doubtful=sum(match.is_doubtful for match in matches),
            )


def _libraries(name: str) -> "Sequence[Library]":
    """The library of a name or file, or all that are on the shelf.

    Raises:
        InputError: There is none.
    """
    from ...core.library.registry import find_library, registered_libraries

    if name != EVERY_LIBRARY:
        return [find_library(name, registry.folders())]
    usable = [each.library for each in registered_libraries(registry.folders()) if each.library is not None]
    if not usable:
        raise InputError("there is no library to match with; import one, or install Keymark as a whole")
    return usable


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_match_library,))
