"""Give a matched frame another of the postures that it may show."""

import bpy

from ..shell.error_reports import reported
from ..shell.messages import say
from ..shell.requirements import actor, all_met, idle, matches
from ..shell.takes import active_take
from .matches import chosen_match, key_matches


class KEYMARK_OT_replace_match(bpy.types.Operator):
    """Key this posture at the chosen match's frame instead; what is keyed there is replaced"""

    bl_idname = "keymark.replace_match"
    bl_label = "Replace Match"
    bl_options = {"REGISTER", "UNDO"}

    candidate: bpy.props.IntProperty(
        name="Candidate",
        description="Which of the chosen match's candidates to take, from 0 for the one that matching chose",
        default=0,
        min=0,
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """There must be something to replace."""
        return all_met(cls, context, actor, matches, idle)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Key it, and go there."""
        with reported(self):
            import numpy as np

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
            key_matches(take, np.array([round(match.frame, 3)]), [match.candidate.posture])
            match.go_to(context.scene)
            say(
                self,
                "INFO",
                "Frame {frame:g} shows {posture} now",
                frame=match.frame,
                posture=match.candidate.name,
            )
            return {"FINISHED"}
        return {"CANCELLED"}


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_replace_match,))
