"""Match the footage with a keyframe library that the animator names."""

from dataclasses import replace
from typing import TYPE_CHECKING

import bpy

from ...core.progress import stretch
from ...core.text import Sentence
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
        from ...core.posing.match_clip import match_clip
        from ..library.registry_files import load_registered
        from .found_result import FoundResult, found_keyframes

        settings = active_take(scene)
        identifier, count, floor_m = settings.identifier, settings.keyframe_count or None, self.floor_m
        matching = settings.matching
        chosen = matching.library if matching.library_name in UNCHOSEN else matching.library_name
        library = load_registered(self.library or chosen)
        clip = yield from stretch(read_scene_clip(scene, settings), 0.0, READ)
        job = match_clip(clip.take, clip.reading, library, floor_m, count)
        found = yield from stretch(job, READ, 1.0)
        if found.fit < WELL:
            reason = Sentence(
                "{library} explains {fit:.0%} of the footage; the footage probably shows something else",
                library=library.title,
                fit=found.fit,
            )
            found = replace(found, reason=reason)
        return FoundResult(identifier, clip, found, found_keyframes(clip.take, found))


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_match_library,))
