"""Match the footage with a keyframe library that the animator names."""

from typing import TYPE_CHECKING

import bpy

from ...core.progress import stretch
from ..shell.takes import active_take
from .find_operator import READ, FindOperator
from .properties import UNCHOSEN
from .scene_clip import read_scene_clip

if TYPE_CHECKING:
    from ...core.progress import Job
    from .found_result import FoundResult


WELL = 0.85
"""Fit below which the footage probably shows something else."""


class KEYMARK_OT_match_library(FindOperator, bpy.types.Operator):
    """Find the postures of one library in the footage, and key the actor with them; what you posed stays"""

    bl_idname = "keymark.match_library"
    bl_label = "Match Library"
    bl_options = {"REGISTER", "UNDO"}

    library: bpy.props.StringProperty(
        name="Library", description="Identifier, title or file of the library; the panel's where empty"
    )

    def start(self, scene: bpy.types.Scene) -> "Job[FoundResult]":
        """Read the scene's take and match it; what was found earlier is ignored."""
        from ...core.matching.match_take import match_take, with_matches
        from ..library.registry_files import load_registered
        from .found_result import FoundResult

        settings = active_take(scene)
        identifier, count = settings.identifier, settings.keyframe_count or None
        matching = settings.matching
        chosen = matching.library if matching.library_name in UNCHOSEN else matching.library_name
        library = load_registered(self.library or chosen)
        clip = yield from stretch(read_scene_clip(scene, settings), 0.0, READ)
        job = match_take(clip.take, clip.reading, [library], self.floor_m, count)
        choice = yield from stretch(job, READ, 1.0)
        match = choice.match
        assert match is not None  # a library that is named is used however badly it fits
        elsewhere = "" if match.fit >= WELL else "; it probably shows something else"
        found = with_matches(clip.take, match).keyframes
        return FoundResult(
            identifier,
            clip,
            tuple(keyframe for keyframe in found if keyframe.matched is not None),
            {frame.index: frame.candidates for frame in match.frames},
            match.fit,
            match.floor_m,
            choice.reason + elsewhere,
            # Matching corrects the reading where another object of a marker's color was taken for the marker.
            choice.reading,
        )


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_match_library,))
