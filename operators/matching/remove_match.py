"""Remove a matched keyframe."""

import bpy

from ...core.body.human import HUMAN
from ..shell.base_operator import BaseOperator
from ..shell.keyed_frames import invalidate_keyed_frames
from ..shell.messages import say
from ..shell.requirements import actor, idle, matches
from ..shell.takes import active_take
from .matches import chosen_match, state_of


class KEYMARK_OT_remove_match(BaseOperator, bpy.types.Operator):
    """Remove the chosen match and its keys; a pose of your own at its frame stays"""

    bl_idname = "keymark.remove_match"
    bl_label = "Remove"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (actor, matches, idle)

    def run(self, context: bpy.types.Context) -> None:
        """Remove the match; the next in the list is chosen."""
        from ..bridge.matched_keyframes import remove_keyframes

        scene = context.scene
        take = active_take(scene)
        matching, match = take.matching, chosen_match(take)
        invalidate_keyed_frames()
        frame = round(match.frame, 3)
        if state_of(take, match) == "MATCHED":
            remove_keyframes(take.armature, take.keyframe_action, HUMAN, (frame,))
            invalidate_keyed_frames()
        matching.matches.remove(matching.active_match)
        matching.active_match = max(0, min(matching.active_match, len(matching.matches) - 1))
        scene.frame_set(scene.frame_current, subframe=scene.frame_subframe)
        say(self, "INFO", "Removed the match at frame {frame:g}", frame=frame)


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_remove_match,))
