"""Accept a matched keyframe as the animator's own."""

import bpy

from ...core.body.human import HUMAN
from ..shell.base_operator import BaseOperator
from ..shell.keyed_frames import invalidate_keyed_frames
from ..shell.messages import say
from ..shell.requirements import actor, idle, matches
from ..shell.takes import active_take
from .matches import chosen_match, state_of


class KEYMARK_OT_accept_match(BaseOperator, bpy.types.Operator):
    """Count the chosen match as posed by you: it is trusted as much, and matching again leaves it alone"""

    bl_idname = "keymark.accept_match"
    bl_label = "Accept"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (actor, matches, idle)

    def run(self, context: bpy.types.Context) -> set[str] | None:
        """Turn its keys into the animator's."""
        from ..bridge.matched_keyframes import take_over

        take = active_take(context.scene)
        match = chosen_match(take)
        invalidate_keyed_frames()
        if state_of(take, match) != "MATCHED":
            say(self, "INFO", "Nothing is matched at frame {frame:g} any more", frame=match.frame)
            return {"CANCELLED"}
        take_over(take.armature, take.keyframe_action, HUMAN, (round(match.frame, 3),))
        invalidate_keyed_frames()
        say(self, "INFO", "Frame {frame:g} counts as posed now", frame=match.frame)
        return None


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_accept_match,))
