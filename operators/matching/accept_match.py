"""Accept a found keyframe as the animator's own."""

import bpy

from ...core.body.human import HUMAN
from ..shell.base_operator import BaseOperator
from ..shell.contradictions import note_contradictions
from ..shell.found_frames import state_of
from ..shell.keyed_frames import invalidate_keyed_frames
from ..shell.requirements import actor, idle, matches
from ..shell.takes import active_take
from .improve_neighbors import improve_neighbors
from .matches import chosen_match


class KEYMARK_OT_accept_match(BaseOperator, bpy.types.Operator):
    """Count this frame as posed by you: it is trusted as much, and finding again leaves it alone"""

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
        if state_of(take, match) != "FOUND":
            self.report({"INFO"}, f"Frame {match.frame:g} is no found keyframe any more")
            return {"CANCELLED"}
        frame = round(match.frame, 3)
        take_over(take.armature, take.keyframe_action, HUMAN, (frame,))
        note_contradictions(take, frame, ())
        invalidate_keyed_frames()
        improved = improve_neighbors(context, take, frame)
        if improved:
            self.report(
                {"INFO"},
                f"Frame {frame:g} counts as posed now; {improved} found ones around it were posed anew",
            )
        else:
            self.report({"INFO"}, f"Frame {frame:g} counts as posed now")
        return None


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_accept_match,))
