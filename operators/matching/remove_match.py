"""Remove a found keyframe."""

import bpy

from ...core.body.human import HUMAN
from ..shell.base_operator import BaseOperator
from ..shell.contradictions import note_contradictions
from ..shell.found_frames import state_of
from ..shell.keyed_frames import invalidate_keyed_frames
from ..shell.requirements import actor, idle, matches
from ..shell.takes import active_take
from .matches import chosen_match


class KEYMARK_OT_remove_match(BaseOperator, bpy.types.Operator):
    """Remove this found keyframe and its keys; a pose of your own at its frame stays"""

    bl_idname = "keymark.remove_match"
    bl_label = "Remove"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (actor, matches, idle)

    def run(self, context: bpy.types.Context) -> None:
        """Remove it; the next in the list is chosen."""
        from ..bridge.matched_keyframes import remove_keyframes

        scene = context.scene
        take = active_take(scene)
        matching, match = take.matching, chosen_match(take)
        invalidate_keyed_frames()
        frame = round(match.frame, 3)
        if state_of(take, match) == "FOUND":
            remove_keyframes(take.armature, take.keyframe_action, HUMAN, (frame,))
            invalidate_keyed_frames()
        note_contradictions(take, frame, ())
        removed = matching.shown_match
        matching.matches.remove(removed)
        matching.shown_match = max(0, min(removed, len(matching.matches) - 1))
        self.report({"INFO"}, f"Removed the found keyframe at frame {frame:g}")


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_remove_match,))
