"""Replace the posture of a matched frame by another candidate."""

import bpy

from ..shell.base_operator import BaseOperator
from ..shell.messages import say
from ..shell.requirements import actor, idle, matches
from ..shell.takes import active_take
from .matches import chosen_match


class KEYMARK_OT_replace_match(BaseOperator, bpy.types.Operator):
    """Key this posture at the chosen match's frame instead; what is keyed there is replaced"""

    bl_idname = "keymark.replace_match"
    bl_label = "Replace Match"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (actor, matches, idle)

    candidate: bpy.props.IntProperty(
        name="Candidate",
        description="Index of the chosen match's candidate to take; 0 is the one that matching chose",
        default=0,
        min=0,
    )

    def run(self, context: bpy.types.Context) -> set[str] | None:
        """Key the candidate, and go to its frame."""
        from .match_edits import key_candidate

        take = active_take(context.scene)
        match = chosen_match(take)
        if self.candidate >= len(match.candidates):
            say(
                self,
                "ERROR",
                "Frame {frame:g} has {count} candidates; candidate must be 0 to {last}",
                frame=match.frame,
                count=len(match.candidates),
                last=len(match.candidates) - 1,
            )
            return {"CANCELLED"}
        match.chosen, match.by_hand = self.candidate, True
        key_candidate(take, match)
        match.go_to(context.scene)
        say(
            self,
            "INFO",
            "Frame {frame:g} shows {posture} now",
            frame=match.frame,
            posture=match.candidate.name,
        )
        return None


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_replace_match,))
